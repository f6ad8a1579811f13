/* Tables of scores: a row for all pairs, for each object and for each of other groups, with intervals, and
 * beside the figures of another prediction of the same truth. */
#pragma once

#include "score/bootstrap.h"
#include "score/score.h"

/* With at least this many objects in a row whole objects are drawn: the masks of one object, in its views and
 * by its sentences, succeed or fail together, and drawn singly would make the interval too narrow. With fewer
 * objects, pairs are. */
enum { SCORE_LEAST_OBJECTS = 5 };

enum score_unit { SCORE_UNIT_NONE, SCORE_UNIT_OBJECTS, SCORE_UNIT_PAIRS };
extern const char *const score_unit_name[]; /* "", "objects", "pairs" */

/* Another prediction of the same pairs. */
struct score_compared {
	struct score score;
	struct interval miou, oiou;
	double difference;	     /* mean of the pairs' IoU less the other's */
	size_t better, worse, equal; /* pairs by the sign of that */
	struct interval range;	     /* of the difference */
	double p;		     /* bootstrap_sign_test of the units' differences */
};

struct score_row {
	const char *name;
	struct score score;
	enum score_unit unit; /* that was drawn; NONE: no intervals and no p, as not asked for or only one */
	size_t units;
	struct interval miou, oiou;
	struct score_compared other; /* all 0 where nothing is compared */
};

struct score_table {
	size_t n, capacity;
	struct score_row *rows; /* owned; the names are others' */
};

/* Measured pairs after score_sort. Where two predictions are compared `other` is score_join's. */
struct score_sample {
	size_t n;
	const struct score_pair *pairs;
	const struct score_pair *other; /* NULL: nothing is compared */
	const struct bootstrap *how;	/* NULL: no intervals */
};

/* The figures of a sample. */
int score_row_make(struct score_row *row, const char *name, const struct score_sample *s, struct err *e);

/* A row for each object, by name. Release with score_table_free. */
int score_table_objects(struct score_table *t, const struct score_sample *s, struct err *e);

/* A row for each of `names` (at most 32), of the pairs whose set (n) has the bit 1 << its index. Rows that no
 * set has are left out, but for those whose bit `always` has. */
int score_table_groups(struct score_table *t, const struct score_sample *s, const uint32_t *sets,
	const char *const *names, size_t count, uint32_t always, struct err *e);

void score_table_free(struct score_table *t);
