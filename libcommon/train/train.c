#include "train/train.h"

#include "base/compare.h"
#include "base/mem.h"
#include "base/rng.h"
#include "nn/adam.h"

#include <math.h>

/* Streams of random numbers, one a purpose. */
enum { STREAM_INIT = 1, STREAM_GROUPS = 2, STREAM_OTHERS = 4, STREAM_VIEWS = 1000 };

int train_active_set(const double *weight, size_t scene_gaussians, double tolerance, int32_t *ids, size_t *n,
	struct err *e)
{
	SCOPED struct ranked *total = mem_alloc(scene_gaussians, sizeof *total, "active set", e);
	SCOPED unsigned char *dropped = mem_zalloc(scene_gaussians, 1, "active set", e);
	double all = 0, left_out = 0;

	if (!total || !dropped)
		return -1;
	for (size_t i = 0; i < scene_gaussians; i++) {
		total[i] = (struct ranked){weight[i], i};
		all += weight[i];
	}
	qsort(total, scene_gaussians, sizeof *total, ranked_rising);
	for (size_t i = 0; i < scene_gaussians && left_out + total[i].by <= tolerance * all; i++) {
		left_out += total[i].by;
		dropped[total[i].at] = 1;
	}
	*n = 0;
	for (size_t i = 0; i < scene_gaussians; i++)
		if (!dropped[i])
			ids[(*n)++] = (int32_t)i;
	return 0;
}

int train_bounds(
	const float *means, const int32_t *ids, size_t n, double low[3], double high[3], struct err *e)
{
	SCOPED float *axis = mem_alloc(n, sizeof *axis, "bounds", e);

	if (!axis)
		return -1;
	for (int k = 0; k < 3; k++) {
		for (size_t i = 0; i < n; i++)
			axis[i] = means[3 * (size_t)ids[i] + (size_t)k];
		qsort(axis, n, sizeof *axis, compare_float);
		low[k] = n ? (double)axis[n / 100] : 0;
		high[k] = n ? (double)axis[n - 1 - n / 100] : 0;
		if (!(high[k] > low[k])) {
			low[k] -= 1;
			high[k] += 1;
		}
	}
	return 0;
}

int train_order_init(struct train_order *o, const struct train_view *views, size_t view_count, int batch,
	const struct train_contrast *contrast, uint64_t seed, struct err *e)
{
	const size_t own = (size_t)batch * TRAIN_POSITIVES;
	size_t pairs = 0, groups = 0;

	*o = (struct train_order){.views = views,
		.view_count = view_count,
		.batch = batch,
		.seed = seed,
		.contrast = *contrast,
		.epoch = -1};
	for (size_t v = 0; v < view_count; v++) {
		pairs += (size_t)views[v].count;
		groups += ((size_t)views[v].count + (size_t)batch - 1) / (size_t)batch;
	}
	o->groups = (uint32_t)groups;
	o->order = mem_alloc(groups, 3 * sizeof *o->order, "order", e);
	o->shuffled = mem_alloc(pairs + view_count + 1, sizeof *o->shuffled, "order", e);
	if (contrast->negatives >= contrast->sentences)
		o->contrast.negatives = 0;
	o->others = mem_alloc(own + contrast->sentences, sizeof *o->others, "order", e);
	if (!o->order || !o->shuffled || !o->others)
		return -1;
	o->view = o->order + groups;
	o->first = o->view + groups;
	o->start = o->shuffled + pairs;
	uint32_t g = 0;
	o->start[0] = 0;
	for (size_t v = 0; v < view_count; v++) {
		for (int k = 0; k < views[v].count; k += batch) {
			o->view[g] = (uint32_t)v;
			o->first[g++] = (uint32_t)k;
		}
		o->start[v + 1] = o->start[v] + (uint32_t)views[v].count;
	}
	return 0;
}

void train_order_free(struct train_order *o)
{
	mem_free_all(o->order, o->shuffled, o->others);
	*o = (struct train_order){0};
}

static void shuffle_epoch(struct train_order *o, long epoch)
{
	struct rng r;

	for (size_t v = 0; v < o->view_count; v++) {
		uint32_t *list = o->shuffled + o->start[v];
		for (int k = 0; k < o->views[v].count; k++)
			list[k] = (uint32_t)k;
		rng_seed(&r, o->seed + ((uint64_t)epoch << 32), STREAM_VIEWS + v);
		rng_shuffle(&r, list, (uint32_t)o->views[v].count);
	}
	for (uint32_t g = 0; g < o->groups; g++)
		o->order[g] = g;
	rng_seed(&r, o->seed + ((uint64_t)epoch << 32), STREAM_GROUPS);
	rng_shuffle(&r, o->order, o->groups);
	o->epoch = epoch;
}

size_t train_order_at(struct train_order *o, long iteration, uint32_t *picks, int *count)
{
	const long epoch = iteration / (long)o->groups;

	if (epoch != o->epoch)
		shuffle_epoch(o, epoch);
	const uint32_t group = o->order[iteration % (long)o->groups], view = o->view[group];
	const int left = o->views[view].count - (int)o->first[group];
	*count = left < o->batch ? left : o->batch;
	for (int i = 0; i < *count; i++)
		picks[i] = o->shuffled[o->start[view] + o->first[group] + (uint32_t)i];
	return view;
}

/* Of one of its own iterations, in the epoch that `order` holds. */
static size_t view_at(const struct train_order *o, long iteration)
{
	return o->view[o->order[iteration % (long)o->groups]];
}

size_t train_order_view(struct train_order *o, long iteration)
{
	const long own = iteration - o->begin, epoch = own / (long)o->groups;

	if (epoch != o->epoch)
		shuffle_epoch(o, epoch);
	return view_at(o, own);
}

size_t train_order_next(struct train_order *o, long iteration)
{
	const long next = iteration - o->begin + 1;

	return next / (long)o->groups == o->epoch ? view_at(o, next) : SIZE_MAX;
}

/* Up to TRAIN_POSITIVES of the sentences of an object, drawn evenly, before `end`. Returns how many. */
static size_t draw_own(const struct train_contrast *c, int object, struct rng *r, size_t *end)
{
	size_t seen = 0;

	for (size_t k = 0; k < c->sentences; k++) {
		if (c->objects[k] != object)
			continue;
		const size_t at = seen < TRAIN_POSITIVES ? seen : rng_below(r, (uint32_t)seen + 1);
		if (at < TRAIN_POSITIVES)
			end[-1 - (ptrdiff_t)at] = k;
		seen++;
	}
	return seen < TRAIN_POSITIVES ? seen : TRAIN_POSITIVES;
}

struct step_others train_order_others(
	struct train_order *o, long iteration, const struct step_target *targets, int count)
{
	const struct train_contrast *c = &o->contrast;
	size_t *list = o->others + (size_t)o->batch * TRAIN_POSITIVES, own = 0;
	struct rng r;

	if (!c->negatives)
		return (struct step_others){0};
	for (size_t k = 0; k < c->sentences; k++)
		list[k] = k;
	rng_seed(&r, o->seed + ((uint64_t)iteration << 32), STREAM_OTHERS);
	for (size_t k = 0; k < c->negatives; k++) {
		const size_t from = k + rng_below(&r, (uint32_t)(c->sentences - k)), taken = list[from];
		list[from] = list[k];
		list[k] = taken;
	}
	for (int i = 0; i < count; i++) {
		const int object = c->objects[targets[i].sentence];
		int is_drawn = 0;
		for (int k = 0; k < i; k++)
			is_drawn |= c->objects[targets[k].sentence] == object;
		own += is_drawn ? 0 : draw_own(c, object, &r, list - own);
	}
	return (struct step_others){list - own, own + c->negatives};
}

int train_state_init(
	struct train_state *t, const struct refer_layout *l, size_t gaussians, uint64_t seed, struct err *e)
{
	struct rng r;

	*t = (struct train_state){.parameters = (l->count + 15) / 16 * 16};
	t->count = t->parameters + panels_padded(gaussians) * (size_t)l->feature_width;
	t->values = mem_zalloc(t->count, 4 * sizeof(float), "training state", e);
	if (!t->values)
		return -1;
	t->gradient = t->values + t->count;
	t->m = t->gradient + t->count;
	t->v = t->m + t->count;
	rng_seed(&r, seed, STREAM_INIT);
	refer_init(l, t->values, &r);
	return 0;
}

void train_state_free(struct train_state *t)
{
	free(t->values);
	*t = (struct train_state){0};
}

float *train_state_x(const struct train_state *t)
{
	return t->values + t->parameters;
}

void train_adam(struct train_state *t, const struct train_rates *rates)
{
	t->iteration++;
	adam_step(t->values, t->gradient, t->m, t->v, t->parameters, rates->mlps, 0.9, 0.999, 1e-15,
		t->iteration);
	adam_step(train_state_x(t), t->gradient + t->parameters, t->m + t->parameters, t->v + t->parameters,
		t->count - t->parameters, rates->features, 0.9, 0.999, 1e-15, t->iteration);
}

struct step_losses train_step(struct train_state *t, struct step *s, struct train_order *o,
	const struct train_rates *rates, const struct view_weights *weights)
{
	uint32_t picks[BLOCK_WORDS];
	struct step_target targets[BLOCK_WORDS];
	int count;
	const struct train_view *view = &o->views[train_order_at(o, t->iteration - o->begin, picks, &count)];

	for (int i = 0; i < count; i++)
		targets[i] = (struct step_target){(size_t)view->sentences[picks[i]], view->masks[picks[i]]};
	const struct step_others others = train_order_others(o, t->iteration, targets, count);
	struct step_losses losses = step_run(s, t->values, train_state_x(t), weights, targets, count,
		contrast_top_count(t->iteration, step_gaussians(s)), others.list ? &others : NULL,
		t->gradient, t->gradient + t->parameters);
	t->sum.bce += losses.bce;
	t->sum.contrast += losses.contrast;
	t->sum.total += losses.total;
	if (isfinite(losses.total))
		train_adam(t, rates);
	else
		t->iteration++;
	return losses;
}
