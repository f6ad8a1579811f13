/* What the training sentences of a lifted model call each thing, and say of it alone; what it may be called
 * besides. */
#pragma once

#include "base/rng.h"
#include "cmd/ask/asking.h"

enum { SAYING_PART = 64 }; /* of the longest part with its 0 */

enum saying_part {
	SAYING_NOUN,
	SAYING_SYNONYM,
	SAYING_LOOK,   /* "red", "small" */
	SAYING_HAVING, /* "with a yellow scarf" */
	SAYING_KINDS
};

struct saying_parts {
	size_t objects;
	struct saying_list {
		size_t n, capacity;
		char (*items)[SAYING_PART];
	} * lists; /* (objects, SAYING_KINDS) */
};

/* Returns 0, or -1 with *e set (memory); saying_parts_free after either. */
int saying_parts_read(struct saying_parts *s, const struct asking *a, struct err *e);
void saying_parts_free(struct saying_parts *s);

/* A random one of an object; NULL where it has none. */
const char *saying_parts_draw(
	const struct saying_parts *s, size_t object, enum saying_part kind, struct rng *r);

/* Whether an object has the part; a noun may be a synonym. */
int saying_parts_have(const struct saying_parts *s, size_t object, enum saying_part kind, const char *text);
