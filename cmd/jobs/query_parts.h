/* The two kinds of rules of cmd/jobs/feature_query: by the cosines of vectors of texts, and by examples of
 * what is meant. */
#ifndef CMD_JOBS_QUERY_PARTS_H
#define CMD_JOBS_QUERY_PARTS_H

#include "cmd/jobs/feature_query.h"

/* Each reads what else its rules need, and fills q->marks. Returns 0, or -1 with *e set. */
int query_by_vectors(struct feature_query *q, struct err *e);
int query_by_examples(struct feature_query *q, const struct report *to, struct err *e);

#endif
