#include "mask/pool.h"

#include "base/compare.h"
#include "base/mem.h"

/* An object's keys by name alone, whatever the view. */
static int order_names(const struct mask_key *p, const struct mask_key *q)
{
	int order = p->is_ref - q->is_ref;

	return order ? order : strcmp(p->name, q->name);
}

/* Of groups, each by the key of its first candidate: those of an object side by side. */
static int order_objects(const void *a, const void *b)
{
	const struct mask_key *p = *(const struct mask_key *const *)a,
			      *q = *(const struct mask_key *const *)b;
	int order = order_names(p, q);

	return order ? order : COMPARE(p->at, q->at);
}

static int order_groups(const void *a, const void *b)
{
	const struct pool_group *p = a, *q = b;

	return COMPARE(p->first, q->first);
}

/* Groups are those of keys that follow each other; the first of an object's groups names the object. */
static int make_groups(struct pool *p, struct err *e)
{
	SCOPED const struct mask_key **first = mem_alloc(p->n, sizeof *first, "candidates", e);
	/* of a group's first candidate */
	SCOPED size_t *object = mem_alloc(p->n, sizeof *object, "candidates", e);

	if (!first || !object)
		return -1;
	for (size_t i = 0; i < p->n; i++) {
		const struct mask_key *key = &p->index.keys[i];
		if (!i || mask_key_order(key, key - 1)) {
			first[p->group_count] = key;
			p->groups[p->group_count++] =
				(struct pool_group){.first = key->at, .begin = i, .winner = -1};
		}
		p->groups[p->group_count - 1].n++;
	}
	if (p->group_count) {
		qsort(first, p->group_count, sizeof *first, order_objects);
		qsort(p->groups, p->group_count, sizeof *p->groups, order_groups);
	}
	for (size_t i = 0; i < p->group_count; i++)
		object[first[i]->at] =
			i && !order_names(first[i], first[i - 1]) ? object[first[i - 1]->at] : first[i]->at;
	for (size_t i = 0; i < p->group_count; i++)
		p->groups[i].object = object[p->groups[i].first];
	return 0;
}

int pool_make(struct pool *p, const struct mask *candidates, size_t n, struct err *e)
{
	*p = (struct pool){.n = n, .candidates = candidates};
	p->groups = mem_alloc(n, sizeof *p->groups, "candidates", e);
	return !p->groups || mask_index_make(&p->index, candidates, n, MASK_BY_OBJECT, e) || make_groups(p, e)
		       ? -1
		       : 0;
}

void pool_free(struct pool *p)
{
	mask_index_free(&p->index);
	free(p->groups);
	*p = (struct pool){0};
}

int pool_check_sizes(const struct pool *p, size_t *bad, size_t *first)
{
	const struct mask_key *keys = p->index.keys;

	*bad = p->n;
	for (size_t begin = 0, end; begin < p->n; begin = end) {
		size_t least = begin;
		for (end = begin; end < p->n && !strcmp(keys[end].view, keys[begin].view); end++)
			if (keys[end].at < keys[least].at)
				least = end;
		const struct rle *mask = &p->candidates[keys[least].at].rle;
		for (size_t i = begin; i < end; i++) {
			const struct rle *other = &p->candidates[keys[i].at].rle;
			if (!rle_same_size(other, mask) && keys[i].at < *bad) {
				*bad = keys[i].at;
				*first = keys[least].at;
			}
		}
	}
	return *bad == p->n ? 0 : -1;
}

int pool_select(struct pool *p, enum select_method method, double min_score, struct err *e)
{
	SCOPED double *votes = mem_alloc(p->n, sizeof *votes, "votes", e);
	SCOPED const struct mask **masks = mem_alloc(p->n, sizeof *masks, "votes", e); /* as the index */
	SCOPED size_t *areas = mem_alloc(p->n, sizeof *areas, "votes", e);

	if (!votes || !masks || !areas)
		return -1;
	for (size_t i = 0; i < p->n; i++) {
		masks[i] = &p->candidates[p->index.keys[i].at];
		areas[i] = rle_area(&masks[i]->rle);
	}
#pragma omp parallel for schedule(dynamic)
	for (size_t i = 0; i < p->group_count; i++) {
		struct pool_group *g = &p->groups[i];
		const long best = select_winner(
			masks + g->begin, areas + g->begin, g->n, method, min_score, votes + g->begin);
		if (best < 0)
			continue;
		const size_t at = g->begin + (size_t)best;
		g->winner = (long)p->index.keys[at].at;
		g->vote = votes[at];
	}
	return 0;
}
