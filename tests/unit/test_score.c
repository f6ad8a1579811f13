#include "mask/mask_index.h"
#include "mask_help.h"
#include "score/score.h"
#include "unit.h"

/* A row of 8 pixels, from a string of 0 and 1. */
static struct rle row(const char *text)
{
	uint8_t pixels[8];

	for (int i = 0; i < 8; i++)
		pixels[i] = text[i] == '1';
	return mask_rle(pixels, 1, 8);
}

static void measure(struct score_pairs *p)
{
	struct err e;

	for (size_t i = 0; i < p->n; i++)
		if (score_measure(&p->items[i], &e))
			abort();
}

/* Truth of objects, predictions of sentences: every kind of pair at once. */
static void test_by_hand(void)
{
	struct rle four = row("11110000"), two = row("11000000"), other = row("00001100"),
		   none = row("00000000");
	const struct mask truth[] = {
		{"v1", NULL, "cup", four, 1, NAN, NULL},
		{"v1", NULL, "plate", none, 1, NAN, NULL},
		{"v1", "spoon-1", "spoon", two, 1, NAN, NULL},
		{"v2", NULL, "cup", four, 1, NAN, NULL},
	};
	const struct mask predictions[] = {
		{"v1", "cup-1", "cup", four, 1, NAN, NULL},	/* 4/4 */
		{"v1", "cup-2", "cup", two, 1, NAN, NULL},	/* 2/4 */
		{"v1", "plate-1", "plate", four, 1, NAN, NULL}, /* empty truth */
		{"v1", "spoon-1", NULL, other, 1, NAN, NULL},	/* 0/4 */
		{"v1", "fork-1", "fork", four, 1, NAN, NULL},	/* no such truth */
		{"v9", "cup-1", "cup", four, 1, NAN, NULL},	/* no such view */
	};
	struct score_pairs p;
	struct score s;
	struct err e = {0};

	CHECK(!score_match(&p, truth, 4, predictions, 6, &e), "%s", e.message);
	CHECK(p.n == 5 && p.unmatched == 1 && p.unlabelled == 1, "%zu %zu %zu", p.n, p.unmatched,
		p.unlabelled);
	measure(&p);
	score_sum(&s, p.items, p.n);
	CHECK(s.pairs == 4 && s.empty_truth == 1 && s.missing == 1, "%zu %zu %zu", s.pairs, s.empty_truth,
		s.missing);
	CHECK(s.miou == 1.5 / 4, "%g", s.miou);
	CHECK(s.oiou == (4.0 + 2 + 0 + 0) / (4 + 4 + 4 + 4), "%g", s.oiou);
	CHECK(s.precision[0] == 0.5 && s.precision[1] == 0.5 && s.precision[2] == 0.25, "%g %g %g",
		s.precision[0], s.precision[1], s.precision[2]);
	score_sort(p.items, p.n);
	CHECK(!strcmp(p.items[0].object, "cup") && !strcmp(p.items[2].object, "cup") &&
			!strcmp(p.items[3].object, "plate") && !strcmp(p.items[4].object, "spoon"),
		"sorted by object");
	CHECK(p.items[0].iou == 1 && p.items[1].iou == 0.5 && !p.items[2].prediction,
		"in the order of matching");
	score_sum(&s, p.items, 3);
	CHECK(s.pairs == 3 && s.miou == 0.5, "cup: %zu, %g", s.pairs, s.miou);
	score_sum(&s, p.items + 3, 1);
	CHECK(s.pairs == 0 && s.miou == 0 && s.empty_truth == 1, "plate");
	score_pairs_free(&p);
	rle_free(&four);
	rle_free(&two);
	rle_free(&other);
	rle_free(&none);
}

/* Truth of sentences: a ref finds its own; without one, or with another, the object decides. */
static void test_refs(void)
{
	struct rle a = row("11110000"), b = row("00001111"), c = row("11111111");
	const struct mask truth[] = {
		{"v", "r1", "cup", a, 1, NAN, NULL},
		{"v", "r2", "cup", b, 1, NAN, NULL},
		{"v", NULL, "cup", c, 1, NAN, NULL},
	};
	const struct mask by_ref[] = {{"v", "r2", "cup", b, 1, NAN, NULL},
		{"v", "r7", "cup", c, 1, NAN, NULL}, {"v", NULL, "cup", a, 1, NAN, NULL}};
	struct score_pairs p;
	struct err e = {0};

	CHECK(!score_match(&p, truth, 3, by_ref, 3, &e) && p.n == 4, "%zu", p.n);
	measure(&p);
	CHECK(p.items[0].truth == &truth[1] && p.items[0].iou == 1, "r2 has a truth of its own");
	CHECK(p.items[1].truth == &truth[2] && p.items[1].iou == 1,
		"r7 has not: the object's, the one without ref");
	CHECK(p.items[2].truth == &truth[0] && p.items[2].iou == 1, "without ref: r1, which no ref named");
	CHECK(p.items[3].truth == &truth[2] && p.items[3].iou == 0.5, "without ref: and the object's");
	score_pairs_free(&p);

	/* no truth without ref: the first of the object; the rest are missing */
	CHECK(!score_match(&p, truth, 2, by_ref + 1, 1, &e) && p.n == 2, "%zu", p.n);
	CHECK(p.items[0].truth == &truth[0] && p.items[0].prediction == &by_ref[1] &&
			p.items[1].truth == &truth[1] && !p.items[1].prediction,
		"r7 meets r1's, r2 is missing");
	score_pairs_free(&p);

	/* nothing at all on either side */
	CHECK(!score_match(&p, truth, 3, NULL, 0, &e) && p.n == 3 && !p.items[0].prediction,
		"no predictions");
	score_pairs_free(&p);
	CHECK(!score_match(&p, NULL, 0, by_ref, 3, &e) && p.n == 0 && p.unlabelled == 3, "no truth");
	score_pairs_free(&p);
	rle_free(&a);
	rle_free(&b);
	rle_free(&c);
}

static int twice(const struct mask *m, size_t n, size_t *earlier, size_t *later)
{
	struct mask_index x;
	struct err e;

	if (mask_index_make(&x, m, n, MASK_BY_REF, &e))
		abort();
	const int found = mask_index_twice(&x, earlier, later);
	mask_index_free(&x);
	return found;
}

static void test_duplicates(void)
{
	struct rle a = row("11110000");
	struct mask m[] = {
		{"v", "r1", "cup", a, 1, NAN, NULL},
		{"v", "r2", "cup", a, 1, NAN, NULL},
		{"w", "r1", "cup", a, 1, NAN, NULL},
		{"v", NULL, "cup", a, 1, NAN, NULL},
		{"v", NULL, "pan", a, 1, NAN, NULL},
		{"v", "r2", NULL, a, 1, NAN, NULL},
	};
	size_t earlier = 9, later = 9;

	CHECK(!twice(m, 5, &earlier, &later), "%zu %zu", earlier, later);
	CHECK(twice(m, 6, &earlier, &later) && earlier == 1 && later == 5, "%zu %zu", earlier, later);
	m[4].object = "cup";
	CHECK(twice(m, 6, &earlier, &later) && earlier == 3 && later == 4, "%zu %zu", earlier, later);
	rle_free(&a);
}

/* A prediction of half the size is doubled; one pixel of four is not enough when it is halved. */
static void test_sizes(void)
{
	const uint8_t big[16] = {1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0}, small[4] = {1, 0, 0, 0};
	struct mask truth = {.rle = mask_rle(big, 4, 4)}, prediction = {.rle = mask_rle(small, 2, 2)};
	struct score_pair p = {.object = "o", .truth = &truth, .prediction = &prediction};
	struct err e;

	CHECK(!score_measure(&p, &e) && p.intersection == 4 && p.either == 5 && p.iou == 0.8, "%zu %zu",
		p.intersection, p.either);
	p.truth = &prediction;
	p.prediction = &truth;
	CHECK(!score_measure(&p, &e) && p.intersection == 1 && p.either == 1, "%zu %zu", p.intersection,
		p.either);
	rle_free(&truth.rle);
	rle_free(&prediction.rle);
}

/* Whether a point is in the truth's box and mask. */
static void test_peaks(void)
{
	/* Columns of 3: the foreground is column 1 but for its top, and the top of column 2. */
	uint8_t pixels[3 * 4] = {0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0};
	struct mask truth = {.view = "v", .object = "o", .rle = mask_rle(pixels, 3, 4)}, p = truth;
	struct mask_place point = {.has_peak = 1}, boxes = {0};
	const double far[4] = {3, 0.5, 2.5, 0}, near[4] = {0, 0, 0.5, 9};
	struct score_pair pair = {.prediction = &p, .truth = &truth, .object = "o"};
	struct score s;
	struct err e;

	p.place = &point;
	for (int at = 0; at < 12; at++) {
		point.peak[0] = at % 4;
		point.peak[1] = at / 4;
		CHECK(!score_measure(&pair, &e) && pair.is_in_mask == pixels[at], "%d", at);
		CHECK(pair.is_in_box == (at % 4 == 1 || at % 4 == 2), "box of the mask: %d", at);
	}
	CHECK(!mask_place_add_box(&boxes, far, &e) && !mask_place_add_box(&boxes, near, &e), "%s", e.message);
	truth.place = &boxes;
	for (int at = 0; at < 12; at++) {
		point.peak[0] = at % 4;
		point.peak[1] = at / 4;
		CHECK(!score_measure(&pair, &e) && pair.is_in_box == (at == 3 || at % 4 == 0), "boxes: %d",
			at);
	}
	point.peak[0] = point.peak[1] = 0;
	CHECK(!score_measure(&pair, &e), "%s", e.message);
	score_sum(&s, &pair, 1);
	CHECK(s.peaks == 1 && s.in_box == 1 && s.in_mask == 0, "%zu %g %g", s.peaks, s.in_box, s.in_mask);
	/* At twice the size (1,1) is the four pixels from (2,2). */
	p.rle = (struct rle){0};
	CHECK(!rle_resize(&p.rle, &truth.rle, 6, 8, &e), "%s", e.message);
	for (int at = 0; at < 48; at++) {
		point.peak[0] = at % 8;
		point.peak[1] = at / 8;
		CHECK(!score_measure(&pair, &e) && pair.is_in_mask == pixels[at / 8 / 2 * 4 + at % 8 / 2],
			"%d", at);
	}
	point.has_peak = 0;
	CHECK(!score_measure(&pair, &e) && !pair.is_in_mask && !pair.is_in_box, "no peak");
	rle_free(&p.rle);
	rle_free(&truth.rle);
	free(boxes.boxes);
}

int main(void)
{
	test_peaks();
	test_by_hand();
	test_refs();
	test_duplicates();
	test_sizes();
	return unit_end();
}
