/* The surest candidate of each object in each view, as lift_left_out takes masks. */
#include "lift/regions.h"

#include "base/mem.h"

static int fill_view(const struct regions *r, size_t from, size_t to, struct lift_view *v, struct err *e)
{
	const struct regions_witness *w = r->witnesses;
	const struct seen *seen = &r->seen[w[from].view];

	v->objects = mem_alloc(to - from, sizeof *v->objects, "views", e);
	v->rows = mem_alloc(to - from, sizeof *v->rows, "views", e);
	v->vote = mem_alloc(to - from, sizeof *v->vote, "views", e);
	v->agreement = mem_zalloc(to - from, sizeof *v->agreement, "views", e);
	v->weight = mem_alloc(r->gaussians, sizeof *v->weight, "views", e);
	if (!v->objects || !v->rows || !v->vote || !v->agreement || !v->weight)
		return -1;
	for (size_t i = 0; i < r->gaussians; i++)
		v->weight[i] = seen->marks ? seen_weight(seen, i) : 0;
	for (size_t i = from; i < to; i++) {
		size_t k = 0;
		while (k < v->n && v->objects[k] != w[i].object)
			k++;
		if (k < v->n || w[i].candidate == REGIONS_NONE)
			continue;
		v->objects[v->n] = w[i].object;
		v->rows[v->n] = r->candidates[w[i].candidate].shares;
		v->vote[v->n++] = 1;
	}
	return 0;
}

int regions_surest(const struct regions *r, struct lift_objects *to, struct err *e)
{
	int bad = lift_objects_init(to, r->gaussians, r->object_count, r->views, e);

	for (size_t i = 0, next; i < r->witness_count && !bad; i = next) {
		for (next = i; next < r->witness_count && r->witnesses[next].view == r->witnesses[i].view;)
			next++;
		bad = fill_view(r, i, next, &to->views[r->witnesses[i].view], e);
	}
	return bad;
}

void regions_surest_free(struct lift_objects *l)
{
	for (size_t v = 0; v < l->view_count; v++)
		l->views[v].n = 0;
	lift_objects_free(l);
}
