#include "score/score_lookup.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

int score_name_order(const struct score_name *a, const struct score_name *b)
{
	int order = strcmp(a->view, b->view);

	return order ? order : strcmp(a->name, b->name);
}

static int order_names(const void *a, const void *b)
{
	const struct score_name *p = a, *q = b;
	int order = score_name_order(p, q);

	return order ? order : (p->index > q->index) - (p->index < q->index);
}

static const char *name_of(const struct score_mask *mask, enum score_lookup_by by)
{
	switch (by) {
	case SCORE_BY_REF:
		return mask->ref;
	case SCORE_BY_OBJECT:
		return mask->object;
	case SCORE_BY_BARE_OBJECT:
		return mask->ref ? NULL : mask->object;
	default:
		return "";
	}
}

int score_lookup_make(struct score_lookup *l, const struct score_mask *masks, size_t n,
	enum score_lookup_by by, struct err *e)
{
	*l = (struct score_lookup){0};
	l->items = mem_alloc(n, sizeof *l->items, "masks", e);
	if (!l->items)
		return -1;
	for (size_t i = 0; i < n; i++) {
		const char *name = name_of(&masks[i], by);
		if (name)
			l->items[l->n++] = (struct score_name){masks[i].view, name, i};
	}
	if (l->n)
		qsort(l->items, l->n, sizeof *l->items, order_names);
	return 0;
}

void score_lookup_free(struct score_lookup *l)
{
	free(l->items);
	*l = (struct score_lookup){0};
}

/* The first item that is not before the key or, with `past`, the first that is behind it. */
static size_t bound(const struct score_lookup *l, const struct score_name *key, int past)
{
	size_t low = 0, high = l->n;

	while (low < high) {
		size_t middle = low + (high - low) / 2;
		if (score_name_order(&l->items[middle], key) < past)
			low = middle + 1;
		else
			high = middle;
	}
	return low;
}

void score_lookup_find(
	const struct score_lookup *l, const char *view, const char *name, size_t *begin, size_t *end)
{
	const struct score_name key = {view, name, 0};

	*begin = name ? bound(l, &key, 0) : 0;
	*end = name ? bound(l, &key, 1) : 0;
}

int score_lookup_best(const struct score_lookup lists[], const char *view, const char *ref,
	const char *object, size_t *index)
{
	static const enum score_lookup_by order[] = {SCORE_BY_REF, SCORE_BY_BARE_OBJECT, SCORE_BY_OBJECT};

	for (int i = 0; i < 3; i++) {
		const struct score_lookup *l = &lists[order[i]];
		size_t begin, end;
		score_lookup_find(l, view, i ? object : ref, &begin, &end);
		if (begin == end)
			continue;
		*index = l->items[begin].index;
		return i ? 2 : 1;
	}
	return 0;
}
