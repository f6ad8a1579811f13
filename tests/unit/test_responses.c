/* Answers from lifted objects: what sentences share, outlines of what is hidden; and what trained models
 * blend. */
#include "tests/unit/default_parser.h"
#include "unit.h"

#include "answer/answer.h"
#include "answer/responses.h"
#include "ask/choose.h"
#include "base/mem.h"
#include "splat/render.h"

enum { N = 4, SIDE = 32, SENTENCES = 6, MOST = 4 };

/* Gaussian 0 is a small thing before the large 1; 2 is seen by nothing; 3 is behind
 * everything. */
static float means[] = {0, 0, 4, 0, 0, 5, 0, 0, -3, 0, 0, 10};
static float scales[] = {.2f, .2f, .2f, .5f, .5f, .5f, 1, 1, 1, 20, 20, 20};
static float quats[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
static float opacities[] = {1, 1, 1, 1}, sh[3 * N];
static const struct splats splats = {N, 1, SPLATS_NEAR, means, scales, quats, opacities, sh};
static struct camera camera = {.name = (char[]){"v"},
	.width = SIDE,
	.height = SIDE,
	.fx = SIDE,
	.fy = SIDE,
	.cx = SIDE / 2,
	.cy = SIDE / 2,
	.world_to_camera = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
static const struct cameras cameras = {1, &camera};

/* A small ball, a large box, and a third thing with something of the small one; each is named by one word
 * along an axis of its own. */
static char *names[] = {"ball", "box", "book"};
static float confidence[] = {0.5f, 1, 1}, share[] = {1, 0.1f, 1, 0.7f, 0.3f, 0.7f};
static int64_t indptr[] = {0, 1, 4, 6}, offsets[] = {0, 1, 2, 3};
static int32_t index_of[] = {0, 0, 1, 2, 0, 3}, object[] = {0, 1, 2};
static float words[] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
static const struct lifted lifted = {N, 3, names, confidence, indptr, index_of, share, 3, 3, object, names,
	names, offsets, words, NULL, NULL, NULL};

/* The large one, the small one, again the large one, nothing, the small or the large one, and no words. */
static const int64_t asked_offsets[] = {0, 1, 2, 3, 3, 4, 4};
static const float asked_words[] = {0, 1, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
static char *pieces[] = {"box", "ball", "box", "", "zeppelin", ""};
static const size_t which[] = {0, 1, 2, 3, 4, 5};
static struct parser parser;

__attribute__((constructor)) static void make_parser(void)
{
	parser = default_parser();
}
static const struct responses_question of = {&splats, &cameras, asked_offsets, asked_words, NULL, pieces,
	pieces, NULL, &parser, NULL, which, SENTENCES, pieces, "model", 0};

static float at(const struct responses *a, size_t answer, size_t gaussian)
{
	return a->responses[gaussian * a->answers + answer];
}

static void test_sharing(void)
{
	struct responses a;
	struct err e = {0};

	if (!CHECK(!responses_lifted(&a, &lifted, &of, CHOOSE_ALL, 0.95, &e), "%s", e.message))
		return;
	CHECK(a.answers == 3, "%zu answers", a.answers);
	CHECK(a.answer[0] == a.answer[2] && a.answer[1] != a.answer[0], "one answer for one object");
	CHECK(a.answer[3] == a.answer[4] && a.answer[3] == a.answer[5] && a.answer[3] != a.answer[0] &&
			a.answer[3] != a.answer[1],
		"the same answer for all that mean nothing");
	CHECK(a.sure[0] > 0.6 && a.sure[0] == a.sure[2], "%g", a.sure[0]);
	CHECK(a.sure[1] > 0.3 && a.sure[1] <= 0.5, "times confidence: %g", a.sure[1]);
	CHECK(!(a.sure[3] > 0 || a.sure[4] > 0 || a.sure[5] > 0), "nothing is meant");
	for (size_t i = 0; i < N; i++)
		CHECK(!(fabsf(at(&a, a.answer[3], i)) > 0), "a response of nothing");
	CHECK(fabsf(at(&a, a.answer[0], 1) - (1 - LIFTED_CUT)) < 1e-6f &&
			fabsf(at(&a, a.answer[1], 1) + LIFTED_CUT) < 1e-6f,
		"responses");
	responses_free(&a);
	if (!CHECK(!responses_lifted(&a, &lifted, &of, CHOOSE_ALL, 0, &e), "%s", e.message))
		return;
	CHECK(a.answer[4] != a.answer[3],
		"with no least probability every sentence with words means something");
	responses_free(&a);
}

static void test_wholes(void)
{
	struct responses a;
	struct splats wholes[MOST];
	struct err e = {0};

	if (!CHECK(!responses_lifted(&a, &lifted, &of, CHOOSE_ALL, 0.95, &e), "%s", e.message))
		return;
	if (CHECK(!responses_wholes(&a, &splats, &cameras, wholes, &e), "%s", e.message)) {
		const struct splats *large = &wholes[a.answer[0]], *small = &wholes[a.answer[1]];
		CHECK(small->n == 1 && !memcmp(small->means, means, 3 * sizeof *means), "the small one");
		CHECK(large->n == 1 && !memcmp(large->means, means + 3, 3 * sizeof *means) &&
				!memcmp(large->scales, scales + 3, 3 * sizeof *scales),
			"the large one, without what no view shows");
		CHECK(!wholes[a.answer[3]].n, "nothing");
		for (size_t k = 0; k < a.answers; k++)
			splats_free(&wholes[k]);
	}
	responses_free(&a);
}

struct seen {
	size_t calls, views, area[MOST];
	uint8_t mask[MOST][SIDE * SIDE];
	double visible[MOST];
};

static int each(void *data, const struct answer *a, struct err *e)
{
	struct seen *s = data;

	(void)e;
	s->calls++;
	s->visible[a->answer] = a->visible;
	memcpy(s->mask[a->answer], a->mask, sizeof s->mask[0]);
	for (size_t p = 0; p < SIDE * SIDE; p++) {
		s->area[a->answer] += a->mask[p];
		if ((a->image[p] > 0) != a->mask[p])
			CHECK(0, "pixel %zu: mask and image differ", p);
	}
	return 0;
}

static int done(void *data, size_t view, struct err *e)
{
	(void)view;
	(void)e;
	((struct seen *)data)->views++;
	return 0;
}

static void test_outlines(void)
{
	struct responses a;
	struct splats wholes[MOST];
	struct seen seen = {0}, whole = {0}, full = {0};
	struct err e = {0};

	if (!CHECK(!responses_lifted(&a, &lifted, &of, CHOOSE_ALL, 0.95, &e) &&
			    !responses_wholes(&a, &splats, &cameras, wholes, &e),
		    "%s", e.message))
		return;
	const struct answer_question visible = {.splats = &splats, .responses = &a},
				     images = {.splats = &splats, .responses = &a, .wants_images = 1},
				     amodal = {.splats = &splats, .responses = &a, .wholes = wholes};
	CHECK(!answer_all(&visible, &camera, 1, &(struct answer_calls){&seen, each, done}, &e), "%s",
		e.message);
	CHECK(!answer_all(&images, &camera, 1, &(struct answer_calls){&full, each, done}, &e), "%s",
		e.message);
	CHECK(!memcmp(&full, &seen, sizeof seen), "masks differ where whole images are wanted");
	CHECK(!answer_all(&amodal, &camera, 1, &(struct answer_calls){&whole, each, done}, &e), "%s",
		e.message);
	const size_t large = a.answer[0], small = a.answer[1], nothing = a.answer[3];
	CHECK(seen.calls == 3 && seen.views == 1 && whole.calls == 3 && whole.views == 1, "%zu calls",
		seen.calls);
	CHECK(isnan(seen.visible[large]), "no outline was asked for");
	CHECK(seen.area[small] > 4 && seen.area[large] > 10, "both are in sight: %zu, %zu pixels",
		seen.area[small], seen.area[large]);
	CHECK(whole.area[large] > seen.area[large] && whole.visible[large] < 0.9 &&
			whole.visible[large] > 0.3,
		"%zu of %zu pixels, %g", seen.area[large], whole.area[large], whole.visible[large]);
	CHECK(whole.visible[small] > 0.95, "%g", whole.visible[small]);
	CHECK(!seen.mask[large][SIDE / 2 * SIDE + SIDE / 2] && whole.mask[large][SIDE / 2 * SIDE + SIDE / 2],
		"the middle is hidden");
	CHECK(!whole.area[nothing] && !seen.area[nothing] && !(whole.visible[nothing] > 0), "nothing");
	for (size_t k = 0; k < a.answers; k++)
		splats_free(&wholes[k]);
	responses_free(&a);
}

/* A trained model of shares blends 2 sigmoid(m) - 1 where one of logits blends m, and is as sure as the mean
 * of sigmoid(m) above 0. */
static void test_shares(void)
{
	static const float features[N * 2] = {1, -2, 3, 1, -1, 4, 2, 2};
	static const int32_t ids[] = {0, 1, 2, 3};
	static const double low[] = {-1, -1, -3}, high[] = {1, 1, 10};
	SCOPED_BY(rows_free) struct rows rows = {0};
	struct refer_layout layout;
	struct responses logits, shares;
	struct rng r;
	struct err e = {0};

	refer_layout_init(&layout, REFER_NONE, 3, 2);
	SCOPED float *parameters = calloc(layout.count, sizeof *parameters);
	if (!parameters || !CHECK(!rows_of_ids(&rows, ids, N, N, &e), "%s", e.message))
		return;
	rng_seed(&r, 1, 0);
	refer_init(&layout, parameters, &r);
	for (size_t k = 0; k < layout.count; k++)
		parameters[k] *= 3;
	struct respond_model m = {
		&layout, REFER_DOT, &rows, REFER_LOGITS, features, parameters, means, low, high};
	if (!CHECK(!responses_trained(&logits, &m, &of, 0, &e), "%s", e.message))
		return;
	m.blend = REFER_SHARES;
	if (CHECK(!responses_trained(&shares, &m, &of, 0, &e), "%s", e.message)) {
		size_t above = 0, all = 0;
		CHECK(!logits.sure && shares.sure && shares.answers == SENTENCES, "who says how sure");
		for (size_t k = 0; k < SENTENCES; k++) {
			double sum = 0, n = 0;
			for (size_t i = 0; i < N; i++) {
				const double own = (double)at(&logits, k, i), p = 1 / (1 + exp(-own));
				CHECK(fabs((double)at(&shares, k, i) - (2 * p - 1)) < 1e-6,
					"sentence %zu, Gaussian %zu", k, i);
				sum += own > 0 ? p : 0;
				n += own > 0;
			}
			CHECK(fabs(shares.sure[k] - (n > 0 ? sum / n : 0)) < 1e-12, "sentence %zu: %g", k,
				shares.sure[k]);
			above += (size_t)n;
			all += N;
		}
		CHECK(above && above < all, "some are above 0: %zu", above);
		responses_free(&shares);
	}
	responses_free(&logits);
}

int main(void)
{
	test_shares();
	test_sharing();
	test_wholes();
	test_outlines();
	return unit_end();
}
