#include "cmd/run/object_extents.h"

#include "base/mem.h"
#include "geom/up.h"

#include <stdlib.h>

static int find_one(
	struct extent *to, const struct lifted *l, size_t object, const struct splats *s, const double up[3])
{
	const size_t first = (size_t)l->indptr[object], n = (size_t)l->indptr[object + 1] - first;
	struct err ignored;
	SCOPED int32_t *ids = mem_alloc(n, sizeof *ids, "object", &ignored);
	SCOPED float *responses = mem_alloc(n, sizeof *responses, "object", &ignored);
	size_t count = 0;

	for (size_t i = 0; i < n && ids && responses; i++) {
		const float response = l->share[first + i] - LIFTED_CUT;
		if (!(response > 0))
			continue;
		ids[count] = l->index[first + i];
		responses[count++] = response;
	}
	return !ids || !responses || extent_find(to, s, ids, responses, count, up, &ignored);
}

struct extent *object_extents(
	const struct lifted *l, const struct splats *s, const struct cameras *c, struct err *e)
{
	struct extent *extents = mem_zalloc(l->objects, sizeof *extents, "objects", e);
	double up[3];
	int bad = 0;

	if (!extents)
		return NULL;
	cameras_up(c, up);
#pragma omp parallel for schedule(dynamic) reduction(| : bad)
	for (size_t o = 0; o < l->objects; o++)
		bad |= find_one(&extents[o], l, o, s, up) != 0;
	if (!bad)
		return extents;
	object_extents_free(extents, l->objects);
	err_set(e, ERR_SYSTEM, "objects: out of memory");
	return NULL;
}

static void move(struct box *b, const double by[3])
{
	for (int k = 0; k < 3; k++)
		b->centre[k] += by[k];
}

struct box_record object_extents_record(const struct extent *x, const double offset[3], double sure)
{
	struct box_record record = {
		.score = x->n ? sure : 0, .is_empty = !x->n, .aligned = x->aligned, .turned = x->turned};

	move(&record.aligned, offset);
	move(&record.turned, offset);
	return record;
}

void object_extents_free(struct extent *extents, size_t objects)
{
	for (size_t o = 0; extents && o < objects; o++)
		extent_free(&extents[o]);
	free(extents);
}
