/* Answers against a twin on plain pixels, and what must not change them. */
#include "unit.h"

#include "base/rng.h"
#include "mask_help.h"
#include "score/score_answers.h"

enum { VIEWS = 3, OBJECTS = 4, SENTENCES = 12, H = 13, W = 17, P = H * W };

static char *const object_names[OBJECTS] = {"cup", "\xe7\x93\xb6", "plate", "Schl\xc3\xbcssel"};
static const char *const view_names[VIEWS] = {"v2", "v10", "v1"};

/* Everything is plain here; records point into it. */
struct world {
	uint8_t truth[VIEWS][OBJECTS][P], said[VIEWS][SENTENCES][P];
	struct rle truth_rle[VIEWS][OBJECTS], said_rle[VIEWS][SENTENCES];
	char refs[SENTENCES][8];
	char *meant[SENTENCES][OBJECTS];
	struct answer_sentence sentences[SENTENCES];
	struct mask truths[VIEWS * OBJECTS], predictions[VIEWS * SENTENCES];
	size_t truth_n, prediction_n;
};

static void world_make(struct world *w, uint64_t seed)
{
	struct rng r;

	rng_seed(&r, seed, 1);
	w->truth_n = w->prediction_n = 0;
	for (int s = 0; s < SENTENCES; s++) {
		snprintf(w->refs[s], sizeof w->refs[s], "r%d", s);
		w->sentences[s] = (struct answer_sentence){.ref = w->refs[s],
			.kind = s % 3 ? "a" : NULL,
			.view = s % 5 == 4 ? view_names[s % VIEWS] : NULL,
			.objects = w->meant[s]};
		for (int o = 0; o < OBJECTS; o++)
			if (rng_below(&r, 3) == 0)
				w->meant[s][w->sentences[s].object_count++] = object_names[o];
	}
	for (int v = 0; v < VIEWS; v++) {
		for (int o = 0; o < OBJECTS; o++) {
			uint8_t *m = mask_random(&r, H, W, rng_below(&r, 4) ? 1 : 2);
			memcpy(w->truth[v][o], m, P);
			free(m);
			w->truth_rle[v][o] = mask_rle(w->truth[v][o], H, W);
			w->truths[w->truth_n++] = (struct mask){
				view_names[v], NULL, object_names[o], w->truth_rle[v][o], 1, NAN, NULL};
		}
		for (int s = 0; s < SENTENCES; s++) {
			uint8_t *m = mask_random(&r, H, W, rng_below(&r, 3) ? 1 : 2);
			/* Often an object's own mask, or two. */
			for (int k = 0; k < 2; k++)
				for (int p = 0, o = (int)rng_below(&r, OBJECTS + 2); p < P && o < OBJECTS;
					p++)
					m[p] = (uint8_t)(k ? m[p] | w->truth[v][o][p] : w->truth[v][o][p]);
			memcpy(w->said[v][s], m, P);
			free(m);
			w->said_rle[v][s] = mask_rle(w->said[v][s], H, W);
			if (rng_below(&r, 8))
				w->predictions[w->prediction_n++] = (struct mask){
					view_names[v], w->refs[s], NULL, w->said_rle[v][s], 1, NAN, NULL};
		}
	}
}

static void world_free(struct world *w)
{
	for (int v = 0; v < VIEWS; v++) {
		for (int o = 0; o < OBJECTS; o++)
			rle_free(&w->truth_rle[v][o]);
		for (int s = 0; s < SENTENCES; s++)
			rle_free(&w->said_rle[v][s]);
	}
}

static double iou(const uint8_t *a, const uint8_t *b)
{
	int both = 0, either = 0;

	for (int p = 0; p < P; p++) {
		both += a[p] && b[p];
		either += a[p] || b[p];
	}
	return either ? (double)both / either : 0;
}

static double covered(const uint8_t *object, const uint8_t *by)
{
	int both = 0, area = 0;

	for (int p = 0; p < P; p++) {
		both += object[p] && by[p];
		area += object[p] != 0;
	}
	return (double)both / area;
}

static int is_blank(const uint8_t *m)
{
	for (int p = 0; p < P; p++)
		if (m[p])
			return 0;
	return 1;
}

static int is_meant(const struct answer_sentence *s, const char *object)
{
	for (size_t i = 0; i < s->object_count; i++)
		if (!strcmp(s->objects[i], object))
			return 1;
	return 0;
}

static void check_one(const struct world *w, const struct answer *a)
{
	int s = (int)(a->sentence - w->sentences), v = 0, shown = 0, hit = 0, meant = 0;
	uint8_t all[P] = {0};
	double own = 0, other = 0;

	while (strcmp(view_names[v], a->view))
		v++;
	const uint8_t *said = w->said[v][s];
	for (int o = 0; o < OBJECTS; o++) {
		int of = is_meant(a->sentence, object_names[o]);
		if (is_blank(w->truth[v][o]))
			continue;
		int covers = covered(w->truth[v][o], said) > 0.5;
		double one = iou(said, w->truth[v][o]);
		shown += covers;
		hit += covers && of;
		meant += of;
		if (of)
			own = fmax(own, one);
		else
			other = fmax(other, one);
		for (int p = 0; p < P && of; p++)
			all[p] |= w->truth[v][o][p];
	}
	int both = 0, either = 0;
	for (int p = 0; p < P; p++) {
		both += !a->is_missing && said[p] && all[p];
		either += (!a->is_missing && said[p]) || all[p];
	}
	CHECK((int)a->intersection == both && (int)a->either == either, "sentence %d, view %d: %d of %d", s,
		v, both, either);
	if (a->is_missing) {
		CHECK(!a->is_refused && !a->is_right && a->iou <= 0 && a->f1[0] <= 0 && a->f1[1] <= 0,
			"what is missing is wrong");
		return;
	}
	int none = !a->sentence->object_count, blank = is_blank(said);
	double f1 = none ? blank : 2.0 * hit / (shown + meant);
	int right = none			     ? blank
		    : a->sentence->object_count == 1 ? own > 0 && own >= other
						     : hit == meant && shown == meant;
	CHECK(a->is_refused == blank, "sentence %d, view %d: refused", s, v);
	CHECK(fabs(a->f1[1] - f1) < 1e-12, "sentence %d, view %d: %g, not %g", s, v, a->f1[1], f1);
	CHECK(fabs(a->iou - (none ? blank : iou(said, all))) < 1e-12, "sentence %d, view %d: %g", s, v,
		a->iou);
	CHECK(a->is_right == right, "sentence %d, view %d: right %d", s, v, right);
}

/* The figures of GRES, from the answers one by one. */
static void check_totals(
	const struct answers *a, const struct answer_score *all, const struct answer_score *none)
{
	double both = 0, either = 0, answered = 0, targets = 0, n_acc, t_acc;

	for (size_t i = 0; i < a->n; i++) {
		const struct answer *one = &a->items[i];
		both += (double)one->intersection;
		either += (double)one->either;
		targets += one->sentence->object_count > 0;
		answered += one->sentence->object_count > 0 && !one->is_refused && !one->is_missing;
	}
	answer_target_accuracy(&n_acc, &t_acc, a);
	CHECK(fabs(all->oiou - both / either) < 1e-12, "%g of %g", both, either);
	CHECK(fabs(t_acc - answered / targets) < 1e-12, "T-acc %g", t_acc);
	CHECK(none->pairs ? fabs(n_acc - none->refused) < 1e-12 : isnan(n_acc), "N-acc %g", n_acc);
}

static void against_pixels(const struct world *w)
{
	struct answers a;
	struct err e;
	size_t missing = 0;

	if (!CHECK(!answers_make(&a, w->sentences, SENTENCES, w->truths, w->truth_n, w->predictions,
			   w->prediction_n, &e),
		    "%s", e.message))
		return;
	CHECK(!a.unknown && !a.unmatched, "%zu, %zu", a.unknown, a.unmatched);
	for (size_t i = 0; i < a.n; i++) {
		check_one(w, &a.items[i]);
		missing += (size_t)a.items[i].is_missing;
	}
	size_t asked = 0;
	for (int s = 0; s < SENTENCES; s++)
		asked += w->sentences[s].view ? 1 : VIEWS;
	CHECK(a.n + a.out_of_sight == asked, "%zu of %zu", a.n, asked);
	struct answer_score all, parts[3];
	answer_score_sum(&all, &a, ANSWER_ANY, NULL);
	CHECK(all.missing == missing && all.pairs == a.n, "%zu missing", all.missing);
	for (int k = 0; k < 3; k++)
		answer_score_sum(&parts[k], &a, (enum answer_targets)(ANSWER_ONE + k), NULL);
	CHECK(parts[0].pairs + parts[1].pairs + parts[2].pairs == a.n, "targets do not sum");
	check_totals(&a, &all, &parts[2]);
	answer_score_sum(&parts[0], &a, ANSWER_ANY, "a");
	answer_score_sum(&parts[1], &a, ANSWER_ANY, "");
	CHECK(parts[0].pairs + parts[1].pairs == a.n, "kinds do not sum");
	answers_free(&a);
}

/* What is meant of a sentence in a view: its union; 0 where nothing of it is seen. */
static int meant_in(const struct world *w, int s, int v, uint8_t all[P])
{
	memset(all, 0, P);
	for (int o = 0; o < OBJECTS; o++)
		for (int p = 0; p < P && is_meant(&w->sentences[s], object_names[o]); p++)
			all[p] |= w->truth[v][o][p];
	return !is_blank(all);
}

static int is_said(const struct world *w, int s, int v)
{
	for (size_t i = 0; i < w->prediction_n; i++)
		if (!strcmp(w->predictions[i].ref, w->refs[s]) &&
			!strcmp(w->predictions[i].view, view_names[v]))
			return !is_blank(w->said[v][s]);
	return 0;
}

/* Of a sentence that means something from 0 or 1 to 1 or 2, view v being of the time v. Adds to sum. */
static int time_twin(const struct world *w, int s, const double when[2], double sum[3])
{
	double views = 0, hits = 0, both = 0, either = 0, overlap = 0;
	int inside = 0;
	uint8_t all[P];

	for (int v = 0; v < VIEWS; v++) {
		const int is_now = v >= when[0] && v <= when[1], said = is_said(w, s, v);
		if ((w->sentences[s].view && strcmp(w->sentences[s].view, view_names[v])) ||
			!meant_in(w, s, v, all))
			continue;
		views++;
		inside += is_now;
		hits += said == is_now;
		both += said && is_now;
		either += said || is_now;
		overlap += said && is_now ? iou(w->said[v][s], all) : 0;
	}
	if (!inside)
		return 0;
	sum[0] += hits / views;
	sum[1] += overlap / either;
	sum[2] += both / either;
	return 1;
}

static void times_against_pixels(const struct world *w, uint64_t seed)
{
	struct mask_place when[VIEWS];
	struct mask truths[VIEWS * OBJECTS];
	struct answer_sentence sentences[SENTENCES];
	double times[SENTENCES][2], sum[3] = {0};
	struct answers a;
	struct answer_score all;
	struct err e;
	struct rng r;
	size_t n = 0, outside = 0;

	rng_seed(&r, seed, 2);
	for (size_t i = 0; i < w->truth_n; i++) {
		const int v = (int)i / OBJECTS;
		when[v] = (struct mask_place){.has_time = 1, .time = v};
		truths[i] = w->truths[i];
		truths[i].place = &when[v];
	}
	for (int s = 0; s < SENTENCES; s++) {
		sentences[s] = w->sentences[s];
		times[s][0] = rng_below(&r, 2);
		times[s][1] = 1 + rng_below(&r, 2);
		sentences[s].when = s % 4 ? times[s] : NULL;
		if (s % 4 && sentences[s].object_count)
			n += (size_t)time_twin(w, s, times[s], sum);
	}
	if (!CHECK(!answers_make(
			   &a, sentences, SENTENCES, truths, w->truth_n, w->predictions, w->prediction_n, &e),
		    "%s", e.message))
		return;
	answer_score_sum(&all, &a, ANSWER_ANY, NULL);
	for (size_t i = 0; i < a.n; i++)
		outside += (size_t)a.items[i].is_outside;
	CHECK(all.timed == n && all.pairs == a.n - outside, "%zu timed, not %zu", all.timed, n);
	CHECK(fabs(all.accuracy * (double)n - sum[0]) < 1e-12, "accuracy %g", all.accuracy);
	CHECK(fabs(all.viou * (double)n - sum[1]) < 1e-12, "vIoU %g", all.viou);
	CHECK(fabs(all.tiou * (double)n - sum[2]) < 1e-12, "tIoU %g", all.tiou);
	answers_free(&a);
}

/* Records in another order: the same answers. */
static void order_does_not_matter(const struct world *w)
{
	struct mask truths[VIEWS * OBJECTS], predictions[VIEWS * SENTENCES];
	struct answers a, b;
	struct err e;

	for (size_t i = 0; i < w->truth_n; i++)
		truths[i] = w->truths[w->truth_n - 1 - i];
	for (size_t i = 0; i < w->prediction_n; i++)
		predictions[i] = w->predictions[w->prediction_n - 1 - i];
	if (!CHECK(!answers_make(&a, w->sentences, SENTENCES, w->truths, w->truth_n, w->predictions,
			   w->prediction_n, &e) &&
			    !answers_make(&b, w->sentences, SENTENCES, truths, w->truth_n, predictions,
				    w->prediction_n, &e),
		    "%s", e.message))
		return;
	CHECK(a.n == b.n, "%zu, %zu", a.n, b.n);
	for (size_t i = 0; i < a.n && i < b.n; i++)
		CHECK(a.items[i].sentence == b.items[i].sentence &&
				!strcmp(a.items[i].view, b.items[i].view) &&
				a.items[i].is_right == b.items[i].is_right &&
				!(a.items[i].iou < b.items[i].iou) && !(a.items[i].iou > b.items[i].iou),
			"answer %zu", i);
	answers_free(&a);
	answers_free(&b);
}

/* Twice as large in each direction: the same figures, of masks that are held against the truth's size. */
static void predictions_of_another_size(void)
{
	uint8_t small[P] = {0}, large[4 * P] = {0};
	char *objects[] = {object_names[0]};
	struct answer_sentence s = {.ref = "r", .object_count = 1, .objects = objects};
	struct answers a;
	struct err e;

	for (int p = 0; p < P / 3; p++)
		small[p] = 1;
	for (int y = 0; y < 2 * H; y++)
		for (int x = 0; x < 2 * W; x++)
			large[y * 2 * W + x] = small[y / 2 * W + x / 2];
	struct rle t = mask_rle(small, H, W), p = mask_rle(large, 2 * H, 2 * W);
	struct mask truth = {"v", NULL, "cup", t, 1, NAN, NULL},
		    prediction = {"v", "r", NULL, p, 1, NAN, NULL};
	if (CHECK(!answers_make(&a, &s, 1, &truth, 1, &prediction, 1, &e), "%s", e.message)) {
		CHECK(a.n == 1 && a.items[0].is_right && a.items[0].iou > 0.999 && a.items[0].f1[1] > 0.999,
			"iou %g", a.items[0].iou);
		answers_free(&a);
	}
	rle_free(&t);
	rle_free(&p);
}

/* A view whose true masks have several sizes: the prediction is held against each at its own. */
static void truths_of_several_sizes(void)
{
	uint8_t small[4] = {1, 0, 0, 0}, large[16] = {0}, huge[64] = {0};
	char *objects[] = {"a", "b"};
	struct answer_sentence s[] = {{.ref = "r", .object_count = 1, .objects = objects},
		{.ref = "r", .object_count = 2, .objects = objects}};
	struct answers a;
	struct err e;

	for (int y = 0; y < 4; y++)
		for (int x = 0; x < 4; x++) {
			large[y * 4 + x] = y < 2 && x < 2;
			huge[y * 8 + x] = 1;
		}
	huge[8 * 4] = 1; /* too little to count at a smaller size */
	const struct mask truth[] = {{"v", NULL, "a", mask_rle(large, 4, 4), 1, NAN, NULL},
		{"v", NULL, "b", mask_rle(small, 2, 2), 1, NAN, NULL},
		{"v", NULL, "c", mask_rle(huge, 8, 8), 1, NAN, NULL}};
	const struct mask prediction = {"v", "r", NULL, mask_rle(huge, 8, 8), 1, NAN, NULL};
	if (CHECK(!answers_make(&a, s, 2, truth, 3, &prediction, 1, &e), "%s", e.message)) {
		/* as c covers the same, the second shows more than is meant */
		CHECK(a.n == 2 && a.items[0].is_right && !a.items[1].is_right, "%zu answers", a.n);
		CHECK(a.items[0].iou == 1 && a.items[1].iou == 1, "%g %g", a.items[0].iou, a.items[1].iou);
		answers_free(&a);
	}
	for (int i = 0; i < 3; i++)
		rle_free(&(struct rle){.runs = truth[i].rle.runs});
	rle_free(&(struct rle){.runs = prediction.rle.runs});
}

static void unknown_and_unmatched(void)
{
	uint8_t pixels[P] = {1};
	char *objects[] = {object_names[0], object_names[1]};
	struct answer_sentence s[2] = {{.ref = "r", .object_count = 2, .objects = objects}, {.ref = "none"}};
	struct rle m = mask_rle(pixels, H, W);
	struct mask truth = {"v", NULL, "cup", m, 1, NAN, NULL};
	struct mask predictions[2] = {
		{"v", "other", NULL, m, 1, NAN, NULL}, {"v", NULL, "cup", m, 1, NAN, NULL}};
	struct answers a;
	struct err e;

	if (CHECK(!answers_make(&a, s, 2, &truth, 1, predictions, 2, &e), "%s", e.message)) {
		CHECK(a.unknown == 1 && a.unmatched == 2, "%zu, %zu", a.unknown, a.unmatched);
		CHECK(a.n == 2 && a.items[0].is_missing && a.items[1].is_missing && !a.items[1].is_right,
			"what is missing is no refusal");
		answers_free(&a);
	}
	rle_free(&m);
}

static void unions(void)
{
	struct rng r;

	rng_seed(&r, 5, 5);
	for (int i = 0; i < 200; i++) {
		uint8_t *a = mask_random(&r, H, W, (int)rng_below(&r, 5)),
			*b = mask_random(&r, H, W, (int)rng_below(&r, 5));
		struct rle p = mask_rle(a, H, W), q = mask_rle(b, H, W), both;
		struct err e;
		uint8_t got[P];
		int wrong = 0;
		if (CHECK(!rle_unite(&both, &p, &q, &e), "%s", e.message)) {
			rle_decode(&both, got);
			for (int k = 0; k < P; k++)
				wrong += got[k] != (a[k] || b[k]);
			for (size_t k = 1; k < both.n; k++)
				wrong += !both.runs[k];
			CHECK(!wrong, "union %d: %d pixels or runs are wrong", i, wrong);
			rle_free(&both);
		}
		rle_free(&p);
		rle_free(&q);
		free(a);
		free(b);
	}
}

int main(void)
{
	static struct world w;

	for (uint64_t seed = 1; seed <= 20; seed++) {
		world_make(&w, seed);
		against_pixels(&w);
		order_does_not_matter(&w);
		times_against_pixels(&w, seed);
		world_free(&w);
	}
	predictions_of_another_size();
	truths_of_several_sizes();
	unknown_and_unmatched();
	unions();
	return unit_end();
}
