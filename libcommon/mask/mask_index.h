/* Finding masks by their view and their ref or object, without looking at all of them. */
#pragma once

#include "mask/mask.h"

enum mask_by {
	MASK_BY_REF,	/* the ref; of a mask without one its object: what must not be there twice */
	MASK_BY_OBJECT, /* the object; of a mask without one its ref */
};

/* Where a mask is. The ref of one and the object of another are never the same, however they are spelt. */
struct mask_key {
	const char *view, *name; /* the mask's own */
	int is_ref;
	size_t at; /* among the masks */
};

struct mask_index {
	size_t n;
	struct mask_key *keys; /* by view, objects before refs, by name, by place; owned */
};

/* The masks' strings must outlive the index. Returns 0, or -1 with *e set and nothing to free. */
int mask_index_make(struct mask_index *x, const struct mask *masks, size_t n, enum mask_by by, struct err *e);
void mask_index_free(struct mask_index *x);

/* By view, kind and name, not by place. */
int mask_key_order(const struct mask_key *a, const struct mask_key *b);

/* The keys [*begin,*end) of a view, and those of a ref or an object there; none where the name is NULL. */
void mask_index_view(const struct mask_index *x, const char *view, size_t *begin, size_t *end);
void mask_index_ref(
	const struct mask_index *x, const char *view, const char *ref, size_t *begin, size_t *end);
void mask_index_object(
	const struct mask_index *x, const char *view, const char *object, size_t *begin, size_t *end);

/* The first mask, in their order, whose key an earlier one has: 1, its place in *later and that one's in
 * *earlier; 0 where all keys differ. */
int mask_index_twice(const struct mask_index *x, size_t *earlier, size_t *later);

/* Both, for what belongs to a ref or object. */
struct mask_lookup {
	struct mask_index by_ref, by_object;
};

int mask_lookup_make(struct mask_lookup *l, const struct mask *masks, size_t n, struct err *e);
void mask_lookup_free(struct mask_lookup *l);

/* The mask that belongs to a ref or object (either may be NULL): that of the ref, else the object's, one
 * without ref first, the earlier one of several. */
enum mask_found { MASK_NONE, MASK_OF_REF, MASK_OF_OBJECT };
enum mask_found mask_lookup_find(
	const struct mask_lookup *l, const char *view, const char *ref, const char *object, size_t *at);
