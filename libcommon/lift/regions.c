#include "lift/regions.h"

#include "base/mem.h"

static int order_sizes(size_t a, size_t b)
{
	return (a > b) - (a < b);
}

/* Of masks of one array: as they came. */
static int order_masks(const struct regions_witness *p, const struct regions_witness *q)
{
	return (p->mask > q->mask) - (p->mask < q->mask);
}

static int order_sentences(const struct regions_witness *p, const struct regions_witness *q)
{
	int order = order_sizes(p->object, q->object);

	if (order || !p->mask->ref || !q->mask->ref)
		return order ? order : !!p->mask->ref - !!q->mask->ref;
	return strcmp(p->mask->ref, q->mask->ref);
}

static int by_sentence(const void *a, const void *b)
{
	const struct regions_witness *p = a, *q = b;
	int order = order_sentences(p, q);

	return order ? order : order_masks(p, q);
}

static int by_view(const void *a, const void *b)
{
	const struct regions_witness *p = a, *q = b;
	const double mine = mask_confidence(p->mask), other = mask_confidence(q->mask);
	int order = order_sizes(p->view, q->view);

	if (!order)
		order = (mine < other) - (mine > other);
	if (!order)
		order = mask_order(p->mask, q->mask);
	return order ? order : order_masks(p, q);
}

static int by_size(const void *a, const void *b)
{
	return order_sizes(*(const size_t *)a, *(const size_t *)b);
}

/* Objects in the order in which they came. */
static void number_objects(struct regions *r, const struct pool *p)
{
	size_t n = 0;

	for (size_t i = 0; i < p->group_count; i++)
		r->objects[n++] = p->groups[i].object;
	if (n)
		qsort(r->objects, n, sizeof *r->objects, by_size);
	for (size_t i = 0; i < n; i++)
		if (!i || r->objects[i] != r->objects[i - 1])
			r->objects[r->object_count++] = r->objects[i];
}

static size_t find_object(const struct regions *r, size_t first)
{
	const size_t *at = bsearch(&first, r->objects, r->object_count, sizeof *at, by_size);

	return (size_t)(at - r->objects);
}

static void number_sentences(struct regions *r)
{
	struct regions_witness *w = r->witnesses;

	if (r->witness_count)
		qsort(w, r->witness_count, sizeof *w, by_sentence);
	for (size_t i = 0; i < r->witness_count; i++) {
		if (!i || order_sentences(&w[i], &w[i - 1]))
			r->sentence_objects[r->sentence_count++] = w[i].object;
		w[i].sentence = r->sentence_count - 1;
	}
}

int regions_init(struct regions *r, const struct pool *p, const size_t *places, size_t views,
	size_t gaussians, double min_score, struct err *e)
{
	*r = (struct regions){.views = views, .gaussians = gaussians};
	r->witnesses = mem_alloc(p->n, sizeof *r->witnesses, "candidates", e);
	r->candidates = mem_zalloc(p->n, sizeof *r->candidates, "candidates", e);
	r->objects = mem_alloc(p->n, sizeof *r->objects, "candidates", e);
	r->sentence_objects = mem_alloc(p->n, sizeof *r->sentence_objects, "candidates", e);
	r->seen = mem_zalloc(views, sizeof *r->seen, "views", e);
	r->ranges = mem_zalloc(views, sizeof *r->ranges, "views", e);
	if (!r->witnesses || !r->candidates || !r->ranges || !r->objects || !r->sentence_objects ||
		!r->seen) {
		regions_free(r);
		return -1;
	}
	number_objects(r, p);
	for (size_t g = 0; g < p->group_count; g++) {
		const struct pool_group *group = &p->groups[g];
		const size_t object = find_object(r, group->object);
		for (size_t k = group->begin; k < group->begin + group->n; k++) {
			const size_t at = p->index.keys[k].at;
			const struct mask *mask = &p->candidates[at];
			if (mask_confidence(mask) > min_score)
				r->witnesses[r->witness_count++] =
					(struct regions_witness){mask, places[at], object, 0, REGIONS_NONE};
		}
	}
	number_sentences(r);
	if (r->witness_count)
		qsort(r->witnesses, r->witness_count, sizeof *r->witnesses, by_view);
	return 0;
}

void regions_free(struct regions *r)
{
	for (size_t i = 0; i < r->region_count; i++)
		mem_free_all(r->regions[i].members, r->regions[i].agreement, r->regions[i].chosen);
	for (size_t v = 0; v < r->views && r->ranges; v++)
		for (size_t c = r->ranges[v].begin; c < r->ranges[v].end; c++)
			shares_free(&r->candidates[c].shares);
	mem_free_all(r->witnesses, r->candidates, r->ranges, r->objects, r->sentence_objects);
	for (size_t v = 0; v < r->views && r->seen; v++)
		seen_free(&r->seen[v]);
	mem_free_all(r->seen, r->regions, r->served, r->spare, r->field);
	*r = (struct regions){0};
}
