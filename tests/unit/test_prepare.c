/* How a view is prepared: depth order, memory that is used again, packed values. */
#include "unit.h"

#include "base/mem.h"
#include "base/rng.h"
#include "pack_whole.h"
#include "splat/kernels.h"
#include "splat/order.h"
#include "splat/render.h"
#include "splat/view.h"
#include "splat/weigh_packed.h"

#include <omp.h>

enum { MOST_THREADS = 3 };

static void *need(size_t n, size_t size)
{
	struct err e;
	void *p = mem_zalloc(n, size, "test", &e);

	if (!p)
		abort();
	return p;
}

/* order_sort's truth. */
static const struct projected *compared;

static int by_depth(const void *a, const void *b)
{
	const struct order_item *x = a, *y = b;
	double p = compared[x->index].depth, q = compared[y->index].depth;

	if (p != q)
		return p < q ? -1 : 1;
	return (x->index > y->index) - (x->index < y->index);
}

/* Sorts those of the n depths that are positive, by all numbers of threads. */
static void check_order(const char *what, const struct projected *p, size_t n)
{
	struct order_item *items = need(n, sizeof *items), *spare = need(n, sizeof *spare),
			  *truth = need(n, sizeof *truth);
	struct err e;
	size_t seen = 0;

	for (size_t i = 0; i < n; i++)
		if (p[i].depth > 0)
			truth[seen++] = (struct order_item){order_key(p[i].depth), (uint32_t)i};
	for (int threads = 1; threads <= MOST_THREADS; threads++) {
		omp_set_num_threads(threads);
		size_t k = 0;
		for (size_t i = 0; i < n; i++)
			if (p[i].depth > 0)
				items[k++] = (struct order_item){order_key(p[i].depth), (uint32_t)i};
		const struct order_item *sorted = order_sort(items, spare, seen, p, &e);
		if (threads == 1) {
			compared = p;
			qsort(truth, seen, sizeof *truth, by_depth);
		}
		size_t wrong = 0;
		for (size_t i = 0; sorted && i < seen; i++)
			wrong += sorted[i].index != truth[i].index;
		CHECK(sorted && !wrong, "%s, %zu, %d threads: %zu out of place", what, seen, threads, wrong);
	}
	free(items);
	free(spare);
	free(truth);
}

static void order_is_that_of_qsort(void)
{
	enum { N = 30000 };
	struct projected *p = need(N, sizeof *p);
	struct rng r;

	rng_seed(&r, 1, 1);
	check_order("none", p, 0);
	for (size_t i = 0; i < N; i++)
		p[i].depth = rng_range(&r, -1, 20);
	check_order("one", p, 1);
	check_order("random", p, N);
	for (size_t i = 0; i < N; i++)
		p[i].depth = exp(rng_range(&r, -1, 700));
	check_order("up to where a float ends", p, N);
	for (size_t i = 0; i < N; i++)
		p[i].depth = 1 + rng_below(&r, 5);
	check_order("ties", p, N);
	for (size_t i = 0; i < N; i++)
		p[i].depth = 2;
	check_order("all equal", p, N);
	for (size_t i = 0; i < N; i++)
		p[i].depth = 2 + 1e-13 * rng_below(&r, 1000);
	check_order("differences beyond a float", p, N);
	p[N / 2].depth = 1e300;
	p[N / 3].depth = 0.3;
	check_order("and beyond the keys", p, N);
	for (size_t i = 0; i < N; i++)
		p[i].depth = N - (double)i;
	check_order("falling", p, N);
	free(p);
}

static struct camera make_camera(int width, int height, double focal, double turn)
{
	struct camera c = {.width = width,
		.height = height,
		.fx = focal,
		.fy = focal,
		.cx = 0.5 * width,
		.cy = 0.5 * height};

	memcpy(c.world_to_camera[0], (double[4]){cos(turn), 0, sin(turn), 0.1}, sizeof c.world_to_camera[0]);
	memcpy(c.world_to_camera[1], (double[4]){0, 1, 0, 0}, sizeof c.world_to_camera[1]);
	memcpy(c.world_to_camera[2], (double[4]){-sin(turn), 0, cos(turn), 0}, sizeof c.world_to_camera[2]);
	c.world_to_camera[3][3] = 1;
	return c;
}

/* Sizes from a point to the whole view, so that covers of every kind occur. */
static struct splats make_splats(uint64_t seed, size_t n)
{
	struct splats s;
	struct err e;
	struct rng r;

	if (splats_alloc(&s, n, 1, &e))
		abort();
	rng_seed(&r, seed, 1);
	for (size_t i = 0; i < n; i++) {
		double z = rng_range(&r, -0.5, 6);
		for (size_t k = 0; k < 3; k++) {
			s.means[3 * i + k] = (float)(k == 2 ? z : z * rng_range(&r, -0.9, 0.9));
			s.scales[3 * i + k] = (float)(0.03 * exp(1.2 * rng_normal(&r)));
			s.sh[3 * i + k] = (float)rng_normal(&r);
		}
		for (size_t k = 0; k < 4; k++)
			s.quats[4 * i + k] = (float)rng_normal(&r);
		s.opacities[i] = (float)rng_uniform(&r);
	}
	return s;
}

enum { CHANNELS = 19 }; /* more than a group */

static void check_same(const char *what, const struct render_view *fresh, const struct render_view *again,
	const struct render_weights *a, const struct render_weights *b)
{
	const size_t pixels = (size_t)fresh->grid.width * (size_t)fresh->grid.height,
		     tiles = (size_t)fresh->grid.columns * (size_t)fresh->grid.rows,
		     pairs = fresh->tiles.start[tiles], nnz = (size_t)a->indptr[pixels];

	CHECK(fresh->visible == again->visible &&
			!memcmp(fresh->tiles.start, again->tiles.start, (tiles + 1) * sizeof(size_t)) &&
			!memcmp(fresh->tiles.entries, again->tiles.entries, pairs * sizeof(uint32_t)),
		"%s: the same lists", what);
	CHECK(!memcmp(a->indptr, b->indptr, (pixels + 1) * sizeof *a->indptr) &&
			!memcmp(a->index, b->index, nnz * sizeof *a->index) &&
			!memcmp(a->weight, b->weight, nnz * sizeof *a->weight) &&
			!memcmp(a->transmittance, b->transmittance, pixels * sizeof *a->transmittance),
		"%s: the same weights", what);
}

/* Packed weights are the weights, packed. */
static void check_packed(const char *what, struct weighed_packed *to, const struct render_view *v)
{
	const size_t pixels = (size_t)v->grid.width * (size_t)v->grid.height;
	const struct render_limits limits = {0.05, 0.5 / 255};
	struct render_weights w = {0};
	struct weights_pack whole;
	float *dropped[2] = {need(pixels, sizeof **dropped), need(pixels, sizeof **dropped)};
	struct err e;

	if (render_weights_within(v, &limits, &w, dropped[0], &e) ||
		weigh_packed(to, v, &limits, dropped[1], &e) ||
		pack_whole(
			&whole, v->grid.width, v->grid.height, v->gaussians, w.indptr, w.index, w.weight, &e))
		abort();
	CHECK(to->weights == (size_t)w.indptr[pixels] &&
			to->covered == weigh_covered(w.transmittance, pixels) &&
			!memcmp(dropped[0], dropped[1], pixels * sizeof **dropped),
		"%s: as many packed weights, and as much left out", what);
	for (int s = 0; s < WEIGHTS_STREAMS; s++)
		CHECK(to->pack.packed[s] == whole.packed[s] &&
				!memcmp(to->pack.data[s], whole.data[s], whole.packed[s]),
			"%s: the same %s", what, weights_stream_name[s]);
	weights_pack_free(&whole);
	render_weights_free(&w);
	free(dropped[0]);
	free(dropped[1]);
}

/* A view and weights that go from one camera and scene to another give the bytes of fresh ones, whatever the
 * number of threads. */
static void used_again(void)
{
	const struct camera cameras[] = {make_camera(90, 70, 60, 0), make_camera(300, 200, 150, 0.3),
		make_camera(17, 33, 20, -0.2), make_camera(300, 200, 900, 0.1), make_camera(64, 48, 50, 2)};
	const struct splats scenes[] = {make_splats(1, 9000), make_splats(2, 100), make_splats(3, 20000),
		make_splats(4, 0), make_splats(5, 9001)};
	struct render_view *again = NULL;
	struct render_weights kept = {0}, one;
	struct weighed_packed packed = {0};
	struct err e;

	for (int i = 0; i < 15; i++) {
		const struct splats *s = &scenes[i % 5];
		const struct camera *c = &cameras[i * 2 % 5];
		char what[40];
		snprintf(what, sizeof what, "round %d", i);
		omp_set_num_threads(1);
		struct render_view *fresh = render_prepare(s, c, &e);
		omp_set_num_threads(1 + i % MOST_THREADS);
		if (again ? render_again(again, s, c, &e) : !(again = render_prepare(s, c, &e)))
			abort();
		if (!fresh || render_weights(fresh, &one, &e) || render_weights_again(again, &kept, &e))
			abort();
		check_same(what, fresh, again, &one, &kept);
		check_packed(what, &packed, again);
		render_weights_free(&one);
		render_free(fresh);
	}
	render_weights_free(&kept);
	weighed_packed_free(&packed);
	render_free(again);
	for (int i = 0; i < 5; i++)
		splats_free((struct splats *)&scenes[i]);
}

/* Packed values give the images of planar ones, to the bit. */
static void packed_values(void)
{
	struct splats s = make_splats(6, 3000);
	struct camera c = make_camera(70, 50, 50, 0);
	const size_t pixels = (size_t)c.width * (size_t)c.height;
	float *values = need(CHANNELS * s.n, sizeof *values), *packed = need(CHANNELS * s.n, sizeof *packed);
	float *planar_image = need(CHANNELS * pixels, sizeof *planar_image),
	      *packed_image = need(CHANNELS * pixels, sizeof *packed_image);
	float *one_left = need(pixels, sizeof *one_left), *left = need(pixels, sizeof *left);
	struct err e;

	for (size_t i = 0; i < CHANNELS * s.n; i++)
		values[i] = (float)(i * 7 % 13) - 6;
	struct render_view *v = render_prepare(&s, &c, &e);
	if (!v || render_values(v, values, 1, planar_image, one_left, &e))
		abort();
	for (int channels = 1; channels <= CHANNELS; channels++) {
		memcpy(packed, values, CHANNELS * s.n * sizeof *values);
		memset(packed_image, 0, CHANNELS * pixels * sizeof *packed_image);
		if (render_pack(packed, s.n, channels, &e) ||
			render_values(v, values, channels, planar_image, NULL, &e))
			abort();
		render_packed(v, packed, channels, packed_image, left);
		CHECK(!memcmp(planar_image, packed_image, (size_t)channels * pixels * sizeof *packed_image),
			"%d channels: the same images", channels);
		CHECK(!memcmp(one_left, left, pixels * sizeof *left), "%d channels: the same transmittance",
			channels);
	}
	for (int channel = 0; channel < CHANNELS; channel++) {
		if (render_values(v, values + (size_t)channel * s.n, 1, packed_image, NULL, &e))
			abort();
		CHECK(!memcmp(planar_image + (size_t)channel * pixels, packed_image,
			      pixels * sizeof *packed_image),
			"channel %d is the same alone", channel);
	}
	render_free(v);
	splats_free(&s);
	free(values);
	free(packed);
	free(planar_image);
	free(packed_image);
	free(one_left);
	free(left);
}

/* Projection does not depend on the instruction set. */
static void levels_project_alike(void)
{
	struct camera c = make_camera(300, 200, 200, 0.2);
	struct splats s = make_splats(7, PROJECT_LANES);
	struct project_batch batch = {0}, results[CPU_LEVELS];
	struct project_lens lens;
	int seen = 0;

	for (int l = 0; l < PROJECT_LANES; l++) {
		for (int k = 0; k < 3; k++) {
			batch.mean[k][l] = s.means[3 * l + k];
			batch.scale[k][l] = s.scales[3 * l + k];
		}
		for (int k = 0; k < 4; k++)
			batch.quat[k][l] = s.quats[4 * l + k];
		batch.opacity[l] = 0.01f + 0.99f * s.opacities[l];
	}
	project_lens_make(&lens, &c, s.near);
	for (enum cpu_level level = CPU_PLAIN; level <= cpu_level(); level++) {
		results[level] = batch;
		kernels_of(level)->project(&lens, &results[level], PROJECT_LANES);
	}
	for (enum cpu_level level = CPU_PLAIN; level <= cpu_level(); level++)
		for (int l = 0; l < PROJECT_LANES; l++) {
			const struct project_batch *a = &results[CPU_PLAIN], *b = &results[level];
			seen += level == CPU_PLAIN && a->seen[l];
			CHECK(!a->seen[l] == !b->seen[l], "level %d, lane %d: seen", (int)level, l);
			CHECK(!a->seen[l] ||
					(a->x[l] == b->x[l] && a->y[l] == b->y[l] && a->z[l] == b->z[l] &&
						a->l11[l] == b->l11[l] && a->l21[l] == b->l21[l] &&
						a->l22[l] == b->l22[l] && a->radius[l] == b->radius[l] &&
						a->log_opacity[l] == b->log_opacity[l] &&
						a->columns[0][l] == b->columns[0][l] &&
						a->columns[1][l] == b->columns[1][l] &&
						a->rows[0][l] == b->rows[0][l] &&
						a->rows[1][l] == b->rows[1][l]),
				"level %d, lane %d: the same numbers", (int)level, l);
			CHECK(!a->seen[l] || fabs(a->log_opacity[l] - log2((double)batch.opacity[l])) < 1e-12,
				"lane %d: log2 of the opacity", l);
		}
	CHECK(seen > PROJECT_LANES / 4, "%d lanes are seen", seen);
	splats_free(&s);
}

int main(void)
{
	order_is_that_of_qsort();
	used_again();
	packed_values();
	levels_project_alike();
	return unit_end();
}
