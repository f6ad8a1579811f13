/* Pooling candidates, and masks propagated from the view where they begin to the others, against the
 * definition in plain float64. */
#include "lift/propagate.h"
#include "mask_help.h"
#include "unit.h"

#include <omp.h>

enum { H = 20, W = 30, P = H * W, N = 150, ENTRIES = 6, VIEWS = 4, OBJECTS = 20, MOST = 3 * OBJECTS };

struct scene {
	int64_t indptr[VIEWS][P + 1];
	int32_t index[VIEWS][P * ENTRIES];
	float weight[VIEWS][P * ENTRIES];
	struct view_weights weights[VIEWS];
	struct camera views[VIEWS]; /* view 1 is a test view */
	struct cameras cameras;
};

/* Pixels that are near have Gaussians that are, so that masks survive; every view leaves out its own tenth of
 * the Gaussians wholly. The last pixels of a view have no weight. */
static void make_scene(struct scene *s, struct rng *r)
{
	static char names[VIEWS][3] = {"v0", "v1", "v2", "v3"};

	for (int v = 0; v < VIEWS; v++) {
		int64_t n = 0;
		for (int p = 0; p < P; p++) {
			s->indptr[v][p] = n;
			for (int k = 0; k < ENTRIES && p < P - 9; k++) {
				int at = (p / W * 15 / H) * 10 + p % W * 10 / W;
				int i = (at + (int)rng_below(r, 4) * (k ? 1 : 0) + k % 2 * 10) % N;
				if (i % 10 == v)
					continue;
				s->index[v][n] = i;
				s->weight[v][n++] = (float)(rng_uniform(r) / ENTRIES);
			}
		}
		s->indptr[v][P] = n;
		s->weights[v] = (struct view_weights){P, N, s->indptr[v], s->index[v], s->weight[v]};
		s->views[v] = (struct camera){.name = names[v], .split = v == 1 ? SPLIT_TEST : SPLIT_TRAIN};
	}
	s->cameras = (struct cameras){VIEWS, s->views};
}

/* By the definition: 1 in the mask, 0 not, -1 where rounding may decide. */
static int naive_pixel(const struct scene *s, int from, const uint8_t *mask, int to, int pixel)
{
	double in[N] = {0}, seen[N] = {0}, yes = 0, known = 0, all = 0;
	const struct view_weights *w = &s->weights[from], *x = &s->weights[to];

	for (size_t p = 0; p < P; p++)
		for (int64_t k = w->indptr[p]; k < w->indptr[p + 1]; k++) {
			in[w->index[k]] += mask[p] * (double)w->weight[k];
			seen[w->index[k]] += (double)w->weight[k];
		}
	for (int64_t k = x->indptr[pixel]; k < x->indptr[pixel + 1]; k++) {
		const int i = x->index[k];
		all += (double)x->weight[k];
		known += seen[i] > 0 ? (double)x->weight[k] : 0;
		yes += seen[i] > 0 ? (double)x->weight[k] * in[i] / seen[i] : 0;
	}
	if (all > 0 && (fabs(yes - known / 2) < 1e-6 || fabs(known - all / 2) < 1e-6))
		return -1;
	return yes > known / 2 && known >= all / 2;
}

static void check_view(const struct scene *s, const struct propagation *c, const struct mask *candidates,
	uint8_t *const *pixels, int view, int *in, int *out)
{
	struct rle masks[2][OBJECTS];
	uint8_t got[P];
	struct err e;

	for (int threads = 1; threads <= 2; threads++) {
		omp_set_num_threads(threads);
		CHECK(!propagate_render(c, (size_t)view, &s->weights[view], H, W, masks[threads - 1], &e),
			"%s", e.message);
	}
	for (size_t k = 0; k < c->count; k++) {
		const struct rle *m = &masks[0][k], *other = &masks[1][k];
		const uint8_t *mask = pixels[c->starts[k].mask - candidates];
		CHECK(m->n == other->n && !memcmp(m->runs, other->runs, m->n * sizeof *m->runs),
			"view %d mask %zu: threads differ", view, k);
		rle_decode(m, got);
		for (int p = 0; p < P; p++) {
			int expected = (int)c->starts[k].view == view
					       ? mask[p]
					       : naive_pixel(s, (int)c->starts[k].view, mask, view, p);
			if (expected < 0)
				continue;
			CHECK(got[p] == expected, "view %d mask %zu pixel %d", view, k, p);
			*in += expected;
			*out += !expected;
		}
		rle_free(&masks[0][k]);
		rle_free(&masks[1][k]);
	}
}

/* Objects come in order; those below 3 have nothing above 0.3 in the first view, so that they begin in the
 * third (the second is a test view), object 3 nowhere. Each has a weaker candidate too. */
static void test_propagation(void)
{
	static struct scene s;
	static char names[OBJECTS][16];
	struct mask masks[MOST];
	uint8_t *pixels[MOST];
	size_t views[MOST], n = 0, count = 0;
	int in = 0, out = 0;
	struct propagation c;
	struct pool pool;
	struct rng r;
	struct err e;

	rng_seed(&r, 5, 1);
	make_scene(&s, &r);
	for (int o = 0; o < OBJECTS; o++)
		for (int k = 0; k < 3; k++) {
			const int view = o < 3 ? 2 - k : k < 2 ? 0 : 1 + o % 3;
			const double score = o == 3 ? 0.3 : o < 3 && view == 0 ? 0.1 : 0.9 - 0.1 * k;
			snprintf(names[o], sizeof names[o], "o%d", o);
			pixels[n] = mask_random(&r, H, W, 1);
			views[n] = (size_t)view;
			masks[n] = (struct mask){s.views[view].name, NULL, names[o],
				mask_rle(pixels[n], H, W), score, NAN, NULL};
			n++;
		}
	CHECK(!pool_make(&pool, masks, n, &e) && !pool_select(&pool, SELECT_TOP1, 0.3, &e), "%s", e.message);
	CHECK(!propagate_init(&c, &pool, views, &s.cameras, &e), "%s", e.message);
	CHECK(c.count == OBJECTS - 1 && c.source_count == 2, "%zu in %zu views", c.count, c.source_count);
	for (int o = 0; o < OBJECTS; o++) {
		if (o == 3)
			continue;
		const struct propagate_start *at = &c.starts[count];
		CHECK(at->mask == &masks[3 * o] && at->view == (o < 3 ? 2 : 0),
			"object %d: mask %td, view %zu", o, at->mask - masks, at->view);
		count++;
	}
	for (size_t i = 0; i < c.source_count; i++)
		CHECK(!propagate_lift(&c, i, &s.weights[c.sources[i].view], H, W, &e), "%s", e.message);
	for (int v = 0; v < VIEWS; v++)
		check_view(&s, &c, masks, pixels, v, &in, &out);
	CHECK(in > P && out > P, "%d pixels in masks, %d not", in, out);
	propagate_free(&c);
	pool_free(&pool);
	for (size_t i = 0; i < n; i++) {
		rle_free(&masks[i].rle);
		free(pixels[i]);
	}
}

static void test_pool(void)
{
	const uint8_t wide[6] = {0, 1}, tall[6] = {1};
	struct rle m[2] = {mask_rle(wide, 2, 3), mask_rle(tall, 3, 2)};
	struct mask records[] = {
		{"b", "cup-1", "cup", m[0], 0.5, NAN, NULL},
		{"a", "cup", NULL, m[0], 0.5, NAN, NULL}, /* a sentence's name is no object's */
		{"a", "cup-1", "cup", m[0], 0.2, NAN, NULL},
		{"b", "jar-1", "jar", m[0], 0.5, NAN, NULL},
		{"a", "cup-2", "cup", m[0], 0.6, NAN, NULL},
		{"b", "cup-2", "cup", m[0], 0.7, NAN, NULL},
	};
	const size_t first[] = {0, 1, 2, 3}, object[] = {0, 1, 0, 3}, sizes[] = {2, 1, 2, 1};
	const long winner[] = {5, 1, 4, 3};
	size_t bad, other;
	struct pool p;
	struct err e;

	CHECK(!pool_make(&p, records, 6, &e) && !pool_check_sizes(&p, &bad, &other), "%s", e.message);
	CHECK(!pool_select(&p, SELECT_TOP1, 0.3, &e) && p.group_count == 4, "%zu groups", p.group_count);
	for (size_t i = 0; i < p.group_count; i++) {
		const struct pool_group *g = &p.groups[i];
		CHECK(g->first == first[i] && g->object == object[i] && g->n == sizes[i] &&
				g->winner == winner[i] && g->vote == records[winner[i]].score,
			"group %zu: first %zu, object %zu, %zu, winner %ld", i, g->first, g->object, g->n,
			g->winner);
	}
	pool_free(&p);
	records[4].rle = m[1];
	CHECK(!pool_make(&p, records, 6, &e) && pool_check_sizes(&p, &bad, &other) && bad == 4 && other == 1,
		"%zu differs from %zu", bad, other);
	pool_free(&p);
	CHECK(!pool_make(&p, records, 0, &e) && !pool_select(&p, SELECT_CIOU, 0, &e) && !p.group_count,
		"none");
	pool_free(&p);
	rle_free(&m[0]);
	rle_free(&m[1]);
}

int main(void)
{
	test_pool();
	test_propagation();
	return unit_end();
}
