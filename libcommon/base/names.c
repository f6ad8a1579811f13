#include "base/names.h"

#include "base/mem.h"
#include "base/name.h"

#include <ctype.h>
#include <stdio.h>

static int by_name(const void *a, const void *b)
{
	const struct names_place *x = a, *y = b;
	int order = strcmp(x->name, y->name);

	return order ? order : (x->place > y->place) - (x->place < y->place);
}

int names_make(struct names *names, const void *items, size_t stride, size_t offset, size_t n, struct err *e)
{

	*names = (struct names){0};
	names->sorted = mem_alloc(n, sizeof *names->sorted, "names", e);
	if (!names->sorted)
		return -1;
	for (size_t i = 0; i < n; i++) {
		const char *name;
		memcpy(&name, (const char *)items + i * stride + offset, sizeof name);
		if (name)
			names->sorted[names->n++] = (struct names_place){name, i};
	}
	if (names->n)
		qsort(names->sorted, names->n, sizeof *names->sorted, by_name);
	return 0;
}

void names_free(struct names *names)
{
	free(names->sorted);
	*names = (struct names){0};
}

/* As strcmp, of a name and one of `length` bytes. */
static int compare(const char *name, const struct list_name *with)
{
	int order = strncmp(name, with->text, with->length);

	return order ? order : name[with->length] != 0;
}

size_t names_find_part(const struct names *names, const struct list_name *name)
{
	size_t low = 0, high = names->n;

	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (compare(names->sorted[middle].name, name) < 0)
			low = middle + 1;
		else
			high = middle;
	}
	return low < names->n && !compare(names->sorted[low].name, name) ? names->sorted[low].place
									 : NAMES_NONE;
}

size_t names_find(const struct names *names, const char *name)
{
	return names_find_part(names, &(struct list_name){name, strlen(name)});
}

size_t names_twice(const struct names *names, size_t *earlier)
{
	size_t later = NAMES_NONE;

	for (size_t i = 1; i < names->n; i++) {
		const struct names_place *a = &names->sorted[i - 1], *b = &names->sorted[i];
		if (b->place < later && !strcmp(a->name, b->name)) {
			*earlier = a->place;
			later = b->place;
		}
	}
	return later;
}

int names_find_twice(const void *items, size_t stride, size_t offset, size_t n, size_t *twice,
	size_t *earlier, struct err *e)
{
	SCOPED_BY(names_free) struct names names = {0};

	if (names_make(&names, items, stride, offset, n, e))
		return -1;
	*twice = names_twice(&names, earlier);
	return 0;
}

size_t names_count(const struct names *names)
{
	size_t count = names->n > 0;

	for (size_t i = 1; i < names->n; i++)
		count += strcmp(names->sorted[i - 1].name, names->sorted[i].name) != 0;
	return count;
}

/* By letters in either case, with '_' and '-' as blanks. */
static int by_spelling(const void *a, const void *b)
{
	const char *x = ((const struct names_place *)a)->name, *y = ((const struct names_place *)b)->name;
	int order = 0;

	for (; !order && (*x || *y); x++, y++)
		order = (strchr("_-", *x) && *x ? ' ' : tolower((unsigned char)*x)) -
			(strchr("_-", *y) && *y ? ' ' : tolower((unsigned char)*y));
	return order;
}

int names_check_spelling(struct names *names, const char *path, struct err *e)
{
	if (names->n)
		qsort(names->sorted, names->n, sizeof *names->sorted, by_spelling);
	for (size_t i = 1; i < names->n; i++) {
		const char *x = names->sorted[i - 1].name, *y = names->sorted[i].name;
		if (!by_spelling(&names->sorted[i - 1], &names->sorted[i]) && strcmp(x, y) != 0)
			return err_file(e, path,
				"'%.80s' and '%.80s' are one name in two spellings, and would be two things: write them alike, in masks and sentences",
				strcmp(x, y) < 0 ? x : y, strcmp(x, y) < 0 ? y : x);
	}
	return 0;
}

const char *names_few(const struct names *names, char few[NAMES_FEW])
{
	const size_t shown = names->n > 5 ? 3 : names->n;
	int used = snprintf(few, NAMES_FEW, "; there %s %zu", names->n == 1 ? "is" : "are", names->n);

	for (size_t i = 0; i < shown && used < NAMES_FEW; i++)
		used += snprintf(few + used, (size_t)(NAMES_FEW - used), "%s %s", i ? "," : ":",
			names->sorted[i].name);
	if (shown < names->n && used < NAMES_FEW)
		snprintf(few + used, (size_t)(NAMES_FEW - used), " ... %s", names->sorted[names->n - 1].name);
	return few;
}

int names_mark(const void *items, size_t stride, size_t offset, size_t n, const char *list,
	const char *option, const char *what, char *chosen, struct err *e)
{
	struct list_name name;
	SCOPED_BY(names_free) struct names names = {0};
	SCOPED char *copy = list ? name_copy(list, e) : NULL;
	const char *rest = copy;
	int bad = (list && !copy) || names_make(&names, items, stride, offset, n, e);

	while (!bad && list_next(&rest, &name)) {
		const size_t place = names_find_part(&names, &name);
		char few[NAMES_FEW];
		if (place == NAMES_NONE)
			bad = err_set(e, ERR_USAGE, "%s: no %s '%.*s'%s", option, what, (int)name.length,
				name.text, names_few(&names, few));
		else
			chosen[place] = 1;
	}
	return bad ? -1 : 0;
}
