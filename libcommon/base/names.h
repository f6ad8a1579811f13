/* Names and where they stand: a sorted index over any array, so that looking one name up, and finding one
 * that is there twice, takes n log n steps over all whatever the names are. */
#pragma once

#include "base/err.h"
#include "base/list.h"

struct names_place {
	const char *name; /* not owned */
	size_t place;
};

struct names {
	size_t n;
	struct names_place *sorted; /* by name in byte order, then by place */
};

#define NAMES_NONE ((size_t)-1)

/* Of n items, `stride` bytes apart, each with a `char *` at `offset`. Items whose name is NULL are left out.
 * The names must outlive the index. Returns 0, or -1 with *e. */
int names_make(struct names *names, const void *items, size_t stride, size_t offset, size_t n, struct err *e);
void names_free(struct names *names);

/* The first place with this name, or NAMES_NONE. */
size_t names_find(const struct names *names, const char *name);
size_t names_find_part(const struct names *names, const struct list_name *name);

/* The place, in the array's order, of the first name that an earlier item has, and that item's in *earlier;
 * NAMES_NONE where all differ. */
size_t names_twice(const struct names *names, size_t *earlier);

/* The same of items as names_make takes them: 0 and *twice, or -1 with *e. */
int names_find_twice(const void *items, size_t stride, size_t offset, size_t n, size_t *twice,
	size_t *earlier, struct err *e);

/* How many different names there are. */
size_t names_count(const struct names *names);

/* Refuses names that differ in the case of letters, or in '_', '-' and blanks, alone: 0, or -1 with *e
 * (ERR_FORMAT). The names are then out of order. */
int names_check_spelling(struct names *names, const char *path, struct err *e);

/* For a message on a name that is not there, "; there are 26: a, b, c ... z": how many there are, and some.
 * Returns few. */
enum { NAMES_FEW = 400 };
const char *names_few(const struct names *names, char few[NAMES_FEW]);

/* Sets chosen[place] (n) to 1 for the first item, of those that names_make takes, of each name in a
 * comma-separated list (NULL has none). Returns 0, or -1 with *e: ERR_USAGE and "option: no what 'NAME';
 * there are ..." for a name that no item has. */
int names_mark(const void *items, size_t stride, size_t offset, size_t n, const char *list,
	const char *option, const char *what, char *chosen, struct err *e);
