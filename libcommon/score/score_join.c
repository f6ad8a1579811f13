#include "score/score_join.h"

#include "base/mem.h"

/* By truth; a pair without ref comes before those with one. */
static int order_pairs(const void *a, const void *b)
{
	const struct score_pair *p = a, *q = b;

	if (p->truth_index != q->truth_index)
		return p->truth_index < q->truth_index ? -1 : 1;
	if (p->ref && q->ref)
		return strcmp(p->ref, q->ref);
	return (p->ref != NULL) - (q->ref != NULL);
}

static int order_places(const void *a, const void *b)
{
	const struct score_pair *p = a, *q = b;

	return (p->place > q->place) - (p->place < q->place);
}

/* The pairs of one truth on one side. */
struct run {
	const struct score_pair
		*bare; /* without ref, perhaps without a prediction; NULL where there is none */
	const struct score_pair *named; /* those with ref */
	size_t n;
};

static struct run take_run(const struct score_pair *items, size_t n, size_t *at)
{
	const struct score_pair *first = &items[*at];
	struct run r = {.bare = first->ref ? NULL : first, .named = first->ref ? first : first + 1};

	*at += r.bare != NULL;
	for (; *at < n && items[*at].truth_index == first->truth_index; ++*at)
		r.n++;
	return r;
}

/* What a side has for a sentence of the truth: its own, else the mask without ref, else nothing. */
static struct score_pair side_of(const struct run *r, const struct score_pair *own)
{
	const struct score_pair *found = own ? own : r->bare;
	struct score_pair pair = found ? *found : r->named[0];

	if (!found)
		pair.prediction = NULL;
	return pair;
}

struct join {
	struct score_pair *sorted[2]; /* (n[i]) */
	struct score_pair *joined[2]; /* (at most n[0]+n[1]) */
	size_t n[2], count;
};

static void add(struct join *j, const struct run runs[2], const struct score_pair *own[2])
{
	const struct score_pair *named = own[0] ? own[0] : own[1];
	struct score_pair a = side_of(&runs[0], own[0]), b = side_of(&runs[1], own[1]);

	a.ref = b.ref = named->ref;
	a.place = b.place = own[0] ? own[0]->place : j->n[0] + own[1]->place;
	a.object = b.object = a.prediction || !b.prediction ? a.object : b.object;
	j->joined[0][j->count] = a;
	j->joined[1][j->count++] = b;
}

static void join_truth(struct join *j, const struct run runs[2])
{
	size_t at[2] = {0, 0};

	while (at[0] < runs[0].n || at[1] < runs[1].n) {
		int order = at[0] == runs[0].n	 ? 1
			    : at[1] == runs[1].n ? -1
						 : order_pairs(&runs[0].named[at[0]], &runs[1].named[at[1]]);
		const struct score_pair *own[2] = {order <= 0 ? &runs[0].named[at[0]++] : NULL,
			order >= 0 ? &runs[1].named[at[1]++] : NULL};
		add(j, runs, own);
	}
	if (runs[0].bare && runs[1].bare)
		add(j, runs, (const struct score_pair *[2]){runs[0].bare, runs[1].bare});
}

int score_join(struct score_pairs *a, struct score_pairs *b, struct err *e)
{
	struct score_pairs *sides[2] = {a, b};
	struct join j = {.n = {a->n, b->n}};
	size_t at[2] = {0, 0};
	int bad = 0;

	for (int s = 0; s < 2; s++) {
		j.sorted[s] = mem_alloc(sides[s]->n, sizeof *j.sorted[s], "pairs", e);
		j.joined[s] = mem_alloc(a->n + b->n, sizeof *j.joined[s], "pairs", e);
		bad = bad || !j.sorted[s] || !j.joined[s];
		if (bad || !sides[s]->n)
			continue;
		memcpy(j.sorted[s], sides[s]->items, sides[s]->n * sizeof *j.sorted[s]);
		qsort(j.sorted[s], sides[s]->n, sizeof *j.sorted[s], order_pairs);
	}
	/* every truth has a pair on either side */
	while (!bad && at[0] < j.n[0]) {
		struct run runs[2];
		for (int s = 0; s < 2; s++)
			runs[s] = take_run(j.sorted[s], j.n[s], &at[s]);
		join_truth(&j, runs);
	}
	for (int s = 0; s < 2; s++) {
		free(j.sorted[s]);
		if (bad) {
			free(j.joined[s]);
			continue;
		}
		if (j.count)
			qsort(j.joined[s], j.count, sizeof *j.joined[s], order_places);
		free(sides[s]->items);
		sides[s]->items = j.joined[s];
		sides[s]->n = j.count;
		sides[s]->capacity = j.n[0] + j.n[1];
	}
	return bad ? -1 : 0;
}
