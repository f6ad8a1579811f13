#include "mask/mask_index.h"

#include "base/mem.h"

int mask_key_order(const struct mask_key *a, const struct mask_key *b)
{
	int order = strcmp(a->view, b->view);

	if (!order)
		order = a->is_ref - b->is_ref;
	return order ? order : strcmp(a->name, b->name);
}

static int order_keys(const void *a, const void *b)
{
	const struct mask_key *p = a, *q = b;
	int order = mask_key_order(p, q);

	return order ? order : (p->at > q->at) - (p->at < q->at);
}

static struct mask_key key_of(const struct mask *m, size_t at, enum mask_by by)
{
	const int is_ref = m->ref && (by == MASK_BY_REF || !m->object);

	return (struct mask_key){m->view, is_ref ? m->ref : m->object, is_ref, at};
}

int mask_index_make(struct mask_index *x, const struct mask *masks, size_t n, enum mask_by by, struct err *e)
{
	*x = (struct mask_index){.keys = mem_alloc(n, sizeof *x->keys, "masks", e)};
	if (!x->keys)
		return -1;
	for (; x->n < n; x->n++)
		x->keys[x->n] = key_of(&masks[x->n], x->n, by);
	if (n)
		qsort(x->keys, n, sizeof *x->keys, order_keys);
	return 0;
}

void mask_index_free(struct mask_index *x)
{
	free(x->keys);
	*x = (struct mask_index){0};
}

/* As mask_key_order; a key without name is any of its view. */
static int order_with(const struct mask_key *key, const struct mask_key *with)
{
	return with->name ? mask_key_order(key, with) : strcmp(key->view, with->view);
}

/* The first key that is not before another or, with `past`, the first that is behind it. */
static size_t bound(const struct mask_index *x, const struct mask_key *key, int past)
{
	size_t low = 0, high = x->n;

	while (low < high) {
		size_t middle = low + (high - low) / 2;
		if (order_with(&x->keys[middle], key) < past)
			low = middle + 1;
		else
			high = middle;
	}
	return low;
}

static void find(const struct mask_index *x, struct mask_key key, size_t *begin, size_t *end)
{
	*begin = bound(x, &key, 0);
	*end = bound(x, &key, 1);
}

void mask_index_view(const struct mask_index *x, const char *view, size_t *begin, size_t *end)
{
	find(x, (struct mask_key){.view = view}, begin, end);
}

static void find_name(const struct mask_index *x, const char *view, const char *name, int is_ref,
	size_t *begin, size_t *end)
{
	*begin = *end = 0;
	if (name)
		find(x, (struct mask_key){view, name, is_ref, 0}, begin, end);
}

void mask_index_ref(const struct mask_index *x, const char *view, const char *ref, size_t *begin, size_t *end)
{
	find_name(x, view, ref, 1, begin, end);
}

void mask_index_object(
	const struct mask_index *x, const char *view, const char *object, size_t *begin, size_t *end)
{
	find_name(x, view, object, 0, begin, end);
}

int mask_index_twice(const struct mask_index *x, size_t *earlier, size_t *later)
{
	int found = 0;

	for (size_t i = 1; i < x->n; i++) {
		const struct mask_key *before = &x->keys[i - 1], *one = &x->keys[i];
		if ((found && one->at > *later) || mask_key_order(before, one))
			continue;
		*earlier = before->at;
		*later = one->at;
		found = 1;
	}
	return found;
}

int mask_lookup_make(struct mask_lookup *l, const struct mask *masks, size_t n, struct err *e)
{
	*l = (struct mask_lookup){0};
	return -(mask_index_make(&l->by_ref, masks, n, MASK_BY_REF, e) ||
		 mask_index_make(&l->by_object, masks, n, MASK_BY_OBJECT, e));
}

void mask_lookup_free(struct mask_lookup *l)
{
	mask_index_free(&l->by_ref);
	mask_index_free(&l->by_object);
}

enum mask_found mask_lookup_find(
	const struct mask_lookup *l, const char *view, const char *ref, const char *object, size_t *at)
{
	const struct mask_index *x = &l->by_ref;
	enum mask_found found = MASK_OF_REF;
	size_t begin, end;

	mask_index_ref(x, view, ref, &begin, &end);
	if (begin == end) {
		found = MASK_OF_OBJECT;
		mask_index_object(x, view, object, &begin, &end);
	}
	if (begin == end)
		mask_index_object(x = &l->by_object, view, object, &begin, &end);
	if (begin == end)
		return MASK_NONE;
	*at = x->keys[begin].at;
	return found;
}
