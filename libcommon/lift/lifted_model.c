#include "lift/lifted_model.h"

#include "base/mem.h"

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
