/* Held-out supervision: which pairs are held out, their score against plain loops, and the best state. */
#include "unit.h"

#include "base/mem.h"
#include "base/rng.h"
#include "mask/bits.h"
#include "train/held_out.h"

#include <omp.h>

enum { VIEWS = 7, SENTENCES = 9, ROWS = 70, PIXELS = 45, ENTRIES = 5, WIDTH = 8, WORDS = 3 };

/* Sentence r is of object r % 4, by which the sentences of an object lie apart; the mask of (view, sentence)
 * has the pixels that it was drawn with. View 3 has nothing, view 4 but the even sentences. */
struct sample {
	struct train_view views[VIEWS];
	int objects[SENTENCES], sentences[VIEWS][SENTENCES];
	const uint8_t *masks[VIEWS][SENTENCES];
	uint8_t pixels[VIEWS][SENTENCES][PIXELS], bits[VIEWS][SENTENCES][PIXELS / 8 + 1];
	int64_t indptr[PIXELS + 1];
	int32_t index[VIEWS][PIXELS * ENTRIES];
	float weight[VIEWS][PIXELS * ENTRIES];
};

static void sample_init(struct sample *s)
{
	struct rng rng;

	memset(s, 0, sizeof *s);
	rng_seed(&rng, 4, 1);
	for (int r = 0; r < SENTENCES; r++)
		s->objects[r] = r % 4;
	for (int p = 0; p <= PIXELS; p++)
		s->indptr[p] = (int64_t)p * ENTRIES;
	for (int v = 0; v < VIEWS; v++) {
		for (int k = 0; k < PIXELS * ENTRIES; k++) {
			s->index[v][k] = (int32_t)rng_below(&rng, ROWS);
			s->weight[v][k] = (float)rng_uniform(&rng);
		}
		s->views[v] =
			(struct train_view){.weights = {PIXELS, ROWS, s->indptr, s->index[v], s->weight[v]},
				.sentences = s->sentences[v],
				.masks = s->masks[v]};
		for (int r = 0; r < SENTENCES; r++) {
			for (int p = 0; p < PIXELS; p++)
				s->pixels[v][r][p] = (uint8_t)rng_below(&rng, 2);
			bits_pack(s->pixels[v][r], PIXELS, s->bits[v][r]);
			if (v == 3 || (v == 4 && r % 2))
				continue;
			s->sentences[v][s->views[v].count] = r;
			s->masks[v][s->views[v].count++] = s->bits[v][r];
		}
	}
}

/* Pairs of a view and an object that are held out; checks that nothing else changed. */
static int count_held(const struct sample *s, const char *name)
{
	int held = 0;

	for (int v = 0; v < VIEWS; v++) {
		const struct train_view *view = &s->views[v];
		char is_held[4] = {0}, is_kept[4] = {0};
		CHECK(view->count + view->held == (v == 3	   ? 0
							  : v == 4 ? 5
								   : SENTENCES),
			"%s: view %d", name, v);
		for (int k = 0; k < view->count + view->held; k++) {
			const int r = view->sentences[k];
			(k < view->count ? is_kept : is_held)[s->objects[r]] = 1;
			CHECK(view->masks[k] == s->bits[v][r], "%s: another's mask", name);
			CHECK(!k || k == view->count || view->sentences[k - 1] < r, "%s: their order", name);
		}
		for (int o = 0; o < 4; o++) {
			CHECK(!is_kept[o] || !is_held[o], "%s: view %d, object %d is parted", name, v, o);
			held += is_held[o];
		}
	}
	return held;
}

static void test_choose(void)
{
	/* Five views with four objects, one with two (0 and 2). */
	const struct {
		double share;
		int held;
	} cases[] = {{0.25, 6}, {0.001, 1}, {0.5, 11}, {0.9, 20}, {0.99, 21}};
	static struct sample s, again, other;
	struct err e;

	for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
		char name[32];
		snprintf(name, sizeof name, "share %g", cases[c].share);
		sample_init(&s);
		CHECK(!held_out_choose(s.views, VIEWS, s.objects, SENTENCES, cases[c].share, 1, &e), "%s",
			e.message);
		const int held = count_held(&s, name);
		CHECK(held == cases[c].held, "%s: %d pairs", name, held);
	}
	sample_init(&s);
	sample_init(&again);
	sample_init(&other);
	CHECK(!held_out_choose(s.views, VIEWS, s.objects, SENTENCES, 0.3, 1, &e) &&
			!held_out_choose(again.views, VIEWS, s.objects, SENTENCES, 0.3, 1, &e) &&
			!held_out_choose(other.views, VIEWS, s.objects, SENTENCES, 0.3, 2, &e),
		"%s", e.message);
	CHECK(!memcmp(s.sentences, again.sentences, sizeof s.sentences), "not the same twice");
	CHECK(memcmp(s.sentences, other.sentences, sizeof s.sentences), "seed 2 is as seed 1");
	sample_init(&s);
	s.views[0].count = 1;
	CHECK(held_out_choose(s.views, 1, s.objects, SENTENCES, 0.5, 1, &e) && e.code == ERR_FORMAT &&
			!strcmp(e.message, "one pair of a view and an object, none to hold out"),
		"%s", e.message);
}

static void test_evaluate(void)
{
	static struct sample s;
	struct refer_layout layout;
	struct held_out h;
	struct err e;
	struct rng rng;
	float position[ROWS * 3], words[SENTENCES * WORDS * WIDTH], m[ROWS];
	int64_t offsets[SENTENCES + 1];
	struct held_out_score expected = {0}, got[3];
	int pairs = 0;

	sample_init(&s);
	refer_layout_init(&layout, REFER_PCMI, WIDTH, 4);
	float *parameters = mem_zalloc(layout.count + panels_padded(ROWS) * 4, sizeof(float), "test", &e);
	float *x = parameters + layout.count;
	rng_seed(&rng, 8, 1);
	refer_init(&layout, parameters, &rng);
	for (size_t i = 0; i < panels_padded(ROWS) * 4; i++)
		x[i] = (float)rng_normal(&rng);
	for (int i = 0; i < ROWS * 3; i++)
		position[i] = (float)rng_range(&rng, -1, 1);
	for (int i = 0; i < SENTENCES * WORDS * WIDTH; i++)
		words[i] = (float)rng_normal(&rng);
	for (int r = 0; r <= SENTENCES; r++)
		offsets[r] = r * WORDS;
	const struct step_setup setup = {.layout = &layout,
		.similarity = REFER_DOT,
		.temperature = 1,
		.gaussians = ROWS,
		.position = position,
		.sentences = SENTENCES,
		.offsets = offsets,
		.words = words,
		.objects = s.objects,
		.pixels = PIXELS,
		.batch = 1};
	CHECK(!held_out_choose(s.views, VIEWS, s.objects, SENTENCES, 0.4, 1, &e), "%s", e.message);
	for (int threads = 1; threads <= 3; threads++) {
		omp_set_num_threads(threads);
		struct step *step = step_new(&setup, &e);
		const struct view_source views = {.views = s.views, .n = VIEWS};
		CHECK(step && !held_out_init(&h, &views, s.objects, SENTENCES, ROWS, &e), "%s", e.message);
		CHECK(!held_out_evaluate(&h, step, parameters, x, &got[threads - 1], &e), "%s", e.message);
		for (int v = 0; v < VIEWS && threads == 1; v++)
			for (int k = s.views[v].count; k < s.views[v].count + s.views[v].held; k++) {
				const int r = s.views[v].sentences[k];
				double bce = 0, both = 0, either = 0;
				step_respond(step, parameters, x, (size_t)r, m);
				for (int p = 0; p < PIXELS; p++) {
					double sum = 0;
					for (int i = p * ENTRIES; i < (p + 1) * ENTRIES; i++)
						sum += (double)s.weight[v][i] * (double)m[s.index[v][i]];
					const int is_set = s.pixels[v][r][p];
					bce += log1p(exp(is_set ? -sum : sum)) / PIXELS;
					both += is_set && sum > 0;
					either += is_set || sum > 0;
				}
				expected.bce += bce;
				expected.iou += both / either;
				pairs++;
			}
		held_out_free(&h);
		step_free(step);
	}
	CHECK(pairs > 10, "%d pairs", pairs);
	CHECK(fabs(got[0].bce - expected.bce / pairs) < 1e-5 * got[0].bce, "bce %.9g, expected %.9g",
		got[0].bce, expected.bce / pairs);
	CHECK(fabs(got[0].iou - expected.iou / pairs) < 1e-9 && got[0].iou > 0.01, "IoU %.9g, expected %.9g",
		got[0].iou, expected.iou / pairs);
	CHECK(!memcmp(&got[0], &got[1], sizeof *got) && !memcmp(&got[0], &got[2], sizeof *got),
		"depends on the number of threads");
	free(parameters);
}

static void test_best(void)
{
	const double scores[] = {0.1, 0.3, 0.3, 0.2, 0.4, 0.1};
	const long best[] = {1, 2, 2, 2, 5, 5}, since[] = {0, 0, 1, 2, 0, 1};
	struct refer_layout layout;
	struct train_state t;
	struct err e;

	refer_layout_init(&layout, REFER_NONE, WIDTH, 4);
	CHECK(!train_state_init(&t, &layout, ROWS, 0, 1, &e) && !t.best.values, "%s", e.message);
	train_state_free(&t);
	CHECK(!train_state_init(&t, &layout, ROWS, 1, 1, &e) && !t.best.iteration, "%s", e.message);
	for (int k = 0; k < 6; k++) {
		t.iteration = k + 1;
		t.values[0] = (float)t.iteration;
		t.values[t.count - 1] = (float)t.iteration;
		train_evaluated(&t, scores[k]);
		CHECK(t.best.iteration == best[k] && t.best.since == since[k],
			"evaluation %d: %ld, %ld since", k, t.best.iteration, t.best.since);
		CHECK(t.best.values[0] == (float)best[k] && t.best.values[t.count - 1] == (float)best[k],
			"evaluation %d: its values", k);
	}
	train_state_free(&t);
}

int main(void)
{
	test_choose();
	test_evaluate();
	test_best();
	return unit_end();
}
