#include "lift/lifted_model.h"

#include "base/hash.h"
#include "base/mem.h"
#include "base/names.h"

#include <stdlib.h>

void lifted_free(struct lifted *l)
{
	mem_free_strings(l->names, l->objects);
	mem_free_strings(l->texts, l->sentences);
	mem_free_strings(l->pieces, l->sentences);
	mem_free_all(l->confidence, l->indptr, l->index, l->share, l->object, l->offsets, l->words, l->middle,
		l->cut);
	*l = (struct lifted){0};
}

const float *lifted_middle(const struct lifted *l, size_t sentence)
{
	return l->middle ? l->middle + (size_t)l->offsets[sentence] * (size_t)l->width : NULL;
}

void lifted_cut(struct lifted *l, size_t objects)
{
	for (; l->objects > objects; l->objects--)
		free(l->names[l->objects - 1]);
}

float lifted_cut_of(const struct lifted *l, size_t object)
{
	return l->cut ? l->cut[object] : LIFTED_CUT;
}

void lifted_responses(const struct lifted *l, size_t object, float *responses)
{
	const float cut = lifted_cut_of(l, object);

	for (size_t i = 0; i < l->gaussians; i++)
		responses[i] = -cut;
	for (int64_t k = l->indptr[object]; k < l->indptr[object + 1]; k++)
		responses[l->index[k]] = l->share[k] - cut;
}

static int find_extent(struct extent *to, const struct lifted *l, size_t object, const struct splats *s,
	const double up[3], struct err *e)
{
	const size_t first = (size_t)l->indptr[object], n = (size_t)l->indptr[object + 1] - first;
	SCOPED int32_t *ids = mem_alloc(n, sizeof *ids, "object", e);
	SCOPED float *responses = mem_alloc(n, sizeof *responses, "object", e);
	size_t count = 0;

	for (size_t i = 0; i < n && ids && responses; i++) {
		const float response = l->share[first + i] - lifted_cut_of(l, object);
		if (!(response > 0) || !(extent_part(s, (size_t)l->index[first + i]) > 0))
			continue;
		ids[count] = l->index[first + i];
		responses[count++] = response;
	}
	return !ids || !responses || extent_find(to, s, ids, responses, count, up, e);
}

/* What changes of an object's Gaussians, as one number. */
static uint64_t pose_of(const struct lifted *l, size_t object, const struct splats *s)
{
	uint64_t pose = 0;

	for (int64_t k = l->indptr[object]; k < l->indptr[object + 1]; k++) {
		const size_t i = (size_t)l->index[k];
		pose = hash64(s->means + 3 * i, 3 * sizeof *s->means, pose);
		pose = hash64(s->quats + 4 * i, 4 * sizeof *s->quats, pose);
		pose = hash64(s->scales + 3 * i, 3 * sizeof *s->scales, pose);
	}
	return pose;
}

int lifted_extents_again(struct extent *extents, uint64_t *poses, const struct lifted *l,
	const struct splats *s, const double up[3], struct err *e)
{
	int bad = 0;

#pragma omp parallel for schedule(dynamic) reduction(| : bad)
	for (size_t o = 0; o < l->objects; o++) {
		const uint64_t pose = poses ? pose_of(l, o, s) : 0;
		struct err ignored;
		if (poses && pose == poses[o])
			continue;
		extent_free(&extents[o]);
		bad |= find_extent(&extents[o], l, o, s, up, &ignored) != 0;
		if (poses)
			poses[o] = pose;
	}
	return bad ? err_set(e, ERR_SYSTEM, "objects: out of memory") : 0;
}

int lifted_extents(struct extent **extents, const struct lifted *l, const struct splats *s,
	const double up[3], struct err *e)
{
	*extents = mem_zalloc(l->objects, sizeof **extents, "objects", e);
	if (*extents && !lifted_extents_again(*extents, NULL, l, s, up, e))
		return 0;
	lifted_extents_free(*extents, l->objects);
	*extents = NULL;
	return -1;
}

void lifted_extents_free(struct extent *extents, size_t objects)
{
	for (size_t o = 0; extents && o < objects; o++)
		extent_free(&extents[o]);
	free(extents);
}

/* Room for all of both; counts are still 0. */
static int make_room(struct lifted *l, const struct lifted *a, const struct lifted *b, struct err *e)
{
	const size_t objects = a->objects + b->objects, sentences = a->sentences + b->sentences;
	const size_t shares = (size_t)(a->indptr[a->objects] + b->indptr[b->objects]);
	const size_t words = (size_t)(a->offsets[a->sentences] + b->offsets[b->sentences]),
		     width = (size_t)b->width;

	*l = (struct lifted){.gaussians = b->gaussians, .width = b->width};
	l->names = mem_zalloc(objects, sizeof *l->names, "objects", e);
	l->confidence = mem_alloc(objects, sizeof *l->confidence, "objects", e);
	l->cut = mem_alloc(objects, sizeof *l->cut, "objects", e);
	l->indptr = mem_zalloc(objects + 1, sizeof *l->indptr, "objects", e);
	l->index = mem_alloc(shares, sizeof *l->index, "objects", e);
	l->share = mem_alloc(shares, sizeof *l->share, "objects", e);
	l->object = mem_alloc(sentences, sizeof *l->object, "sentences", e);
	l->texts = mem_zalloc(sentences, sizeof *l->texts, "sentences", e);
	l->pieces = mem_zalloc(sentences, sizeof *l->pieces, "sentences", e);
	l->offsets = mem_zalloc(sentences + 1, sizeof *l->offsets, "sentences", e);
	l->words = mem_alloc(words, width * sizeof *l->words, "words", e);
	const int has_middle = a->middle && b->middle;
	l->middle = has_middle ? mem_alloc(words, width * sizeof *l->middle, "words", e) : NULL;
	return l->names && l->confidence && l->cut && l->indptr && l->index && l->share && l->object &&
			       l->texts && l->pieces && l->offsets && l->words && !l->middle == !has_middle
		       ? 0
		       : -1;
}

static int copy_object(struct lifted *to, const struct lifted *from, size_t o, struct err *e)
{
	const size_t at = to->objects, n = (size_t)(from->indptr[o + 1] - from->indptr[o]),
		     first = (size_t)to->indptr[at];

	if (!(to->names[at] = mem_strdup(from->names[o], e)))
		return -1;
	to->confidence[at] = from->confidence[o];
	to->cut[at] = lifted_cut_of(from, o);
	memcpy(to->index + first, from->index + from->indptr[o], n * sizeof *to->index);
	memcpy(to->share + first, from->share + from->indptr[o], n * sizeof *to->share);
	to->indptr[at + 1] = (int64_t)(first + n);
	to->objects++;
	return 0;
}

static int copy_sentence(
	struct lifted *to, const struct lifted *from, size_t r, int32_t object, struct err *e)
{
	const size_t at = to->sentences++, width = (size_t)to->width, first = (size_t)to->offsets[at] * width;
	const size_t n = (size_t)(from->offsets[r + 1] - from->offsets[r]);

	to->object[at] = object;
	to->offsets[at + 1] = to->offsets[at] + (int64_t)n;
	memcpy(to->words + first, from->words + (size_t)from->offsets[r] * width,
		n * width * sizeof *to->words);
	if (to->middle)
		memcpy(to->middle + first, lifted_middle(from, r), n * width * sizeof *to->middle);
	to->texts[at] = mem_strdup(from->texts[r], e);
	to->pieces[at] = mem_strdup(from->pieces[r], e);
	return to->texts[at] && to->pieces[at] ? 0 : -1;
}

/* The objects of `from`, but for those that have one of these names, and their sentences. */
static int copy_all(struct lifted *to, const struct lifted *from, const struct names *but, struct err *e)
{
	SCOPED int32_t *place = mem_alloc(from->objects, sizeof *place, "objects", e);

	for (size_t o = 0; o < from->objects && place; o++) {
		const int is_out = but && names_find(but, from->names[o]) != NAMES_NONE;
		place[o] = is_out ? -1 : (int32_t)to->objects;
		if (!is_out && copy_object(to, from, o, e))
			return -1;
	}
	for (size_t r = 0; r < from->sentences && place; r++)
		if (place[from->object[r]] >= 0 && copy_sentence(to, from, r, place[from->object[r]], e))
			return -1;
	return place ? 0 : -1;
}

int lifted_add(struct lifted *to, const struct lifted *more, struct err *e)
{
	SCOPED_BY(lifted_free) struct lifted all = {0};
	SCOPED_BY(names_free) struct names names = {0};

	if (make_room(&all, to, more, e) ||
		names_make(&names, more->names, sizeof *more->names, 0, more->objects, e) ||
		copy_all(&all, to, &names, e) || copy_all(&all, more, NULL, e))
		return -1;
	const struct lifted before = *to;
	*to = all;
	all = before;
	return 0;
}
