/* What moves in a synthetic scene: places by the definitions of the page, and whether sentences mean what
 * they say, found again from positions alone. */
#include "unit.h"

#include "base/mem.h"
#include "geom/vector.h"
#include "splat/render.h"
#include "synth/moves.h"

enum { TIMES = 40, SEEDS = 12 };

static int make(struct synth_scene *s, struct synth_moves *m, uint64_t seed)
{
	struct synth_preset roomy = *synth_preset(0);
	struct synth_options o = {.preset = &roomy,
		.seed = seed,
		.objects = 8,
		.views = 6,
		.width = 64,
		.height = 48,
		.gaussians = 2000,
		.times = TIMES};
	struct err e = {0};

	roomy.filled /= 2;
	while (synth_scene_make(s, &o, &e))
		o.seed += 1000;
	return CHECK(!synth_moves_draw(m, s, TIMES, seed, &e), "%s", e.message);
}

/* The mean of an object's Gaussians, as they are. */
static void middle(const struct synth_scene *s, int i, double at[3])
{
	const size_t n = s->first[i + 1] - s->first[i];

	at[0] = at[1] = at[2] = 0;
	for (size_t k = s->first[i]; k < s->first[i + 1]; k++)
		for (int d = 0; d < 3; d++)
			at[d] += (double)s->splats.means[3 * k + (size_t)d] / (double)n;
}

static double apart(const double a[3], const double b[3])
{
	return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

/* Gaussians of an object stay as far from each other as they were, and what is no object stays. */
static void check_rigid(const struct synth_moves *m)
{
	const struct synth_scene *s = m->scene;
	const float *a = m->first.means, *b = s->splats.means;

	for (int i = 0; i < s->object_count; i++)
		for (size_t k = s->first[i] + 1; k < s->first[i + 1]; k++) {
			double was[3], is[3];
			for (int d = 0; d < 3; d++) {
				was[d] = (double)a[3 * k + (size_t)d] - a[3 * (k - 1) + (size_t)d];
				is[d] = (double)b[3 * k + (size_t)d] - b[3 * (k - 1) + (size_t)d];
			}
			if (!CHECK(fabs(vector_length(was) - vector_length(is)) < 1e-5, "Gaussian %zu", k))
				return;
		}
	const size_t from = s->first[s->object_count];
	CHECK(!memcmp(a + 3 * from, b + 3 * from, 3 * (s->splats.n - from) * sizeof *a), "the room stays");
}

/* at (TIMES,8,3) */
static void follow(const struct synth_moves *m, double (*at)[8][3])
{
	const struct synth_scene *s = m->scene;

	for (int t = 0; t < TIMES; t++) {
		synth_moves_set(m, t);
		for (int i = 0; i < s->object_count; i++)
			middle(s, i, at[t][i]);
		if (t % 13 == 12)
			check_rigid(m);
		for (int i = 0; i < s->object_count; i++)
			for (int j = 0; j < i; j++)
				CHECK(apart(at[t][i], at[t][j]) > 0.2, "%s and %s meet", s->objects[i].name,
					s->objects[j].name);
	}
	synth_moves_set(m, 0);
	CHECK(!memcmp(m->first.means, s->splats.means, 3 * s->splats.n * sizeof(float)),
		"back at the first time");
}

/* From its first to its last movement, from positions alone; 0 where there is none. */
static int moves_within(double (*at)[8][3], int i, int *first, int *last)
{
	*first = *last = -1;
	for (int t = 1; t < TIMES; t++)
		if (apart(at[t][i], at[t - 1][i]) > 1e-7) {
			*first = *first < 0 ? t - 1 : *first;
			*last = t;
		}
	return *first >= 0;
}

/* What is said of object i alone, by its positions. */
static void check_meaning(const struct synth_moving_sentence *x, double (*at)[8][3], int i)
{
	const double *a = at[x->first][i], *b = at[x->last][i];
	int first, last;
	const int moves = moves_within(at, i, &first, &last);

	if (x->kind == SYNTH_MOVES_NOT)
		CHECK(!moves && x->first == 0 && x->last == TIMES - 1, "'%s' moves", x->text);
	else if (x->kind == SYNTH_ANY_MOVE || x->kind == SYNTH_STOPS || x->kind == SYNTH_MOVES_FIRST)
		CHECK(moves && x->first == first && x->last == last, "'%s': %d to %d", x->text, first, last);
	else if (x->kind == SYNTH_RAISED)
		CHECK(b[2] > a[2] + 0.9, "'%s' rises by %g", x->text, b[2] - a[2]);
	else if (x->kind == SYNTH_FALLS_DOWN || x->kind == SYNTH_PUT_DOWN)
		CHECK(b[2] < a[2] - 0.9, "'%s' comes down by %g", x->text, a[2] - b[2]);
	else if (x->kind == SYNTH_LEFTWARDS || x->kind == SYNTH_RIGHTWARDS)
		CHECK((x->kind == SYNTH_LEFTWARDS ? a[0] - b[0] : b[0] - a[0]) > 0.3, "'%s'", x->text);
	else if (x->kind == SYNTH_SLIDES_OFF || x->kind == SYNTH_ROLLS_OFF)
		CHECK(moves && fabs(a[2] - b[2]) < 0.05, "'%s' stays on the table", x->text);
}

static void sentences_mean_what_they_say(void)
{
	static double at[TIMES][8][3];
	int said[SYNTH_LISTS] = {0}, none = 0, several = 0;

	for (uint64_t seed = 1; seed <= SEEDS; seed++) {
		struct synth_scene s;
		struct synth_moves m;
		struct synth_moving_sentences list = {0};
		struct err e = {0};
		if (!make(&s, &m, seed) ||
			!CHECK(!synth_moving_make(&list, &m, 0, seed, &e), "%s", e.message))
			return;
		follow(&m, at);
		for (size_t k = 0; k < list.n; k++) {
			const struct synth_moving_sentence *x = &list.items[k];
			none += !x->objects;
			several += x->is_several;
			for (int i = 0; i < 8; i++)
				if (x->objects == (uint64_t)1 << i) {
					said[x->kind]++;
					check_meaning(x, at, i);
				}
		}
		free(list.items);
		synth_moves_free(&m);
		synth_scene_free(&s);
	}
	for (int k = SYNTH_MOTIONS; k < SYNTH_LISTS; k++)
		CHECK(said[k], "nothing is %s", synth_motion_name((enum synth_list)k));
	CHECK(none > SEEDS * 5 && several > SEEDS, "%d mean nothing, %d several", none, several);
}

int main(void)
{
	sentences_mean_what_they_say();
	return unit_end();
}
