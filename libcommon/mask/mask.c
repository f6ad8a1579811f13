#include "mask/mask.h"

#include "base/mem.h"

#include <math.h>
#include <stdio.h>

double mask_confidence(const struct mask *m)
{
	return isnan(m->score) ? 1 : m->score;
}

const char *mask_object(const struct mask *m)
{
	return m->object ? m->object : m->ref;
}

int mask_check_shape(
	const char *view, const struct rle *rle, const char *of, int height, int width, struct err *e)
{
	char before[512];

	if (!rle_check_shape("a mask", rle->height, rle->width, of, height, width, e))
		return 0;
	snprintf(before, sizeof before, "view '%.300s'", view);
	return err_prefix(e, before);
}

static int order_names(const char *a, const char *b)
{
	return strcmp(a ? a : "", b ? b : "");
}

int mask_order(const struct mask *a, const struct mask *b)
{
	const struct rle *p = &a->rle, *q = &b->rle;
	int order = order_names(mask_object(a), mask_object(b));

	if (!order)
		order = order_names(a->ref, b->ref);
	if (!order)
		order = (p->n > q->n) - (p->n < q->n);
	return order || !p->n ? order : memcmp(p->runs, q->runs, p->n * sizeof *p->runs);
}

int mask_copy(struct mask *to, const struct mask *from, const char *ref, const char *object, struct err *e)
{
	const struct rle *r = &from->rle;

	*to = (struct mask){.view = mem_strdup(from->view, e),
		.ref = ref ? mem_strdup(ref, e) : NULL,
		.object = object ? mem_strdup(object, e) : NULL,
		.score = from->score,
		.visible = NAN};
	if (to->view && !ref == !to->ref && !object == !to->object &&
		!rle_from_runs(&to->rle, r->runs, r->n, r->height, r->width, e))
		return 0;
	mask_free(to);
	return -1;
}

void mask_free(struct mask *m)
{
	mem_free_all((char *)m->view, (char *)m->ref, (char *)m->object);
	rle_free(&m->rle);
	mask_place_free(m->place);
	*m = (struct mask){0};
}

int masks_add(struct masks *to, struct mask *m, struct err *e)
{
	if (mem_grow((void **)&to->items, &to->capacity, to->n + 1, sizeof *to->items, "masks", e)) {
		mask_free(m);
		return -1;
	}
	to->items[to->n++] = *m;
	return 0;
}

void masks_free(struct masks *masks)
{
	for (size_t i = 0; i < masks->n; i++)
		mask_free(&masks->items[i]);
	free(masks->items);
	*masks = (struct masks){0};
}
