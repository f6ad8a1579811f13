/* The two kinds of rules of cmd/feature/feature_query: by the cosines of vectors of texts, and by examples of
 * what is meant. */
#ifndef CMD_FEATURE_QUERY_PARTS_H
#define CMD_FEATURE_QUERY_PARTS_H

#include "cmd/feature/feature_query.h"

#include <stdio.h>

/* Each reads what else its rules need, and fills q->marks. Returns 0, or -1 with *e set. */
int query_by_vectors(struct feature_query *q, struct err *e);
int query_by_examples(struct feature_query *q, const struct report *to, struct err *e);

/* q->vectors and q->group of the rules by vectors. Returns 0, or -1 with *e set. */
int query_read_vectors(struct feature_query *q, struct err *e);

/* The same by vectors for the pixels of rendered features: q->shown. */
int query_by_pixels(struct feature_query *q, const struct report *to, struct err *e);
/* Mask records of q (a struct feature_query), view after view. */
int query_put_masks(FILE *out, const void *q, struct err *e);

#endif
