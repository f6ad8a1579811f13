/* Regions on a made-up scene: the detector takes one object for another in most views of most sentences, so
 * that votes get it wrong and regions right; and sums and agreements against the definition in float64. */
#include "lift/regions.h"
#include "mask_help.h"
#include "pack_whole.h"
#include "unit.h"

#include <omp.h>
#include <stdio.h>

enum { H = 24, W = 32, P = H * W, VIEWS = 7, N = P + VIEWS, MOST = 400, BARE = 5, UNLIT = 6 };
enum { BOX, BAG, CAN, JAR, OBJECTS }; /* in the order in which they come */

/* Gaussian p + v is what pixel p of view v shows, with a little of another through it. The last view has no
 * weights, the one before no candidates. Weights are as packed ones, in both forms. */
enum { ROWS, TILES, FORMS };
struct scene {
	struct weights_room rooms[VIEWS];
	struct view_matrix weights[FORMS][VIEWS];
	size_t n, views[MOST];
	struct mask masks[MOST];
};

static const char *const objects[OBJECTS] = {"box", "bag", "can", "jar"};
static const int sides[OBJECTS][4] = {{2, 3, 9, 11}, {3, 17, 10, 26}, {15, 20, 20, 24}, {13, 9, 21, 14}};

static void make_weights(struct scene *s, struct rng *r)
{
	for (int v = 0; v < VIEWS; v++) {
		static int64_t indptr[P + 1];
		static int32_t index[2 * P];
		static float weight[2 * P];
		struct weights_room *room = &s->rooms[v];
		struct weights_pack pack;
		struct err e;
		for (int p = 0; p < P; p++) {
			indptr[p] = 2 * p;
			index[2 * p] = p + v;
			index[2 * p + 1] = (int32_t)rng_below(r, N);
			weight[2 * p] = (float)(0.6 + 0.3 * rng_uniform(r));
			weight[2 * p + 1] = (float)(0.03 * rng_uniform(r));
		}
		indptr[P] = 2 * P;
		CHECK(!pack_whole(&pack, W, H, N, indptr, index, weight, &e) &&
				!weights_unpack(&pack, W, H, N, "w", room, &e),
			"%s", e.message);
		weights_pack_free(&pack);
		s->weights[ROWS][v] =
			(struct view_matrix){H, W, N, {P, N, room->indptr, room->index, room->weight}, NULL};
		s->weights[TILES][v] = (struct view_matrix){H, W, N, {P, N, NULL, NULL, NULL}, &room->tiles};
	}
}

static void scene_free(struct scene *s, size_t masks)
{
	for (int v = 0; v < VIEWS; v++)
		weights_room_free(&s->rooms[v]);
	for (size_t i = 0; i < masks; i++)
		rle_free(&s->masks[i].rle);
}

/* An object in a view, its rows short by `cut` pixels: pixels (P). */
static void draw(uint8_t *pixels, int object, int view, int cut)
{
	const int *side = sides[object];

	memset(pixels, 0, P);
	for (int y = side[0]; y < side[2]; y++)
		for (int x = side[1]; x < side[3] - cut; x++)
			pixels[y * W + x - view] = 1;
}

static void add(struct scene *s, int object, const char *ref, int view, int shown, int cut, double score)
{
	static const char *const names[VIEWS] = {"v0", "v1", "v2", "v3", "v4", "v5", "v6"};
	uint8_t pixels[P];
	struct err e;

	draw(pixels, shown, view, cut);
	struct rle *mask = &s->masks[s->n].rle, small = mask_rle(pixels, H, W);
	/* one view has larger pictures */
	if (view == 2) {
		CHECK(!rle_resize(mask, &small, 2 * H, 2 * W, &e), "%s", e.message);
		rle_free(&small);
	} else {
		*mask = small;
	}
	s->views[s->n] = (size_t)view;
	s->masks[s->n++] = (struct mask){names[view], ref, objects[object], *mask, score, NAN, NULL};
}

/* Three of the bag's four sentences show the box, surely, in all views but one; the fourth knows it.
 * The jar is found in one view only, the can never with confidence. */
static void make_candidates(struct scene *s)
{
	static const char *const box[] = {"box-1", "box-2", "box-3", "box-4"};
	static const char *const bag[] = {"bag-1", "bag-2", "bag-3", "bag-4"};

	for (int v = 0; v < VIEWS; v++) {
		if (v == BARE)
			continue;
		for (int k = 0; k < 4; k++) {
			add(s, BOX, box[k], v, BOX, (k + v) % 3 == 2, 0.6 + 0.05 * k);
			const int is_wrong = k < 3 && v != k;
			/* where nobody finds the bag, it is rendered */
			add(s, BAG, bag[k], v, is_wrong || v == 4 ? BOX : BAG, (k + v) % 3 == 1,
				is_wrong ? 0.9 : 0.5);
		}
		if (v == 3)
			add(s, JAR, NULL, v, JAR, 0, 0.7);
		add(s, CAN, "can-1", v, CAN, 0, 0.3);
	}
}

static double iou(const struct rle *mask, int object, int view)
{
	uint8_t pixels[P];
	struct rle truth, same;
	struct err e;

	draw(pixels, object, view, 0);
	truth = mask_rle(pixels, H, W);
	CHECK(!rle_resize(&same, mask, H, W, &e), "%s", e.message);
	double is = rle_iou(&truth, &same);
	rle_free(&truth);
	rle_free(&same);
	return is;
}

static double naive_sum(const struct scene *s, size_t view, const uint8_t *mask, int32_t gaussian)
{
	const struct view_weights *w = &s->weights[ROWS][view].rows;
	double sum = 0;

	for (int p = 0; p < P; p++)
		for (int64_t k = w->indptr[p]; k < w->indptr[p + 1] && (!mask || mask[p]); k++)
			sum += w->index[k] == gaussian ? (double)w->weight[k] : 0;
	return sum;
}

static void check_sums(const struct scene *s, const struct regions *r)
{
	for (size_t c = 0; c < r->count; c += 5) {
		const struct regions_candidate *at = &r->candidates[c];
		uint8_t pixels[P];
		double share[N], mass = 0;
		struct rle same;
		struct err e;
		if (at->view == UNLIT) {
			CHECK(!at->shares.n, "candidate %zu has no weights", c);
			continue;
		}
		CHECK(!rle_resize(&same, &at->mask->rle, H, W, &e), "%s", e.message);
		rle_decode(&same, pixels);
		rle_free(&same);
		for (int i = 0; i < N; i++)
			mass += share[i] = naive_sum(s, at->view, pixels, i);
		for (size_t k = 0; k < at->shares.n; k++)
			CHECK(fabs((double)at->shares.share[k] - share[at->shares.index[k]]) < 1e-5,
				"candidate %zu, %d: %g", c, at->shares.index[k], (double)at->shares.share[k]);
		CHECK(fabs(at->mass - mass) < 1e-3, "candidate %zu: %g, expected %g", c, at->mass, mass);
		for (size_t i = 0; i < r->region_count; i++) {
			const struct region *region = &r->regions[i];
			double both = 0, area = 0;
			for (size_t k = 0; k < region->n; k++) {
				both += share[region->members[k]];
				area += naive_sum(s, at->view, NULL, region->members[k]);
			}
			double expected = both / (area + mass - both);
			/* what is too little to matter may be given as 0 */
			CHECK(fabs((double)region->agreement[c] - expected) < 1e-5 ||
					(expected < 0.26 && !region->agreement[c]),
				"region %zu, candidate %zu: %g, expected %g", i, c,
				(double)region->agreement[c], expected);
		}
	}
}

/* A copy of everything that one number of threads gave, to compare with the next. */
struct result {
	struct rle masks[VIEWS][OBJECTS];
	double scores[VIEWS][OBJECTS];
};

static void solve(const struct scene *s, const struct pool *p, int form, int is_backward, struct result *to)
{
	struct regions r;
	size_t rendered = 0;
	int bad = 0;
	struct err e;

	CHECK(!regions_init(&r, p, s->views, VIEWS, N, 0.3, &e), "%s", e.message);
	CHECK(r.object_count == OBJECTS && r.sentence_count == 9, "%zu objects, %zu sentences",
		r.object_count, r.sentence_count);
	/* in any order, and at once */
#pragma omp parallel for schedule(static, 1) reduction(| : bad)
	for (size_t k = 0; k < UNLIT; k++) {
		const size_t v = is_backward ? UNLIT - 1 - k : k;
		struct err own;
		bad |= regions_lift(&r, v, &s->weights[form][v], &own);
	}
	CHECK(!bad, "a view is not lifted");
	CHECK(!regions_grow(&r, &e) && r.region_count == 3, "%zu regions", r.region_count);
	CHECK(!regions_assign(&r, &e), "%s", e.message);
	check_sums(s, &r);
	CHECK(r.served[CAN] == REGIONS_NONE, "the can has region %zu", r.served[CAN]);
	for (size_t v = 0; v < UNLIT; v++) {
		CHECK(!regions_render(
			      &r, v, &s->weights[form][v], to->masks[v], to->scores[v], &rendered, &e),
			"%s", e.message);
		CHECK(!rle_area(&to->masks[v][CAN]), "view %zu has a can", v);
		for (int o = 0; o < OBJECTS; o++) {
			const struct rle *mask = &to->masks[v][o];
			if (o == CAN)
				continue;
			CHECK(mask->height == (v == 2 ? 2 * H : H) && mask->width == (v == 2 ? 2 * W : W),
				"view %zu: %dx%d", v, mask->width, mask->height);
			CHECK(iou(mask, o, (int)v) > 0.85, "view %zu: %s has %g", v, objects[o],
				iou(mask, o, (int)v));
			CHECK(to->scores[v][o] > 0.5 && to->scores[v][o] <= 1, "view %zu: %g", v,
				to->scores[v][o]);
		}
	}
	/* all in the view without candidates, the bag where nobody finds it, the jar where it was not found
	 */
	CHECK(rendered == 3 + 1 + 4, "%zu rendered", rendered);
	regions_free(&r);
}

static void result_free(struct result *r)
{
	for (int v = 0; v < UNLIT; v++)
		for (int o = 0; o < OBJECTS; o++)
			rle_free(&r->masks[v][o]);
}

/* Frees b. */
static void compare(const struct result *a, struct result *b, const char *what)
{
	for (int v = 0; v < UNLIT; v++)
		for (int o = 0; o < OBJECTS; o++) {
			const struct rle *m = &a->masks[v][o], *other = &b->masks[v][o];
			CHECK(m->n == other->n &&
					(!m->n || !memcmp(m->runs, other->runs, m->n * sizeof *m->runs)) &&
					a->scores[v][o] == b->scores[v][o],
				"view %d, %s: %s differ", v, objects[o], what);
		}
	result_free(b);
}

/* Rows of pixels are summed in floats: the same masks, and scores but for rounding. Frees b. */
static void compare_masks(const struct result *a, struct result *b)
{
	for (int v = 0; v < UNLIT; v++)
		for (int o = 0; o < OBJECTS; o++) {
			const struct rle *m = &a->masks[v][o], *other = &b->masks[v][o];
			CHECK(m->n == other->n &&
					(!m->n || !memcmp(m->runs, other->runs, m->n * sizeof *m->runs)) &&
					fabs(a->scores[v][o] - b->scores[v][o]) < 1e-5,
				"view %d, %s: rows differ from tiles", v, objects[o]);
		}
	result_free(b);
}

static void test_confusion(void)
{
	static struct scene s;
	static struct result results[2];
	size_t wrong = 0;
	struct pool pool;
	struct rng r;
	struct err e;

	rng_seed(&r, 21, 1);
	make_weights(&s, &r);
	make_candidates(&s);
	const size_t once = s.n;
	CHECK(!pool_make(&pool, s.masks, s.n, &e) && !pool_select(&pool, SELECT_CIOU, 0.3, &e), "%s",
		e.message);
	for (size_t g = 0; g < pool.group_count; g++)
		if (!strcmp(s.masks[pool.groups[g].first].object, "bag"))
			wrong += iou(&s.masks[pool.groups[g].winner].rle, BAG,
					 (int)s.views[pool.groups[g].first]) < 0.1;
	CHECK(wrong == 4, "votes err in %zu views", wrong);
	for (int threads = 1; threads <= 2; threads++) {
		omp_set_num_threads(threads);
		solve(&s, &pool, TILES, threads == 2, &results[threads - 1]);
	}
	compare(&results[0], &results[1], "threads, and the order of views");
	solve(&s, &pool, ROWS, 0, &results[1]);
	compare_masks(&results[0], &results[1]);
	pool_free(&pool);
	/* every record twice */
	for (size_t i = 0; i < once; i++, s.n++) {
		s.masks[s.n] = s.masks[i];
		s.views[s.n] = s.views[i];
	}
	CHECK(!pool_make(&pool, s.masks, s.n, &e), "%s", e.message);
	solve(&s, &pool, TILES, 0, &results[1]);
	compare(&results[0], &results[1], "doubled records");
	pool_free(&pool);
	result_free(&results[0]);
	scene_free(&s, once);
}

/* A thing that one of the box's sentences means, and no object is, is spare; not so the part of the box that
 * another one means, and what is found in one view only. */
static void test_spare(void)
{
	static const char *const box[] = {"box-1", "box-2", "box-3", "box-4", "box-5"};
	static struct scene s;
	double score, before = 0;
	struct regions r;
	struct pool pool;
	struct rng rng;
	struct err e;

	rng_seed(&rng, 22, 1);
	make_weights(&s, &rng);
	for (int v = 0; v < BARE; v++) {
		for (int k = 0; k < 5; k++)
			add(&s, BOX, box[k], v, k == 3 ? CAN : BOX, k == 4 ? 4 : 0, 0.6);
		add(&s, BAG, "bag-1", v, BAG, 0, 0.6);
		if (v == 3)
			add(&s, BAG, "bag-2", v, JAR, 0, 0.9);
	}
	CHECK(!pool_make(&pool, s.masks, s.n, &e), "%s", e.message);
	for (int threads = 1; threads <= 2; threads++) {
		omp_set_num_threads(threads);
		CHECK(!regions_init(&r, &pool, s.views, VIEWS, N, 0.3, &e), "%s", e.message);
		for (size_t v = 0; v < UNLIT; v++)
			CHECK(!regions_lift(&r, v, &s.weights[TILES][v], &e), "%s", e.message);
		CHECK(!regions_grow(&r, &e) && !regions_assign(&r, &e), "%s", e.message);
		CHECK(r.region_count > 3 && r.spare_count == 1, "%zu of %zu regions are spare", r.spare_count,
			r.region_count);
		double sum = 0;
		for (size_t v = 0; v < BARE && r.spare_count; v++) {
			const struct mask *m = regions_spare(&r, 0, v, &score);
			CHECK(m && iou(&m->rle, CAN, (int)v) > 0.99 && score > 0.5, "view %zu: %g", v, score);
			sum += score;
		}
		CHECK(!r.spare_count || !regions_spare(&r, 0, BARE, &score), "a mask in a view without any");
		CHECK(threads == 1 || sum == before, "%d threads: %g, not %g", threads, sum, before);
		before = sum;
		regions_free(&r);
	}
	pool_free(&pool);
	scene_free(&s, s.n);
}

static void test_none(void)
{
	const size_t none[1] = {0};
	struct regions r;
	struct pool p;
	struct err e;

	CHECK(!pool_make(&p, NULL, 0, &e) && !regions_init(&r, &p, none, 2, 5, 0.3, &e), "%s", e.message);
	CHECK(!regions_grow(&r, &e) && !regions_assign(&r, &e) && !r.region_count && !r.spare_count, "none");
	regions_free(&r);
	pool_free(&p);
}

int main(void)
{
	test_confusion();
	test_spare();
	test_none();
	return unit_end();
}
