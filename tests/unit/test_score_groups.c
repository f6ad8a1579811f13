#include "mask_help.h"
#include "score/score_groups.h"
#include "score/score.h"
#include "score/score_rows.h"
#include "unit.h"

/* A row of n pixels, of which the first `ones` are foreground. */
static struct rle row(int n, int ones)
{
	uint8_t pixels[64];

	for (int i = 0; i < n; i++)
		pixels[i] = i < ones;
	return mask_rle(pixels, 1, n);
}

enum { MASKS = 9 };
static struct rle mask[MASKS]; /* mask[i] has i of 8 pixels */

static void join(struct score_pairs *a, struct score_pairs *b, const struct mask *truth, size_t n,
	const struct mask *own, size_t own_n, const struct mask *other, size_t other_n)
{
	struct err e;

	if (score_match(a, truth, n, own, own_n, &e) || score_match(b, truth, n, other, other_n, &e) ||
		score_join(a, b, &e) || score_measure_all(a, &e) || score_measure_all(b, &e))
		abort();
	CHECK(a->n == b->n, "%zu %zu", a->n, b->n);
	for (size_t i = 0; i < a->n; i++)
		CHECK(a->items[i].truth == b->items[i].truth && a->items[i].place == b->items[i].place &&
				!strcmp(a->items[i].object, b->items[i].object),
			"pair %zu", i);
}

/* The masks of either side, in order: "4/2 -/3" where 4 stands beside 2, and nothing beside 3. */
static const char *shown(char text[64], const struct score_pairs *a, const struct score_pairs *b)
{
	*text = 0;
	for (size_t i = 0; i < a->n; i++) {
		const struct mask *sides[2] = {a->items[i].prediction, b->items[i].prediction};
		char *end = text + strlen(text);
		for (int s = 0; s < 2; s++)
			*end++ = sides[s] ? (char)('0' + rle_area(&sides[s]->rle)) : '-';
		*end = 0;
		strcat(text, " ");
	}
	return text;
}

static void test_join(void)
{
	const struct mask truth[] = {{"v", NULL, "pan", mask[8], 1, NAN, NULL},
		{"v", NULL, "cup", mask[4], 1, NAN, NULL}, {"w", "r1", "cup", mask[3], 1, NAN, NULL}};
	const struct mask both[] = {{"v", "r2", "cup", mask[2], 1, NAN, NULL},
		{"v", "r1", "cup", mask[1], 1, NAN, NULL}, {"w", "r1", "cup", mask[5], 1, NAN, NULL}};
	const struct mask later[] = {
		{"v", "r3", "cup", mask[7], 1, NAN, NULL}, {"v", "r2", "cup", mask[6], 1, NAN, NULL}};
	const struct mask bare[] = {
		{"v", NULL, "cup", mask[3], 1, NAN, NULL}, {"w", NULL, "cup", mask[2], 1, NAN, NULL}};
	const struct mask mixed[] = {
		{"v", NULL, "cup", mask[3], 1, NAN, NULL}, {"v", "r1", "cup", mask[4], 1, NAN, NULL}};
	struct score_pairs a, b;
	char text[64];

	join(&a, &b, truth, 3, both, 3, both, 3);
	CHECK(!strcmp(shown(text, &a, &b), "22 11 55 -- "), "the same: %s", text);
	score_pairs_free(&a);
	score_pairs_free(&b);

	join(&a, &b, truth, 3, both, 3, later, 2);
	CHECK(!strcmp(shown(text, &a, &b), "26 1- 5- -- -7 "), "what one side lacks: %s", text);
	CHECK(!strcmp(a.items[4].ref, "r3") && a.items[4].iou == 0, "is missing there");
	score_pairs_free(&a);
	score_pairs_free(&b);

	join(&a, &b, truth, 3, both, 3, bare, 2);
	CHECK(!strcmp(shown(text, &a, &b), "23 13 52 -- "), "a mask without ref serves all: %s", text);
	score_pairs_free(&a);
	score_pairs_free(&b);

	join(&a, &b, truth, 3, bare, 2, both, 3);
	CHECK(!strcmp(shown(text, &a, &b), "-- 32 31 25 "), "on either side: %s", text);
	score_pairs_free(&a);
	score_pairs_free(&b);

	join(&a, &b, truth, 3, mixed, 2, mixed, 2);
	CHECK(!strcmp(shown(text, &a, &b), "44 33 -- -- "), "both kinds on both sides: %s", text);
	score_pairs_free(&a);
	score_pairs_free(&b);

	join(&a, &b, truth, 3, mixed, 2, later, 2);
	CHECK(!strcmp(shown(text, &a, &b), "4- -- -- 37 36 "), "own before the mask without ref: %s", text);
	score_pairs_free(&a);
	score_pairs_free(&b);

	join(&a, &b, truth, 3, NULL, 0, both, 1);
	CHECK(!strcmp(shown(text, &a, &b), "-- -- -2 "), "nothing on one side: %s", text);
	score_pairs_free(&a);
	score_pairs_free(&b);

	const struct mask nameless = {"v", "r1", NULL, mask[8], 1, NAN, NULL};
	join(&a, &b, &nameless, 1, NULL, 0, both, 3);
	CHECK(!strcmp(a.items[0].object, "cup"), "the only prediction's: %s", a.items[0].object);
	score_pairs_free(&a);
	score_pairs_free(&b);

	join(&a, &b, truth, 0, both, 3, both, 3);
	CHECK(a.n == 0, "no truth");
	score_pairs_free(&a);
	score_pairs_free(&b);
}

static void test_compare(void)
{
	const struct bootstrap how = {2000, 0.95, 1};
	const struct mask truth[] = {{"v", NULL, "a", mask[4], 1, NAN, NULL},
		{"v", NULL, "b", mask[4], 1, NAN, NULL}, {"v", NULL, "c", mask[4], 1, NAN, NULL},
		{"v", NULL, "d", mask[0], 1, NAN, NULL}};
	const struct mask own[] = {{"v", NULL, "a", mask[4], 1, NAN, NULL},
		{"v", NULL, "b", mask[2], 1, NAN, NULL}, {"v", NULL, "c", mask[2], 1, NAN, NULL},
		{"v", NULL, "d", mask[1], 1, NAN, NULL}};
	const struct mask other[] = {{"v", NULL, "a", mask[2], 1, NAN, NULL},
		{"v", NULL, "b", mask[3], 1, NAN, NULL}, {"v", NULL, "c", mask[2], 1, NAN, NULL},
		{"v", NULL, "d", mask[0], 1, NAN, NULL}};
	struct score_pairs a, b;
	struct score_row r = {0};
	struct err e;

	join(&a, &b, truth, 4, own, 4, other, 4);
	struct score_sample s = {a.n, a.items, b.items, &how};
	CHECK(!score_row_make(&r, "", &s, &e), "runs");
	CHECK(r.score.pairs == 3 && r.score.empty_truth == 1, "%zu", r.score.pairs);
	CHECK(fabs(r.other.difference - 0.25 / 3) < 1e-15, "%g", r.other.difference);
	CHECK(r.other.better == 1 && r.other.worse == 1 && r.other.equal == 1, "1, -1/4 and 0");
	CHECK(fabs(r.other.score.miou - 1.75 / 3) < 1e-15, "%g", r.other.score.miou);
	CHECK(r.other.p == 1, "two that differ: every pattern is as far, but for rounding: %g", r.other.p);
	CHECK(r.unit == SCORE_UNIT_PAIRS && r.units == 3, "three objects are few");
	CHECK(r.other.range.low == -0.25 && r.other.range.high == 0.5, "%g %g", r.other.range.low,
		r.other.range.high);
	s.how = NULL;
	CHECK(!score_row_make(&r, "", &s, &e) && r.unit == SCORE_UNIT_NONE && r.other.p == 0, "no resamples");

	s = (struct score_sample){a.n, a.items, a.items, &how};
	CHECK(!score_row_make(&r, "", &s, &e) && r.other.difference == 0 && r.other.p == 1 &&
			r.other.range.low == 0 && r.other.range.high == 0 && r.other.equal == 3,
		"identical");
	s.n = 1;
	CHECK(!score_row_make(&r, "", &s, &e) && r.unit == SCORE_UNIT_NONE, "one pair has no interval");
	score_pairs_free(&a);
	score_pairs_free(&b);
}

/* Five objects with something in their truth are enough, four and an empty one are not. */
static void test_units(void)
{
	const struct bootstrap how = {50, 0.95, 1};
	struct score_pair pairs[6];
	struct score_row r = {0};
	struct err e;

	for (int i = 0; i < 6; i++) {
		static const char *const names[6] = {"a", "a", "b", "c", "d", "e"};
		pairs[i] =
			(struct score_pair){.object = names[i], .iou = 0.5, .either = 2, .intersection = 1};
	}
	const struct score_sample s = {6, pairs, NULL, &how};
	CHECK(!score_row_make(&r, "", &s, &e) && r.unit == SCORE_UNIT_OBJECTS && r.units == 5, "%zu",
		r.units);
	CHECK(r.miou.low == 0.5 && r.oiou.high == 0.5, "%g %g", r.miou.low, r.oiou.high);
	pairs[5].is_empty = 1;
	CHECK(!score_row_make(&r, "", &s, &e) && r.unit == SCORE_UNIT_PAIRS && r.units == 5, "%zu", r.units);
}

static void test_tables(void)
{
	static const char *const names[3] = {"x", "y", "z"};
	const uint32_t sets[4] = {1, 3, 0, 2};
	struct score_pair pairs[4];
	struct score_table t = {0};
	struct err e;

	for (int i = 0; i < 4; i++)
		pairs[i] = (struct score_pair){.object = i < 3 ? "a" : "b", .iou = i / 4.0, .either = 1};
	const struct score_sample s = {4, pairs, NULL, NULL};
	CHECK(!score_table_objects(&t, &s, &e) && t.n == 2, "%zu", t.n);
	CHECK(t.rows[0].score.pairs == 3 && t.rows[0].score.miou == 0.25 && t.rows[1].score.miou == 0.75,
		"objects");
	score_table_free(&t);
	CHECK(!score_table_groups(&t, &s, sets, names, 3, 0, &e) && t.n == 2, "%zu", t.n);
	CHECK(!strcmp(t.rows[1].name, "y") && t.rows[0].score.miou == 0.125 && t.rows[1].score.miou == 0.5,
		"a pair may be in both");
	score_table_free(&t);
	CHECK(!score_table_groups(&t, &s, sets, names, 3, 4, &e) && t.n == 3 && !t.rows[2].score.pairs,
		"z always");
	score_table_free(&t);
}

static void test_sayings(void)
{
	const struct score_sentence sentences[] = {
		{"r3", 0}, {"r1", 1u << PARSE_LEFT}, {"r2", 1u << PARSE_BETWEEN | 1u << PARSE_ON}};
	const struct mask bare = {.object = "o"}, truth_2 = {.ref = "r2"}, truth_3 = {.ref = "r3"};
	const struct score_pair pairs[] = {{.ref = "r1", .truth = &truth_3}, {.truth = &truth_2},
		{.ref = "r3", .truth = &bare}, {.ref = "r4", .truth = &bare}, {.truth = &bare},
		{.ref = "r5", .truth = &bare, .is_empty = 1}};
	uint32_t sets[6];
	const char *names[SCORE_SAYINGS];
	size_t unknown = 0;
	struct err e;

	CHECK(!score_sayings(sets, pairs, 6, sentences, 3, &unknown, &e) && unknown == 2, "%zu", unknown);
	CHECK(sets[0] == 1u << PARSE_LEFT, "the prediction's ref before the truth's");
	CHECK(sets[1] == (1u << PARSE_BETWEEN | 1u << PARSE_ON), "the truth's");
	CHECK(sets[2] == 1u << SCORE_SAYS_NONE, "no relation");
	CHECK(sets[3] == 1u << SCORE_SAYS_UNKNOWN && sets[4] == sets[3], "no sentence");
	CHECK(sets[5] == 0, "nothing in its truth");
	score_saying_names(names);
	CHECK(!strcmp(names[PARSE_NEAR], "near") && !strcmp(names[SCORE_SAYS_UNKNOWN], "(unknown)"), "names");
}

static void test_seen(void)
{
	struct rle whole = row(20, 20), half = row(10, 10), truths[8];
	static const int ones[8] = {2, 3, 9, 10, 16, 17, 20, 0};
	static const int expected[8] = {SCORE_SEEN_LITTLE, SCORE_SEEN_PARTLY, SCORE_SEEN_PARTLY,
		SCORE_SEEN_MOSTLY, SCORE_SEEN_MOSTLY, SCORE_SEEN_WELL, SCORE_SEEN_WELL, -1};
	static const char *const views[8] = {"0", "1", "2", "3", "4", "5", "6", "7"};
	struct mask truth[8], wholes[8];
	struct score_pair pairs[8];
	uint32_t sets[8];
	size_t unknown = 0;
	struct err e;

	for (size_t i = 0; i < 8; i++) {
		truths[i] = row(20, ones[i]);
		truth[i] = (struct mask){views[i], NULL, "o", truths[i], 1, NAN, NULL};
		wholes[i] = (struct mask){views[i], NULL, "o", i % 2 ? whole : half, 1, NAN, NULL};
		pairs[i] = (struct score_pair){.truth_index = i, .truth = &truth[i]};
	}
	CHECK(!score_seen(sets, pairs, 8, truth, 8, wholes, 8, &unknown, &e) && !unknown, "%zu", unknown);
	for (int i = 0; i < 8; i++)
		CHECK(sets[i] == (expected[i] < 0 ? 0 : 1u << expected[i]), "%d of 20: %x", ones[i],
			(unsigned)sets[i]);

	/* three wholes are gone, of which one is of an empty truth; one has nothing in it; one is too small
	 */
	const struct mask few[] = {{"0", "r", "o", whole, 1, NAN, NULL},
		{"3", NULL, "o", mask[0], 1, NAN, NULL}, {"4", NULL, "o", truths[0], 1, NAN, NULL},
		{"5", "r", "o", truths[3], 1, NAN, NULL}, {"5", NULL, "o", whole, 1, NAN, NULL},
		{"6", NULL, "p", whole, 1, NAN, NULL}};
	truth[5].ref = "r";
	CHECK(!score_seen(sets, pairs, 8, truth, 8, few, 6, &unknown, &e) && unknown == 4, "%zu", unknown);
	CHECK(sets[0] == 1u << SCORE_SEEN_LITTLE, "one with a ref serves where there is none without");
	CHECK(sets[1] == 1u << SCORE_SEEN_UNKNOWN && sets[3] == sets[1] && sets[6] == sets[1], "unknown");
	CHECK(sets[4] == 1u << SCORE_SEEN_WELL, "beyond the whole");
	CHECK(sets[5] == 1u << SCORE_SEEN_WELL, "its ref's comes first");
	for (int i = 0; i < 8; i++)
		rle_free(&truths[i]);
	rle_free(&whole);
	rle_free(&half);
}

static void test_views(void)
{
	struct mask truth[] = {{"u", NULL, "1", {0}, 1, NAN, NULL}, {"v", NULL, "2", {0}, 1, NAN, NULL},
		{"u", NULL, "3", {0}, 1, NAN, NULL}, {"w", NULL, "4", {0}, 1, NAN, NULL}};
	const struct mask own[] = {{"w", NULL, "x", {0}, 1, NAN, NULL}},
			  other[] = {{"u", NULL, "x", {0}, 1, NAN, NULL}};
	size_t n = 4;
	struct err e;

	CHECK(!score_keep_views(truth, &n, own, 1, other, 1, &e) && n == 3, "%zu", n);
	CHECK(*truth[0].object == '1' && *truth[1].object == '3' && *truth[2].object == '4', "in order");
	CHECK(!score_keep_views(truth, &n, own, 1, NULL, 0, &e) && n == 1 && *truth[0].object == '4', "%zu",
		n);
}

int main(void)
{
	for (int i = 0; i < MASKS; i++)
		mask[i] = row(8, i);
	test_join();
	test_compare();
	test_units();
	test_tables();
	test_sayings();
	test_seen();
	test_views();
	for (int i = 0; i < MASKS; i++)
		rle_free(&mask[i]);
	return unit_end();
}
