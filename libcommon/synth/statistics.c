#include "synth/statistics.h"

#include "base/compare.h"
#include "base/mem.h"

#include <math.h>

const char *const synth_bands[SYNTH_BANDS] = {"0", "<0.15", "0.15-0.5", "0.5-0.85", ">=0.85"};

static void count_objects(struct synth_statistics *s, const struct synth_object *objects, int n)
{
	s->objects = n;
	for (int i = 0; i < n; i++) {
		int earlier = 0, later = 0;
		for (int j = 0; j < n; j++)
			if (j != i && synth_look_alike(&objects[i], &objects[j]))
				*(j < i ? &earlier : &later) += 1;
		s->alike += earlier + later > 0;
		s->alike_groups += !earlier && later;
		s->stacked += objects[i].on >= 0;
	}
}

double synth_statistics_share(const struct synth_sentences *sentences, const struct synth_row *relation)
{
	int n = 0;

	for (size_t i = 0; i < sentences->n; i++) {
		int has = 0;
		for (int k = 0; k < sentences->items[i].clause_count; k++)
			has |= sentences->items[i].clauses[k].kind == relation;
		n += has;
	}
	return (double)n / (double)sentences->n;
}

/* Sorts the values. */
static void take_quantiles(float *values, size_t n, double quantiles[SYNTH_QUANTILES])
{
	static const double at[SYNTH_QUANTILES] = {0.05, 0.25, 0.5, 0.75, 0.95};

	qsort(values, n, sizeof *values, compare_float);
	for (int k = 0; k < SYNTH_QUANTILES; k++)
		quantiles[k] = (double)values[(size_t)(at[k] * (double)(n - 1) + 0.5)];
}

static int measure_gaussians(struct synth_statistics *s, const struct splats *p, struct err *e)
{
	SCOPED float *values = mem_alloc(p->n, sizeof *values, "statistics", e);

	if (!values)
		return -1;
	s->gaussians = p->n;
	memcpy(values, p->opacities, p->n * sizeof *values);
	take_quantiles(values, p->n, s->opacity);
	for (int size = 0; size < 2; size++) {
		for (size_t i = 0; i < p->n; i++) {
			const float *scale = p->scales + 3 * i;
			float most = fmaxf(scale[0], fmaxf(scale[1], scale[2]));
			float least = fminf(scale[0], fminf(scale[1], scale[2]));
			values[i] = size ? most : most / least;
		}
		take_quantiles(values, p->n, size ? s->size : s->aspect);
	}
	return 0;
}

int synth_statistics_make(struct synth_statistics *s, const struct synth_scene *scene,
	const struct synth_sentences *sentences, struct err *e)
{
	*s = (struct synth_statistics){0};
	count_objects(s, scene->objects, scene->object_count);
	for (size_t i = 0; i < sentences->n; i++) {
		enum camera_split split = sentences->items[i].split;
		s->sentences[split]++;
		s->words[split] += synth_count_words(sentences->items[i].text);
	}
	for (int k = 0; k < SYNTH_SPLITS; k++)
		s->words[k] /= s->sentences[k] ? s->sentences[k] : 1;
	for (size_t i = 0; i < scene->cameras.n; i++)
		s->views[scene->cameras.views[i].split]++;
	return measure_gaussians(s, &scene->splats, e);
}

void synth_statistics_see(struct synth_statistics *s, enum camera_split split, size_t visible, size_t whole)
{
	static const double ends[SYNTH_BANDS - 2] = {0.15, 0.5, 0.85};
	struct synth_visibility *v = &s->visibility[split];
	double share = whole ? (double)visible / (double)whole : 0;
	int band = visible > 0;

	if (!whole) {
		v->outside++;
		return;
	}
	for (int i = 0; i < SYNTH_BANDS - 2; i++)
		band += share >= ends[i];
	v->pairs++;
	v->bands[band]++;
}
