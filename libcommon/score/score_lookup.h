/* Finding mask records by view and name, without looking at all of them. */
#ifndef SCORE_SCORE_LOOKUP_H
#define SCORE_SCORE_LOOKUP_H

#include "score/score.h"

/* What a record is looked up by, besides its view. */
enum score_lookup_by {
	SCORE_BY_REF,
	SCORE_BY_OBJECT,
	SCORE_BY_BARE_OBJECT, /* the object of records without ref */
	SCORE_BY_VIEW,	      /* alone: the name is "" */
	SCORE_LOOKUPS
};

struct score_name {
	const char *view, *name; /* the records' own */
	size_t index;		 /* of the record */
};

struct score_lookup {
	size_t n;
	struct score_name *items; /* by view, name and index; owned */
};

/* Lists the records that have such a name. Release with score_lookup_free. */
int score_lookup_make(struct score_lookup *l, const struct score_mask *masks, size_t n,
	enum score_lookup_by by, struct err *e);
void score_lookup_free(struct score_lookup *l);

/* By view and name alone. */
int score_name_order(const struct score_name *a, const struct score_name *b);

/* The range [*begin,*end) of items with that view and name; empty where there is none, or name is NULL. */
void score_lookup_find(
	const struct score_lookup *l, const char *view, const char *name, size_t *begin, size_t *end);

/* The record that belongs to a ref or object (either may be NULL): that of the ref, else the object's, one
 * without ref first. `lists` are by ref, object and bare object. 1 and *index where it is the ref's, 2 where
 * it is the object's, 0 where there is none. */
int score_lookup_best(const struct score_lookup lists[], const char *view, const char *ref,
	const char *object, size_t *index);

#endif
