/* Candidate masks pooled: those of one object in one view, in whatever order they came. */
#pragma once

#include "base/err.h"
#include "mask/mask_index.h"
#include "mask/select.h"

/* The candidates of one object in one view; those without an object are pooled by their ref. */
struct pool_group {
	size_t first;	 /* the candidate that came first */
	size_t object;	 /* the first candidate of its object, in any view */
	size_t begin, n; /* in the index */
	/* of pool_select */
	long winner; /* a candidate, or -1 */
	double vote;
};

struct pool {
	size_t n;
	const struct mask *candidates; /* (n) the caller's, in their order */
	struct mask_index index;       /* by view and object */
	size_t group_count;
	struct pool_group *groups; /* in the order of their first candidates */
};

/* The candidates are referred to. */
int pool_make(struct pool *p, const struct mask *candidates, size_t n, struct err *e);
void pool_free(struct pool *p);

/* Masks of one view are compared pixel by pixel: 0 where they have one size, else -1, with *bad the first
 * candidate that differs from its view's first, *first. */
int pool_check_sizes(const struct pool *p, size_t *bad, size_t *first);

/* Each group's winner by select_winner, and its vote. Once for a pool. */
int pool_select(struct pool *p, enum select_method method, double min_score, struct err *e);
