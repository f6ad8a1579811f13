#include "synth/candidates.h"

#include "base/mem.h"
#include "synth/outline.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Below this many pixels an object is as good as hidden. */
enum { SMALLEST = 12 };

/* What one candidate shows. */
enum fault { FAULT_NONE, FAULT_OTHER, FAULT_PART, FAULT_UNION, FAULT_EMPTY, FAULT_MISSING, FAULTS };

/* How often a sentence of each habit has each fault, in percent. */
static const int fault_rates[SYNTH_HABITS][FAULTS] = {
	[SYNTH_HABIT_GOOD] = {72, 7, 8, 7, 1, 5},
	[SYNTH_HABIT_CONFUSED] = {14, 75, 3, 3, 1, 4},
	[SYNTH_HABIT_GUESSING] = {22, 68, 3, 3, 1, 3},
	[SYNTH_HABIT_PART] = {42, 8, 40, 4, 1, 5},
	[SYNTH_HABIT_UNION] = {42, 8, 4, 40, 1, 5},
};

static int likeness(const struct synth_object *a, const struct synth_object *b)
{
	return 2 * (a->shape == b->shape) + 2 * (a->colour == b->colour) + (a->size == b->size);
}

/* Most objects have a confused sentence, three in four a guessing one too: by rank rather than by lot,
 * so that few objects have their share of faults too. */
static void choose_habits(struct synth_detector *d, struct rng *r)
{
	static const enum synth_habit usual[10] = {SYNTH_HABIT_GOOD, SYNTH_HABIT_GOOD, SYNTH_HABIT_GOOD,
		SYNTH_HABIT_GOOD, SYNTH_HABIT_GOOD, SYNTH_HABIT_GOOD, SYNTH_HABIT_PART, SYNTH_HABIT_PART,
		SYNTH_HABIT_UNION, SYNTH_HABIT_UNION};
	uint32_t objects[SYNTH_MAX_OBJECTS], order[SYNTH_TRAIN_SENTENCES];

	for (uint32_t i = 0; i < (uint32_t)d->n; i++)
		objects[i] = i;
	rng_shuffle(r, objects, (uint32_t)d->n);
	for (int rank = 0; rank < d->n; rank++) {
		double share = (rank + 0.5) / d->n;
		int confused = share < 0.85, guessing = share < 0.75;
		for (uint32_t k = 0; k < SYNTH_TRAIN_SENTENCES; k++)
			order[k] = k;
		rng_shuffle(r, order, SYNTH_TRAIN_SENTENCES);
		for (int k = 0; k < SYNTH_TRAIN_SENTENCES; k++) {
			enum synth_habit habit = usual[rng_below(r, 10)];
			if (k < confused)
				habit = SYNTH_HABIT_CONFUSED;
			else if (k < confused + guessing)
				habit = SYNTH_HABIT_GUESSING;
			d->habits[objects[rank]][order[k]] = habit;
		}
	}
}

void synth_detector_make(struct synth_detector *d, const struct synth_object *objects, int n, uint64_t seed)
{
	struct rng r;

	*d = (struct synth_detector){.seed = seed, .n = n, .objects = objects};
	rng_seed(&r, seed, SYNTH_STREAM_FAULTS);
	synth_noise_make(&d->noise, &r);
	choose_habits(d, &r);
	for (int i = 0; i < n; i++) {
		double nearest = INFINITY, best = -INFINITY;
		for (int j = 0; j < n; j++) {
			if (j == i)
				continue;
			double distance = hypot(objects[i].x - objects[j].x, objects[i].y - objects[j].y);
			double like = likeness(&objects[i], &objects[j]) - 0.1 * distance;
			if (distance < nearest)
				d->neighbours[i] = j;
			if (like > best)
				d->confusers[i] = j;
			nearest = fmin(nearest, distance);
			best = fmax(best, like);
		}
	}
}

static enum fault choose_fault(enum synth_habit habit, struct rng *r)
{
	int at = (int)rng_below(r, 100), f = 0;

	while (at >= fault_rates[habit][f])
		at -= fault_rates[habit][f++];
	return (enum fault)f;
}

/* One view at work. */
struct detection {
	const struct synth_detector *d;
	const uint8_t *truth;
	uint8_t *mask; /* (height,width) of the candidate in the making */
	int height, width;
	size_t pixels;
	struct rng rng;
};

static const uint8_t *shown(const struct detection *v, int object)
{
	return v->truth + (size_t)object * v->pixels;
}

static double iou(const uint8_t *a, const uint8_t *b, size_t pixels)
{
	size_t both = 0, either = 0;

	for (size_t p = 0; p < pixels; p++) {
		both += a[p] && b[p];
		either += a[p] || b[p];
	}
	return either ? (double)both / (double)either : 0;
}

/* Draws the candidate's mask; its object may be changed by the fault. */
static int draw(struct detection *v, int object, enum fault f, struct err *e)
{
	const struct synth_detector *d = v->d;
	int other = d->confusers[object], neighbour = d->neighbours[object];
	struct rng *r = &v->rng;

	if (f == FAULT_EMPTY) {
		memset(v->mask, 0, v->pixels);
		return 0;
	}
	memcpy(v->mask, shown(v, f == FAULT_OTHER ? other : object), v->pixels);
	if (f == FAULT_UNION)
		for (size_t p = 0; p < v->pixels; p++)
			v->mask[p] |= shown(v, neighbour)[p];
	if (f == FAULT_PART)
		synth_outline_cut(v->mask, v->height, v->width, rng_range(r, 0.35, 0.65), r);
	double rag = rng_range(r, 0.1, 0.4), shrink = 0.09 * rng_normal(r);
	return synth_outline_rag(v->mask, v->height, v->width, rag, shrink, &d->noise, r, e);
}

/* Confidence follows quality, loosely; a confused sentence is often surer than a right one. */
static double choose_score(struct detection *v, int object, enum fault f, enum synth_habit habit)
{
	double quality = iou(v->mask, shown(v, object), v->pixels);
	double score = 0.30 + 0.40 * quality + 0.12 * rng_normal(&v->rng);

	if (f == FAULT_OTHER)
		score += habit == SYNTH_HABIT_CONFUSED ? 0.54 : 0.05;
	if (f == FAULT_EMPTY)
		score = 0.3;
	return round(1000 * fmin(0.95, fmax(0.2, score))) / 1000;
}

static int put(struct synth_candidates *out, struct detection *v, int object, int sentence, double score,
	struct err *e)
{
	if (mem_grow((void **)&out->items, &out->capacity, out->n + 1, sizeof *out->items, "candidates", e))
		return -1;
	struct synth_candidate *c = &out->items[out->n];
	*c = (struct synth_candidate){.object = object, .sentence = sentence, .score = score};
	if (rle_encode(&c->mask, v->mask, v->height, v->width, e))
		return -1;
	out->n++;
	return 0;
}

static int detect_sentence(
	struct synth_candidates *out, struct detection *v, int object, int sentence, struct err *e)
{
	enum synth_habit habit = v->d->habits[object][sentence];
	struct rng *r = &v->rng;
	/* A hidden object is not found, but at times something else is. */
	int is_hidden = synth_outline_area(shown(v, object), v->pixels) < SMALLEST;
	int count = rng_below(r, 100) < 30 ? 2 : 1;

	for (int i = 0; i < count; i++) {
		enum fault f = choose_fault(habit, r);
		if (is_hidden)
			f = rng_below(r, 100) < 65 ? FAULT_MISSING : FAULT_OTHER;
		if (f == FAULT_MISSING)
			return 0;
		if (draw(v, object, f, e))
			return -1;
		if (f != FAULT_EMPTY && !synth_outline_area(v->mask, v->pixels))
			return 0;
		double score = choose_score(v, object, f, is_hidden ? SYNTH_HABIT_GUESSING : habit);
		if (i)
			score = fmax(0.2, score - 0.1);
		if (put(out, v, object, sentence, score, e))
			return -1;
	}
	return 0;
}

int synth_detect(struct synth_candidates *out, const struct synth_detector *d, int view, const uint8_t *truth,
	int height, int width, struct err *e)
{
	struct detection v = {.d = d, .truth = truth, .height = height, .width = width};

	v.pixels = (size_t)height * (size_t)width;
	v.mask = mem_alloc(v.pixels, 1, "candidate mask", e);
	if (!v.mask)
		return -1;
	rng_seed(&v.rng, d->seed, SYNTH_STREAM_VIEWS + (uint64_t)view);
	int bad = 0;
	for (int i = 0; i < d->n && !bad; i++)
		for (int k = 0; k < SYNTH_TRAIN_SENTENCES && !bad; k++)
			bad = detect_sentence(out, &v, i, k, e);
	free(v.mask);
	return bad;
}

void synth_candidates_free(struct synth_candidates *c)
{
	for (size_t i = 0; i < c->n; i++)
		rle_free(&c->items[i].mask);
	free(c->items);
	*c = (struct synth_candidates){0};
}
