/* A heap has the pairs, each with the key that it had when it was put there. A key rises as its clusters
 * grow, which is looked at only when it is taken; it is put again where its mean falls. Of two clusters the
 * one with fewer edges gives them to the other, so that an edge moves log m times at most. A table finds the
 * edge of a pair. */
#include "propose/linkage.h"

#include "base/mem.h"

#include <math.h>

struct waiting {
	double key;
	int32_t edge;
};

/* Edge k has the half edges 2k and 2k + 1: each is of the cluster at its own end. */
struct graph {
	int32_t *end, *next;  /* (2,edges) a half edge's cluster, and the next half edge of that; -1: none */
	int64_t *sum, *count; /* (edges) 0 edges: it is no more */
	double *key;	      /* (edges) what it waits with */
	int32_t edges;
	int32_t *first, *degree; /* (leaves) of a cluster, which has a leaf's number */
	int32_t *node;		 /* (leaves) in the tree */
	int32_t *table;		 /* (slots) edges, -1 */
	size_t slots;		 /* a power of two */
	struct waiting *heap;
	size_t waiting, room;
	double power;
};

static void graph_free(struct graph *g)
{
	mem_free_all(
		g->end, g->next, g->sum, g->count, g->key, g->first, g->degree, g->node, g->table, g->heap);
}

void linkage_free(struct linkage *l)
{
	mem_free_all(l->children, l->parent, l->size);
	*l = (struct linkage){0};
}

static size_t slot_of(const struct graph *g, int32_t a, int32_t b)
{
	const uint64_t low = (uint64_t)(a < b ? a : b), high = (uint64_t)(a < b ? b : a);
	uint64_t x = (low << 32 | high) * 0x9e3779b97f4a7c15;

	return (x ^ x >> 29) * 0xbf58476d1ce4e5b9 >> 20 & (g->slots - 1);
}

/* The place of a pair's edge in the table, or the free one where it would be. */
static size_t find(const struct graph *g, int32_t a, int32_t b)
{
	size_t at = slot_of(g, a, b);

	for (; g->table[at] >= 0; at = (at + 1) & (g->slots - 1)) {
		const int32_t *end = &g->end[2 * (size_t)g->table[at]];
		if ((end[0] == a && end[1] == b) || (end[0] == b && end[1] == a))
			break;
	}
	return at;
}

/* Takes a pair's edge out of the table: those that had to go on past it move up. */
static void forget(struct graph *g, int32_t a, int32_t b)
{
	size_t hole = find(g, a, b);

	for (size_t at = (hole + 1) & (g->slots - 1); g->table[at] >= 0; at = (at + 1) & (g->slots - 1)) {
		const int32_t *end = &g->end[2 * (size_t)g->table[at]];
		const size_t home = slot_of(g, end[0], end[1]);
		if (((at - home) & (g->slots - 1)) < ((at - hole) & (g->slots - 1)))
			continue;
		g->table[hole] = g->table[at];
		hole = at;
	}
	g->table[hole] = -1;
}

static void hang(struct graph *g, int32_t half)
{
	const int32_t cluster = g->end[half];

	g->next[half] = g->first[cluster];
	g->first[cluster] = half;
	g->degree[cluster]++;
}

static double key_of(const struct graph *g, const struct linkage *l, int32_t edge)
{
	const int32_t *end = &g->end[2 * (size_t)edge];
	const double size = fmin(l->size[g->node[end[0]]], l->size[g->node[end[1]]]);

	return (double)g->sum[edge] / (double)g->count[edge] * pow(size, g->power);
}

static int is_before(const struct waiting *a, const struct waiting *b)
{
	return a->key < b->key || (a->key == b->key && a->edge < b->edge);
}

static int put(struct graph *g, int32_t edge, double key, struct err *e)
{
	const struct waiting w = {key, edge};

	if (mem_grow((void **)&g->heap, &g->room, g->waiting + 1, sizeof *g->heap, "edges", e))
		return -1;
	g->key[edge] = key;
	size_t at = g->waiting++;
	for (; at && is_before(&w, &g->heap[(at - 1) / 2]); at = (at - 1) / 2)
		g->heap[at] = g->heap[(at - 1) / 2];
	g->heap[at] = w;
	return 0;
}

static struct waiting take(struct graph *g)
{
	const struct waiting top = g->heap[0], last = g->heap[--g->waiting];
	size_t at = 0;

	for (size_t below; (below = 2 * at + 1) < g->waiting; at = below) {
		below += below + 1 < g->waiting && is_before(&g->heap[below + 1], &g->heap[below]);
		if (!is_before(&g->heap[below], &last))
			break;
		g->heap[at] = g->heap[below];
	}
	g->heap[at] = last;
	return top;
}

/* An edge that is there before is made longer by another of its pair. */
static void add_edges(struct graph *g, const struct linkage_edge *edges, size_t count)
{
	for (size_t k = 0; k < count; k++) {
		const size_t at = find(g, edges[k].a, edges[k].b);
		int32_t edge = g->table[at];
		if (edge < 0) {
			edge = g->table[at] = g->edges++;
			g->end[2 * edge] = edges[k].a;
			g->end[2 * edge + 1] = edges[k].b;
			hang(g, 2 * edge);
			hang(g, 2 * edge + 1);
		}
		g->sum[edge] += edges[k].length;
		g->count[edge]++;
	}
}

static int graph_make(
	struct graph *g, int32_t leaves, const struct linkage_edge *edges, size_t count, struct err *e)
{
	if (count > INT32_MAX / 2)
		return err_set(e, ERR_FORMAT, "more than %d edges", INT32_MAX / 2);
	for (g->slots = 16; g->slots < 2 * count; g->slots *= 2)
		;
	g->end = mem_alloc(2 * count, sizeof *g->end, "edges", e);
	g->next = mem_alloc(2 * count, sizeof *g->next, "edges", e);
	g->sum = mem_zalloc(count, sizeof *g->sum, "edges", e);
	g->count = mem_zalloc(count, sizeof *g->count, "edges", e);
	g->key = mem_alloc(count, sizeof *g->key, "edges", e);
	g->first = mem_alloc((size_t)leaves, sizeof *g->first, "clusters", e);
	g->degree = mem_zalloc((size_t)leaves, sizeof *g->degree, "clusters", e);
	g->node = mem_alloc((size_t)leaves, sizeof *g->node, "clusters", e);
	g->table = mem_alloc(g->slots, sizeof *g->table, "edges", e);
	if (!g->end || !g->next || !g->sum || !g->count || !g->key || !g->first || !g->degree || !g->node ||
		!g->table)
		return -1;
	memset(g->table, 0xff, g->slots * sizeof *g->table);
	for (int32_t i = 0; i < leaves; i++) {
		g->first[i] = -1;
		g->node[i] = i;
	}
	add_edges(g, edges, count);
	return 0;
}

/* The edges of cluster `from` become those of `to`. */
static int move_edges(struct graph *g, const struct linkage *l, int32_t from, int32_t to, struct err *e)
{
	for (int32_t half = g->first[from], next; half >= 0; half = next) {
		const int32_t edge = half / 2, other = g->end[half ^ 1];
		next = g->next[half];
		if (!g->count[edge])
			continue;
		forget(g, from, other);
		const size_t at = find(g, to, other);
		const int32_t there = g->table[at];
		if (there < 0) {
			g->end[half] = to;
			g->table[at] = edge;
			hang(g, half);
			continue;
		}
		g->sum[there] += g->sum[edge];
		g->count[there] += g->count[edge];
		g->count[edge] = 0;
		g->degree[other]--;
		const double key = key_of(g, l, there);
		if (key < g->key[there] && put(g, there, key, e))
			return -1;
	}
	g->first[from] = -1;
	return 0;
}

static int join(struct graph *g, struct linkage *l, int32_t edge, struct err *e)
{
	int32_t from = g->end[2 * edge], to = g->end[2 * edge + 1];

	if (g->degree[from] > g->degree[to]) {
		from = to;
		to = g->end[2 * edge];
	}
	const int32_t a = g->node[from], b = g->node[to], made = l->nodes++;
	forget(g, from, to);
	g->count[edge] = 0;
	g->degree[to]--;
	l->children[made - l->leaves][0] = a < b ? a : b;
	l->children[made - l->leaves][1] = a < b ? b : a;
	l->parent[a] = l->parent[b] = made;
	l->parent[made] = -1;
	l->size[made] = l->size[a] + l->size[b];
	g->node[to] = made;
	return move_edges(g, l, from, to, e);
}

static int join_all(struct graph *g, struct linkage *l, struct err *e)
{
	for (int32_t k = 0; k < g->edges; k++)
		if (put(g, k, key_of(g, l, k), e))
			return -1;
	while (g->waiting) {
		const struct waiting w = take(g);
		if (!g->count[w.edge] || w.key != g->key[w.edge])
			continue;
		const double now = key_of(g, l, w.edge);
		if (now > w.key ? put(g, w.edge, now, e) : join(g, l, w.edge, e))
			return -1;
	}
	return 0;
}

int linkage_make(struct linkage *l, int32_t leaves, const double *size, const struct linkage_edge *edges,
	size_t count, double power, struct err *e)
{
	const size_t most = 2 * (size_t)leaves;
	SCOPED_BY(graph_free) struct graph g = {.power = power};

	*l = (struct linkage){.leaves = leaves, .nodes = leaves};
	l->children = mem_alloc((size_t)leaves, sizeof *l->children, "clusters", e);
	l->parent = mem_alloc(most, sizeof *l->parent, "clusters", e);
	l->size = mem_alloc(most, sizeof *l->size, "clusters", e);
	int bad = !l->children || !l->parent || !l->size;
	for (int32_t i = 0; i < leaves && !bad; i++) {
		l->parent[i] = -1;
		l->size[i] = size[i];
	}
	bad = bad || graph_make(&g, leaves, edges, count, e) || join_all(&g, l, e);
	return bad ? -1 : 0;
}

int linkage_order(const struct linkage *l, int32_t *place, struct err *e)
{
	SCOPED int32_t *count = mem_alloc((size_t)l->nodes, sizeof *count, "clusters", e);
	int32_t before = 0;

	if (!count)
		return -1;
	for (int32_t i = 0; i < l->nodes; i++) {
		const int32_t *c = i < l->leaves ? NULL : l->children[i - l->leaves];
		count[i] = c ? count[c[0]] + count[c[1]] : 1;
	}
	for (int32_t i = l->nodes - 1; i >= 0; i--) {
		if (l->parent[i] < 0) {
			place[i] = before;
			before += count[i];
		}
		if (i < l->leaves)
			continue;
		const int32_t *c = l->children[i - l->leaves];
		place[c[0]] = place[i];
		place[c[1]] = place[i] + count[c[0]];
	}
	return 0;
}

int32_t linkage_cut(
	const struct linkage *l, const int32_t *place, int32_t clusters, int32_t *cluster, struct err *e)
{
	const int32_t merges = l->leaves - clusters;
	const int32_t limit = merges > 0 ? l->leaves + merges : l->leaves;
	SCOPED int32_t *number = mem_zalloc((size_t)l->leaves + 1, sizeof *number, "clusters", e);

	if (!number)
		return -1;
	for (int32_t i = 0; i < l->nodes && i < limit; i++)
		if (l->parent[i] < 0 || l->parent[i] >= limit)
			number[place[i] + 1] = 1;
	for (int32_t i = 0; i < l->leaves; i++)
		number[i + 1] += number[i];
	for (int32_t i = 0; i < l->leaves; i++)
		cluster[i] = number[place[i] + 1] - 1;
	return number[l->leaves];
}
