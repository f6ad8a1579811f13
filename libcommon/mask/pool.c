#include "mask/pool.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

static int order_names(const struct pool_place *p, const struct pool_place *q)
{
	int order = p->is_ref - q->is_ref;

	return order ? order : strcmp(p->name, q->name);
}

static int order_indices(size_t a, size_t b)
{
	return (a > b) - (a < b);
}

static int order_places(const void *a, const void *b)
{
	const struct pool_place *p = a, *q = b;
	int order = strcmp(p->view, q->view);

	if (!order)
		order = order_names(p, q);
	return order ? order : order_indices(p->index, q->index);
}

/* Of groups, each by the place of its first candidate: those of an object side by side. */
static int order_objects(const void *a, const void *b)
{
	const struct pool_place *p = *(const struct pool_place *const *)a,
				*q = *(const struct pool_place *const *)b;
	int order = order_names(p, q);

	return order ? order : order_indices(p->index, q->index);
}

static int order_groups(const void *a, const void *b)
{
	const struct pool_group *p = a, *q = b;

	return order_indices(p->first, q->first);
}

/* Groups are those of places that follow each other; the first of an object's groups names the object. */
static int make_groups(struct pool *p, struct err *e)
{
	const struct pool_place **first = mem_alloc(p->n, sizeof *first, "candidates", e);
	size_t *object = mem_alloc(p->n, sizeof *object, "candidates", e); /* of a group's first record */

	if (!first || !object) {
		free(first);
		free(object);
		return -1;
	}
	for (size_t i = 0; i < p->n; i++) {
		const struct pool_place *place = &p->places[i];
		if (!i || strcmp(place->view, place[-1].view) || order_names(place, place - 1)) {
			first[p->group_count] = place;
			p->groups[p->group_count++] =
				(struct pool_group){.first = place->index, .begin = i, .winner = -1};
		}
		p->groups[p->group_count - 1].n++;
	}
	if (p->group_count) {
		qsort(first, p->group_count, sizeof *first, order_objects);
		qsort(p->groups, p->group_count, sizeof *p->groups, order_groups);
	}
	for (size_t i = 0; i < p->group_count; i++)
		object[first[i]->index] = i && !order_names(first[i], first[i - 1])
						  ? object[first[i - 1]->index]
						  : first[i]->index;
	for (size_t i = 0; i < p->group_count; i++)
		p->groups[i].object = object[p->groups[i].first];
	free(first);
	free(object);
	return 0;
}

int pool_make(struct pool *p, const struct pool_record *records, size_t n, struct err *e)
{
	*p = (struct pool){.n = n};
	p->places = mem_alloc(n, sizeof *p->places, "candidates", e);
	p->candidates = mem_alloc(n, sizeof *p->candidates, "candidates", e);
	p->groups = mem_alloc(n, sizeof *p->groups, "candidates", e);
	if (!p->places || !p->candidates || !p->groups)
		goto fail;
	for (size_t i = 0; i < n; i++) {
		const struct pool_record *r = &records[i];
		p->places[i] =
			(struct pool_place){r->view, r->object ? r->object : r->ref, !r->object, r->ref, i};
	}
	if (n)
		qsort(p->places, n, sizeof *p->places, order_places);
	for (size_t i = 0; i < n; i++) {
		const struct pool_record *r = &records[p->places[i].index];
		p->candidates[i] = (struct candidate){r->mask, rle_area(r->mask), r->score};
	}
	if (!make_groups(p, e))
		return 0;
fail:
	pool_free(p);
	return -1;
}

void pool_free(struct pool *p)
{
	free(p->places);
	free(p->candidates);
	free(p->groups);
	*p = (struct pool){0};
}

int pool_check_sizes(const struct pool *p, size_t *bad, size_t *first)
{
	*bad = p->n;
	for (size_t begin = 0, end; begin < p->n; begin = end) {
		size_t least = begin;
		for (end = begin; end < p->n && !strcmp(p->places[end].view, p->places[begin].view); end++)
			if (p->places[end].index < p->places[least].index)
				least = end;
		const struct rle *mask = p->candidates[least].mask;
		for (size_t i = begin; i < end; i++) {
			const struct rle *other = p->candidates[i].mask;
			if ((other->height != mask->height || other->width != mask->width) &&
				p->places[i].index < *bad) {
				*bad = p->places[i].index;
				*first = p->places[least].index;
			}
		}
	}
	return *bad == p->n ? 0 : -1;
}

int pool_select(struct pool *p, enum select_method method, double min_score, struct err *e)
{
	double *votes = mem_alloc(p->n, sizeof *votes, "votes", e);

	if (!votes)
		return -1;
#pragma omp parallel for schedule(dynamic)
	for (size_t i = 0; i < p->group_count; i++) {
		struct pool_group *g = &p->groups[i];
		long best =
			select_winner(p->candidates + g->begin, g->n, method, min_score, votes + g->begin);
		if (best < 0)
			continue;
		const size_t at = g->begin + (size_t)best;
		g->winner = (long)p->places[at].index;
		g->mask = p->candidates[at].mask;
		g->vote = votes[at];
	}
	free(votes);
	return 0;
}
