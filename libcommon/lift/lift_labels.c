#include "lift/lift_labels.h"

#include "base/mem.h"

#include <math.h>

struct lift_vote {
	int64_t next;
	double weight;
	int32_t label;
};

int lift_labels_init(struct lift_labels *l, size_t gaussians, struct err *e)
{
	*l = (struct lift_labels){.gaussians = gaussians};
	l->first = mem_alloc(gaussians, sizeof *l->first, "labels", e);
	for (size_t i = 0; i < gaussians && l->first; i++)
		l->first[i] = -1;
	return l->first ? 0 : -1;
}

void lift_labels_free(struct lift_labels *l)
{
	mem_free_all(l->first, l->votes);
	*l = (struct lift_labels){0};
}

/* A Gaussian touches few labels: its votes are a list. */
static int vote(struct lift_labels *l, size_t gaussian, int32_t label, double weight, struct err *e)
{
	int64_t at = l->first[gaussian];

	while (at >= 0 && l->votes[at].label != label)
		at = l->votes[at].next;
	if (at < 0) {
		if (mem_grow((void **)&l->votes, &l->capacity, l->n + 1, sizeof *l->votes, "labels", e))
			return -1;
		at = (int64_t)l->n++;
		l->votes[at] = (struct lift_vote){l->first[gaussian], 0, label};
		l->first[gaussian] = at;
	}
	l->votes[at].weight += weight;
	return 0;
}

int lift_labels_add(
	struct lift_labels *l, const struct source_weights *s, const int32_t *label, struct err *e)
{
	for (size_t i = 0; i < l->gaussians; i++)
		for (int64_t k = s->indptr[i]; k < s->indptr[i + 1]; k++)
			if (s->weight[k] > 0 && vote(l, i, label[s->source[k]], (double)s->weight[k], e))
				return -1;
	return 0;
}

void lift_labels_end(const struct lift_labels *l, int32_t *label, float *reliability, float *weight)
{
	for (size_t i = 0; i < l->gaussians; i++) {
		double best = 0, sum = 0;
		label[i] = LABEL_NONE;
		for (int64_t at = l->first[i]; at >= 0; at = l->votes[at].next) {
			const struct lift_vote *v = &l->votes[at];
			sum += v->weight;
			if (v->weight < best || (v->weight <= best && v->label > label[i]))
				continue;
			best = v->weight;
			label[i] = v->label;
		}
		reliability[i] = sum > 0 ? (float)(best / sum) : 0;
		weight[i] = (float)sum;
	}
}

#define GOLDEN_SECTION 0.6180339887498949
static const double saturation = 0.75, value = 0.95;

/* Both lists rise; the extent's Gaussians are some of the object's. */
static void label_one(
	int32_t *labels, float *largest, const struct lifted *l, size_t object, const struct extent *x)
{
	int64_t k = l->indptr[object];

	for (size_t i = 0; i < x->n; i++) {
		const int32_t id = x->ids[i];
		while (l->index[k] < id)
			k++;
		if (l->share[k] <= largest[id])
			continue;
		largest[id] = l->share[k];
		labels[id] = (int32_t)object + 1;
	}
}

int labels_find(int32_t *labels, const struct lifted *l, const struct extent *extents, struct err *e)
{
	SCOPED float *largest = mem_zalloc(l->gaussians, sizeof *largest, "labels", e);

	if (!largest)
		return -1;
	for (size_t i = 0; i < l->gaussians; i++)
		labels[i] = 0;
	for (size_t o = 0; o < l->objects; o++)
		label_one(labels, largest, l, o, &extents[o]);
	return 0;
}

void labels_colour(int32_t label, uint8_t rgb[3])
{
	const double hue = fmod(label * GOLDEN_SECTION, 1);

	for (int c = 0; c < 3; c++) {
		const double k = fmod(5 - 2 * c + 6 * hue, 6);
		const double less = fmax(0, fmin(1, fmin(k, 4 - k)));
		rgb[c] = (uint8_t)lrint(255 * value * (1 - saturation * less));
	}
}
