/* Objects that are regions of pseudomask-propose: the model that ask/name_regions.h needs, with the regions
 * as objects after the named ones, and the one that comes of it. */
#include "ask/name_regions.h"
#include "base/mem.h"
#include "cmd/lift/lifting.h"

#include <math.h>

#define REGION_CUT 0.5f /* a pixel is of a region that has more than half of it */

/* Room for a model of `objects`, of which each Gaussian is in at most so many. */
static int begin_model(struct lifting *l, size_t objects, size_t shares, struct err *e)
{
	struct lifted *m = &l->model;

	mem_free_all(m->confidence, m->indptr, m->index, m->share, m->cut);
	m->gaussians = l->scene.splats.n;
	m->objects = objects;
	m->confidence = mem_zalloc(objects, sizeof *m->confidence, "objects", e);
	m->cut = mem_alloc(objects, sizeof *m->cut, "objects", e);
	m->indptr = mem_zalloc(objects + 1, sizeof *m->indptr, "objects", e);
	m->index = mem_alloc(shares, sizeof *m->index, "objects", e);
	m->share = mem_alloc(shares, sizeof *m->share, "objects", e);
	if (!m->confidence || !m->cut || !m->indptr || !m->index || !m->share)
		return -1;
	for (size_t o = 0; o < objects; o++)
		m->cut[o] = REGION_CUT;
	return 0;
}

static void add_gaussian(struct lifted *m, size_t object, size_t gaussian)
{
	m->index[m->indptr[object + 1]] = (int32_t)gaussian;
	m->share[m->indptr[object + 1]++] = 1;
}

/* The named objects without Gaussians, and then each region with its own. */
static int show_regions(struct lifting *l, struct err *e)
{
	const struct regions_file *r = &l->regions;
	const struct region_tree *t = &r->tree;
	const size_t n = l->scene.splats.n;
	size_t shares = 0;

	for (size_t k = 0; k < r->chosen_count; k++) {
		l->names[l->objects + k] = "";
		for (size_t i = 0; i < n; i++)
			shares += (size_t)region_tree_has(t, r->chosen[k], t->node[i]);
	}
	if (begin_model(l, l->objects + r->chosen_count, shares, e))
		return -1;
	for (size_t k = 0; k < r->chosen_count; k++) {
		const size_t o = l->objects + k;
		l->model.indptr[o + 1] = l->model.indptr[o];
		l->model.confidence[o] = fminf(r->score[r->chosen[k]], 1);
		for (size_t i = 0; i < n; i++)
			if (region_tree_has(t, r->chosen[k], t->node[i]))
				add_gaussian(&l->model, o, i);
	}
	return lifting_add_sentences(l, e);
}

/* agree (count,count): intersection over union, by Gaussians. */
static void find_agreement(const struct lifting *l, float *agree)
{
	const struct regions_file *r = &l->regions;
	const size_t count = r->chosen_count;
	const int64_t *indptr = l->model.indptr + l->objects;

	for (size_t i = 0; i < count * count; i++) {
		const size_t a = i / count, b = i % count;
		const double in_a = (double)(indptr[a + 1] - indptr[a]),
			     in_b = (double)(indptr[b + 1] - indptr[b]);
		const int is_nested = region_tree_has(&r->tree, r->chosen[a], r->chosen[b]) ||
				      region_tree_has(&r->tree, r->chosen[b], r->chosen[a]);
		agree[i] = is_nested ? (float)(fmin(in_a, in_b) / fmax(in_a, in_b)) : 0;
	}
}

/* Each Gaussian is of the object with the smallest region that has it: a mouse is no part of its mat. */
static int take_regions(struct lifting *l, const size_t *region, const double *probability, struct err *e)
{
	const struct regions_file *r = &l->regions;
	const size_t n = l->scene.splats.n;
	SCOPED size_t *owner = mem_alloc((size_t)r->tree.n, sizeof *owner, "regions", e);
	const size_t named = l->objects;

	lifted_cut(&l->model, named);
	if (!owner || begin_model(l, named, n, e))
		return -1;
	for (int32_t k = 0; k < r->tree.n; k++) {
		owner[k] = r->tree.parent[k] < 0 ? named : owner[r->tree.parent[k]];
		for (size_t o = 0; o < named; o++)
			if (region[o] != REGION_NONE && r->chosen[region[o]] == k)
				owner[k] = o;
	}
	for (size_t o = 0; o < named; o++) {
		l->model.indptr[o + 1] = l->model.indptr[o];
		l->model.confidence[o] = (float)probability[o];
		for (size_t i = 0; i < n; i++)
			if (r->tree.node[i] >= 0 && owner[r->tree.node[i]] == o)
				add_gaussian(&l->model, o, i);
	}
	return 0;
}

int lifting_name(struct lifting *l, const struct report *to, struct err *e)
{
	const struct parser parser = {.weights = &l->weights, .encoder = l->text.encoder.hex};
	const struct regions_file *r = &l->regions;
	const size_t count = r->chosen_count;
	SCOPED float *score = mem_alloc(count, sizeof *score, "regions", e);
	SCOPED float *agree = mem_alloc(count, count * sizeof *agree, "regions", e);
	SCOPED size_t *region = mem_alloc(l->objects, sizeof *region, "objects", e);
	SCOPED double *probability = mem_alloc(l->objects, sizeof *probability, "objects", e);

	if (!score || !agree || !region || !probability || show_regions(l, e))
		return -1;
	find_agreement(l, agree);
	for (size_t k = 0; k < count; k++)
		score[k] = r->score[r->chosen[k]];
	const struct region_facts facts = {count, score, agree, r->class_count, r->classes, r->votes};
	if (name_regions(&l->model, l->objects, &facts, &l->scene.splats, &l->scene.cameras, &parser, region,
		    probability, e))
		return -1;
	for (size_t o = 0; o < l->objects; o++)
		if (region[o] == REGION_NONE)
			report_warn(to, "%s: no region is left for '%s'", l->files->regions, l->names[o]);
		else
			report_note(to, 1, "'%s' is region-%zu by %.2f", l->names[o], region[o] + 1,
				probability[o]);
	return take_regions(l, region, probability, e);
}
