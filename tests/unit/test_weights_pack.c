/* Packed weights: what comes back is what went in, in the order of the Gaussians, and broken streams are
 * found. */
#include "unit.h"

#include "base/rng.h"
#include "pack_whole.h"
#include "splat/view_weights.h"

enum { MOST = 60, GAUSSIANS = 5000 };

struct matrix {
	int width, height;
	int64_t *indptr;
	int32_t *index;
	float *weight;
};

/* A random picture: none to MOST weights a pixel, of few or many Gaussians, each once. */
static struct matrix random_matrix(struct rng *rng, int width, int height, int gaussians)
{
	const int pixels = width * height;
	struct matrix m = {width, height, malloc((size_t)(pixels + 1) * 8), malloc((size_t)pixels * MOST * 4),
		malloc((size_t)pixels * MOST * 4)};
	int64_t n = 0;

	m.indptr[0] = 0;
	for (int p = 0; p < pixels; p++) {
		const int count = (int)(rng_uniform(rng) * (gaussians < MOST ? gaussians : MOST));
		int id = gaussians - 1 - (int)(rng_uniform(rng) * 3);
		for (int k = 0; k < count && id >= 0; k++, n++) {
			m.index[n] = id; /* falling: not the order of what comes back */
			m.weight[n] = (float)(1 + (int)(rng_uniform(rng) * 255)) / 255;
			id -= 1 + (int)(rng_uniform(rng) * gaussians / MOST);
		}
		m.indptr[p + 1] = n;
	}
	return m;
}

static void matrix_free(struct matrix *m)
{
	free(m->indptr);
	free(m->index);
	free(m->weight);
}

/* The places where the unpacked rows are not those of m, turned round. */
static long count_wrong(
	const struct matrix *m, const int64_t *indptr, const int32_t *index, const float *weight)
{
	const int pixels = m->width * m->height;
	long wrong = 0;

	for (int p = 0; p <= pixels; p++)
		wrong += indptr[p] != m->indptr[p];
	for (int p = 0; p < pixels && !wrong; p++)
		for (int64_t k = indptr[p]; k < indptr[p + 1]; k++) {
			const int64_t from = m->indptr[p] + m->indptr[p + 1] - 1 - k;
			wrong += index[k] != m->index[from] || weight[k] != m->weight[from];
		}
	return wrong;
}

/* What tiles blend is what rows of pixels do, to the bit. */
static void check_blend(
	struct rng *rng, const struct matrix *m, int gaussians, const struct weights_room *room)
{
	const size_t pixels = (size_t)m->width * (size_t)m->height, values = (size_t)gaussians * VIEW_GROUP;
	const struct view_weights w = {pixels, (size_t)gaussians, room->indptr, room->index, room->weight};
	float *field = malloc(values * sizeof *field + 1),
	      *image = malloc(2 * VIEW_GROUP * pixels * sizeof *image);

	for (size_t i = 0; i < values; i++)
		field[i] = (float)(rng_uniform(rng) - 0.5);
	view_blend_group(&w, field, VIEW_GROUP, 0, pixels, image, pixels);
	view_tiles_blend_group(&room->tiles, field, image + VIEW_GROUP * pixels);
	CHECK(!memcmp(image, image + VIEW_GROUP * pixels, VIEW_GROUP * pixels * sizeof *image),
		"%dx%d: tiles blend otherwise than rows", m->width, m->height);
	free(field);
	free(image);
}

/* room: used again, whatever was in them. */
static void check_round_trip(struct rng *rng, int width, int height, int gaussians, struct weights_room *room)
{
	struct matrix m = random_matrix(rng, width, height, gaussians);
	struct weights_pack pack;
	struct err e;

	CHECK(!pack_whole(&pack, width, height, (size_t)gaussians, m.indptr, m.index, m.weight, &e), "%s",
		e.message);
	if (CHECK(!weights_unpack(&pack, width, height, gaussians, "w", room, &e), "%s", e.message)) {
		const long wrong = count_wrong(&m, room->indptr, room->index, room->weight);
		CHECK(wrong == 0, "%dx%d of %d: %ld differ", width, height, gaussians, wrong);
		check_blend(rng, &m, gaussians, room);
	}
	weights_pack_free(&pack);
	matrix_free(&m);
}

static void weights_come_back(void)
{
	struct weights_room room = {0};
	struct rng rng;

	rng_seed(&rng, 3, 1);
	for (int i = 0; i < 20; i++)
		check_round_trip(&rng, 1 + i, 1 + (int)(rng_uniform(&rng) * 30),
			1 + (int)(rng_uniform(&rng) * GAUSSIANS), &room);
	check_round_trip(&rng, 123, 45, GAUSSIANS, &room);
	check_round_trip(&rng, 8, 8, 1, &room);
	weights_room_free(&room);
}

static void nothing_is_packed(void)
{
	const int64_t none[13] = {0};
	struct weights_room room = {0};
	struct weights_pack pack;
	struct err e;

	CHECK(!pack_whole(&pack, 4, 3, 0, none, NULL, NULL, &e), "%s", e.message);
	CHECK(!weights_unpack(&pack, 4, 3, 0, "w", &room, &e), "%s", e.message);
	CHECK(room.indptr && room.indptr[12] == 0, "no weights");
	weights_room_free(&room);
	weights_pack_free(&pack);
}

static int unpacks(const struct weights_pack *pack, int width, int height, int gaussians)
{
	struct weights_room room = {0};
	struct err e = {0};
	const int bad = weights_unpack(pack, width, height, gaussians, "w", &room, &e);

	if (bad)
		CHECK(e.code == ERR_FORMAT &&
				!strncmp(e.message, "w: packed weights are broken, after byte ", 41),
			"%s", e.message);
	weights_room_free(&room);
	return !bad;
}

static void broken_streams_are_found(void)
{
	struct rng rng;
	struct weights_pack pack;
	struct err e;

	rng_seed(&rng, 4, 1);
	struct matrix m = random_matrix(&rng, 20, 13, 300);
	CHECK(!pack_whole(&pack, 20, 13, 300, m.indptr, m.index, m.weight, &e), "%s", e.message);
	CHECK(unpacks(&pack, 20, 13, 300), "as it is");
	CHECK(!unpacks(&pack, 20, 13, 299), "of a smaller scene");
	CHECK(!unpacks(&pack, 12, 13, 300), "of a narrower picture");
	CHECK(!unpacks(&pack, 20, 21, 300), "of a higher picture");
	for (int s = 0; s < WEIGHTS_STREAMS; s++) {
		pack.bytes[s]--;
		CHECK(!unpacks(&pack, 20, 13, 300), "stream %d: fewer bytes", s);
		pack.bytes[s] += 2;
		CHECK(!unpacks(&pack, 20, 13, 300), "stream %d: more bytes", s);
		pack.bytes[s]--;
		pack.packed[s]--;
		CHECK(!unpacks(&pack, 20, 13, 300), "stream %d: cut", s);
		pack.packed[s]++;
		pack.data[s][pack.packed[s] / 2] ^= 1;
		CHECK(!unpacks(&pack, 20, 13, 300), "stream %d: another bit", s);
		pack.data[s][pack.packed[s] / 2] ^= 1;
	}
	weights_pack_free(&pack);
	matrix_free(&m);
}

int main(void)
{
	weights_come_back();
	nothing_is_packed();
	broken_streams_are_found();
	return unit_end();
}
