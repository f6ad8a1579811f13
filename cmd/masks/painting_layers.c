/* Outlines that a person drew go on beneath what lies on the thing: the smaller of two is on top, and the
 * larger does not have its pixels. Two names of one thing, and a named part, overlap. */
#include "cmd/masks/painting.h"

#include "base/mem.h"

#include <math.h>
#include <strings.h>

/* An outline that covers more than this share of a larger one is of the same thing under another name. */
static const double same_share = 0.8;

struct layer {
	struct annotation *of;
	size_t area;
	struct rle left; /* without what is on top; no runs while nothing is */
};

/* By view and by size of the picture, then from the smallest on; the order of the file does not count. */
static int order_layers(const void *a, const void *b)
{
	const struct layer *p = a, *q = b;
	const struct rle *m = &p->of->mask, *n = &q->of->mask;
	const int order = strcmp(p->of->view, q->of->view);

	if (order)
		return order;
	if (!rle_same_size(m, n))
		return m->height != n->height ? (m->height > n->height) - (m->height < n->height)
					      : (m->width > n->width) - (m->width < n->width);
	if (p->area != q->area)
		return p->area < q->area ? -1 : 1;
	return strcmp(p->of->name, q->of->name);
}

/* Whether a name ends in whole words so. */
static int ends_in(const char *name, const char *words)
{
	const size_t n = strlen(name), m = strlen(words);

	return m && n >= m && !strcasecmp(name + n - m, words) && (n == m || name[n - m - 1] == ' ');
}

/* "handle of the cup" and "cup's handle" are parts of "cup", and of "red cup". */
static int is_part(const char *name, const char *whole)
{
	const size_t n = strlen(whole);
	const char *of = strstr(name, " of ");

	if (!strncasecmp(name, whole, n) && !strncasecmp(name + n, "'s ", 3))
		return 1;
	if (!of)
		return 0;
	of += strncmp(of, " of the ", 8) ? 4 : 8;
	return ends_in(of, whole) || ends_in(whole, of);
}

static int put_under(struct layer *under, const struct layer *top, struct err *e)
{
	const struct rle *now = under->left.runs ? &under->left : &under->of->mask;
	const size_t both = rle_intersection(&top->of->mask, &under->of->mask);
	struct rle left;

	if (!both || (double)both > same_share * (double)under->area ||
		is_part(top->of->name, under->of->name))
		return 0;
	if (rle_without(&left, now, &top->of->mask, e))
		return -1;
	rle_free(&under->left);
	under->left = left;
	return 0;
}

int painting_layers(struct annotations *a, struct err *e)
{
	SCOPED struct layer *layers = mem_zalloc(a->n, sizeof *layers, "labels", e);
	size_t n = 0;
	int bad = !layers;

	for (size_t i = 0; i < a->n && layers && a->is_layered; i++)
		if (isnan(a->items[i].score) && a->items[i].is_outline)
			layers[n++] = (struct layer){&a->items[i], rle_area(&a->items[i].mask), {0}};
	if (n)
		qsort(layers, n, sizeof *layers, order_layers);
	for (size_t top = 0; top < n; top++)
		for (size_t under = top + 1; under < n && !bad; under++) {
			const struct annotation *p = layers[top].of, *q = layers[under].of;
			if (strcmp(p->view, q->view) || !rle_same_size(&p->mask, &q->mask))
				break;
			bad = put_under(&layers[under], &layers[top], e);
		}
	for (size_t i = 0; i < n; i++) {
		if (!layers[i].left.runs)
			continue;
		rle_free(&layers[i].of->mask);
		layers[i].of->mask = layers[i].left;
	}
	return bad ? -1 : 0;
}
