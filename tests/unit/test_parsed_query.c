/* What stands for a sentence in a field that goes by parses: by grammar alone, on vectors that tell which
 * piece they are of. */
#include "tests/unit/default_parser.h"
#include "unit.h"

#include "field/query.h"

enum { PIECES = 16, WIDTH = PIECES, COLUMNS = 2 * WIDTH + QUERY_FLAGS };

/* Piece k has 1 in column k. */
static struct query ask(char *text)
{
	const struct parser grammar = default_parser();
	static float words[PIECES * WIDTH];
	int64_t offsets[2] = {0, 1};
	struct query q;
	struct err e;

	for (const char *c = text; *c; c++)
		offsets[1] += *c == ' ';
	for (int k = 0; k < PIECES; k++)
		words[k * WIDTH + k] = 1;
	const struct query_text from = {1, WIDTH, offsets, words, NULL, (char *[]){text}, (char *[]){text}};
	CHECK(!query_make(&q, &from, &grammar, &e), "%s", e.message);
	return q;
}

/* Row r is the mean of `own` pieces from `first` on and of anchors from `anchor` on, and has these flags, of
 * which there are `flags`. */
static void has_row(const struct query *q, int64_t r, int first, int own, int anchor, int anchors, int flags,
	const int *flag)
{
	const float *row = q->words + r * COLUMNS;
	float expected[COLUMNS] = {0};
	int bad = 0;

	if (!CHECK(r < q->offsets[1], "row %d of %d", (int)r, (int)q->offsets[1]))
		return;
	for (int k = 0; k < own; k++)
		expected[first + k] = 1 / (float)own;
	for (int k = 0; k < anchors; k++)
		expected[WIDTH + anchor + k] = 1 / (float)anchors;
	for (int k = 0; k < flags; k++)
		expected[2 * WIDTH + flag[k]] = 3;
	for (int c = 0; c < COLUMNS; c++)
		if (fabsf(row[c] - expected[c]) > 1e-6f && !bad++)
			CHECK(0, "row %d, column %d: %g, expected %g", (int)r, c, (double)row[c],
				(double)expected[c]);
	CHECK(!bad, "row %d", (int)r);
}

#define HAS_ROW(q, r, first, own, anchor, anchors, ...)                                                      \
	has_row(q, r, first, own, anchor, anchors, sizeof(int[]){__VA_ARGS__} / sizeof(int),                 \
		(int[]){__VA_ARGS__})

static void landmarks_are_apart(void)
{
	struct query q = ask("the red mug left of the small green plate");

	HAS_ROW(&q, 0, 1, 1, 0, 0, QUERY_TARGET);
	HAS_ROW(&q, 1, 2, 1, 0, 0, QUERY_TARGET);
	HAS_ROW(&q, 2, 0, 0, 7, 2, PARSE_LEFT, QUERY_CLAUSE);
	HAS_ROW(&q, 3, 0, 0, 0, 0, PARSE_SMALLER, QUERY_CLAUSE, QUERY_NESTED);
	CHECK(q.offsets[1] == 4, "%d rows", (int)q.offsets[1]);
	query_free(&q);
}

static void denials_and_companions(void)
{
	struct query q = ask("the mug with the blue handle");

	HAS_ROW(&q, 0, 1, 1, 0, 0, QUERY_TARGET);
	HAS_ROW(&q, 1, 4, 1, 0, 0, QUERY_HAS);
	HAS_ROW(&q, 2, 5, 1, 0, 0, QUERY_HAS);
	CHECK(q.offsets[1] == 3, "%d rows", (int)q.offsets[1]);
	query_free(&q);
	q = ask("the mug that is not behind the plate");
	HAS_ROW(&q, 1, 0, 0, 7, 1, PARSE_BEHIND, QUERY_CLAUSE, QUERY_NEGATED);
	query_free(&q);
	q = ask("the mug but not the red one");
	HAS_ROW(&q, 1, 5, 1, 0, 0, QUERY_TARGET, QUERY_NEGATED);
	CHECK(q.offsets[1] == 2, "%d rows", (int)q.offsets[1]);
	query_free(&q);
	q = ask("the mug but not the one behind the plate");
	HAS_ROW(&q, 1, 0, 0, 8, 1, PARSE_BEHIND, QUERY_CLAUSE, QUERY_NEGATED);
	CHECK(q.offsets[1] == 2, "%d rows", (int)q.offsets[1]);
	query_free(&q);
	q = ask("the second mug from the left");
	HAS_ROW(&q, 1, 0, 0, 0, 0, PARSE_LEFT, QUERY_ORDINAL + 1);
	query_free(&q);
}

/* Another wording of a relation is the same query, but for which pieces they are. */
static void wording_is_nothing(void)
{
	struct query a = ask("the mug behind the plate"), b = ask("the mug to the rear of the plate");

	CHECK(a.offsets[1] == 2 && b.offsets[1] == 2, "%d and %d rows", (int)a.offsets[1], (int)b.offsets[1]);
	HAS_ROW(&a, 1, 0, 0, 4, 1, PARSE_BEHIND, QUERY_CLAUSE);
	HAS_ROW(&b, 1, 0, 0, 7, 1, PARSE_BEHIND, QUERY_CLAUSE);
	query_free(&a);
	query_free(&b);
}

static void nothing_is_left_out_of_everything(void)
{
	struct query q = ask("the");

	HAS_ROW(&q, 0, 0, 1, 0, 0, QUERY_RAW);
	CHECK(q.offsets[1] == 1, "%d rows", (int)q.offsets[1]);
	query_free(&q);
}

int main(void)
{
	landmarks_are_apart();
	denials_and_companions();
	wording_is_nothing();
	nothing_is_left_out_of_everything();
	return unit_end();
}
