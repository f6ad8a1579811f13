#include "lift/lift_labels.h"

#include "base/mem.h"

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
