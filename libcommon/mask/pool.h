/* Candidate masks pooled: those of one object in one view, in whatever order they came. */
#ifndef MASK_POOL_H
#define MASK_POOL_H

#include "base/err.h"
#include "mask/select.h"

#include <stddef.h>

struct pool_record {
	const char *view, *ref, *object; /* without an object it is pooled with those of its ref only */
	const struct rle *mask;
	double score;
};

/* Where a record's candidate is. */
struct pool_place {
	const char *view, *name; /* of the object, or the ref where there is none */
	int is_ref;
	const char *ref; /* may be NULL */
	size_t index;	 /* of the record */
};

/* The candidates of one object in one view. */
struct pool_group {
	size_t first;  /* the record that came first */
	size_t object; /* the first record of its object, in any view */
	size_t begin, n;
	/* of pool_select */
	long winner; /* record, or -1 */
	const struct rle *mask;
	double vote;
};

struct pool {
	size_t n;		      /* candidates */
	struct pool_place *places;    /* (n) by view and object, then in their order */
	struct candidate *candidates; /* (n) as places */
	size_t group_count;
	struct pool_group *groups; /* in the order of their first records */
};

/* The records are referred to. */
int pool_make(struct pool *p, const struct pool_record *records, size_t n, struct err *e);
void pool_free(struct pool *p);

/* Masks of one view are compared pixel by pixel: 0 where they have one size, else -1, with *bad the first
 * record that differs from its view's first, *first. */
int pool_check_sizes(const struct pool *p, size_t *bad, size_t *first);

/* Each group's winner by select_winner, and its vote. Once for a pool. */
int pool_select(struct pool *p, enum select_method method, double min_score, struct err *e);

#endif
