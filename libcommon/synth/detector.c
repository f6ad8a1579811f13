#include "synth/detector.h"

#include "base/mem.h"
#include "synth/outline.h"

#include <math.h>

/* Below this many pixels an object is as good as hidden. */
enum { SMALLEST = 12 };

/* What one candidate shows. */
enum fault {
	FAULT_NONE,
	FAULT_OTHER,
	FAULT_PART,
	FAULT_UNION,
	FAULT_EMPTY,
	FAULT_MISSING,
	FAULT_GROUP,
	FAULTS
};

/* A kind of detector: its faults, and how its confidence comes about. */
static const struct {
	int rates[SYNTH_ERRORS][FAULTS]; /* how often a sentence of each error has each fault, in percent */
	double score, quality, noise;	 /* confidence is score + quality * IoU, with noise */
	/* The same where another object is shown: what such a sentence adds, the noise, and how ragged the
	 * outline is over that of the right one. What draws the eye is outlined well. */
	double confused, guessing, wrong_noise, wrong_rag;
	/* A thing of less than this share of the picture is found seldom, and with less confidence. */
	double faint;
} kinds[SYNTH_SEVERITIES] = {
	[SYNTH_MILD] = {{[SYNTH_ERROR_NONE] = {72, 7, 8, 7, 1, 5},
				[SYNTH_ERROR_CONFUSED] = {14, 75, 3, 3, 1, 4},
				[SYNTH_ERROR_GUESSING] = {22, 68, 3, 3, 1, 3},
				[SYNTH_ERROR_PART] = {42, 8, 40, 4, 1, 5},
				[SYNTH_ERROR_UNION] = {42, 8, 4, 40, 1, 5}},
		0.30, 0.40, 0.12, 0.54, 0.05, 0.12, 1, 0},
	[SYNTH_SEVERE] = {{[SYNTH_ERROR_NONE] = {74, 6, 6, 5, 1, 5, 3},
				  [SYNTH_ERROR_CONFUSED] = {11, 78, 3, 3, 1, 3, 1},
				  [SYNTH_ERROR_GUESSING] = {11, 77, 3, 3, 1, 3, 2},
				  [SYNTH_ERROR_PART] = {40, 6, 42, 3, 1, 6, 2},
				  [SYNTH_ERROR_UNION] = {40, 6, 3, 42, 1, 5, 3},
				  [SYNTH_ERROR_GROUP] = {36, 8, 3, 3, 1, 4, 45}},
		0.45, 0.15, 0.05, 0.15, -0.07, 0.16, 0.43, 0.004},
};

void synth_detector_make(struct synth_detector *d, const struct synth_object *objects, int n,
	const struct synth_sentence *sentences, enum synth_severity severity, uint64_t seed)
{
	struct rng r, r_test;

	*d = (struct synth_detector){
		.seed = seed, .severity = severity, .n = n, .objects = objects, .sentences = sentences};
	rng_seed(&r, seed, SYNTH_STREAM_FAULTS);
	synth_noise_make(&d->noise, &r);
	rng_seed(&r_test, seed, SYNTH_STREAM_TEST_ERRORS);
	synth_errors_make(&d->errors, objects, n, sentences, severity, &r, &r_test);
}

/* One view at work. */
struct detection {
	const struct synth_detector *d;
	const char *view;
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

static void join(struct detection *v, int object)
{
	const uint8_t *with = shown(v, object);

	for (size_t p = 0; p < v->pixels; p++)
		v->mask[p] |= with[p];
}

/* Draws the candidate's mask for the sentence of an object; `other` is what it may be mistaken for. */
static int draw(struct detection *v, int object, int other, enum fault f, struct err *e)
{
	const struct synth_detector *d = v->d;
	struct rng *r = &v->rng;

	if (f == FAULT_EMPTY) {
		memset(v->mask, 0, v->pixels);
		return 0;
	}
	memcpy(v->mask, shown(v, f == FAULT_OTHER ? other : object), v->pixels);
	if (f == FAULT_UNION)
		join(v, d->errors.neighbours[object]);
	for (int j = 0; j < d->n && f == FAULT_GROUP; j++)
		if (synth_look_alike(&d->objects[object], &d->objects[j]))
			join(v, j);
	if (f == FAULT_PART)
		synth_outline_cut(v->mask, v->height, v->width, rng_range(r, 0.35, 0.65), r);
	double ragged = f == FAULT_OTHER ? kinds[d->severity].wrong_rag : 1;
	double rag = ragged * rng_range(r, 0.1, 0.4), shrink = ragged * 0.09 * rng_normal(r);
	return synth_outline_rag(v->mask, v->height, v->width, rag, shrink, &d->noise, r, e);
}

/* 0 for what is large enough to be seen well, up to 1 for what is as good as hidden. */
static double faintness(const struct detection *v, int object)
{
	double area = (double)synth_outline_area(shown(v, object), v->pixels);
	double enough = kinds[v->d->severity].faint * (double)v->pixels;

	return area < enough ? 1 - area / enough : 0;
}

/* Confidence follows quality, loosely; a confused sentence is often surer than a right one. */
static double choose_score(struct detection *v, int object, enum fault f, enum synth_error error)
{
	double quality = iou(v->mask, shown(v, object), v->pixels), luck = rng_normal(&v->rng);
	double score = kinds[v->d->severity].score + kinds[v->d->severity].quality * quality;

	if (f == FAULT_OTHER)
		score += kinds[v->d->severity].wrong_noise * luck +
			 (error == SYNTH_ERROR_CONFUSED ? kinds[v->d->severity].confused
							: kinds[v->d->severity].guessing);
	else
		score += kinds[v->d->severity].noise * luck - 0.15 * faintness(v, object);
	if (f == FAULT_EMPTY)
		score = 0.3;
	return round(1000 * fmin(0.95, fmax(0.2, score))) / 1000;
}

static int put(struct masks *out, struct detection *v, int object, int sentence, double score, struct err *e)
{
	const struct synth_detector *d = v->d;
	struct mask m = {.score = score, .visible = NAN};

	if ((m.view = mem_strdup(v->view, e)) &&
		(m.ref = mem_strdup(d->sentences[object * SYNTH_SENTENCES + sentence].ref, e)) &&
		(m.object = mem_strdup(d->objects[object].name, e)) &&
		!rle_encode(&m.rle, v->mask, v->height, v->width, e))
		return masks_add(out, &m, e);
	mask_free(&m);
	return -1;
}

/* What goes wrong this time. A hidden object is not found, but at times something else is; a small or mostly
 * hidden one is found seldom. */
static enum fault meet_fault(
	struct detection *v, int object, int other, enum synth_error error, int is_hidden)
{
	struct rng *r = &v->rng;
	enum fault f = (enum fault)rng_draw(r, kinds[v->d->severity].rates[error], FAULTS);

	if (is_hidden)
		return rng_below(r, 100) < 65 ? FAULT_MISSING : FAULT_OTHER;
	if (v->d->severity == SYNTH_MILD)
		return f;
	if (f == FAULT_OTHER)
		return synth_outline_area(shown(v, other), v->pixels) < SMALLEST ? FAULT_NONE : f;
	return rng_uniform(r) < 0.6 * faintness(v, object) ? FAULT_MISSING : f;
}

static int detect_sentence(struct masks *out, struct detection *v, int object, int sentence, struct err *e)
{
	enum synth_error error = v->d->errors.of[object][sentence];
	int other = v->d->errors.mistaken[object][sentence];
	int is_hidden = synth_outline_area(shown(v, object), v->pixels) < SMALLEST;
	int count = rng_below(&v->rng, 100) < 30 ? 2 : 1;

	for (int i = 0; i < count; i++) {
		enum fault f = meet_fault(v, object, other, error, is_hidden);
		if (f == FAULT_MISSING)
			return 0;
		if (draw(v, object, other, f, e))
			return -1;
		if (f != FAULT_EMPTY && !synth_outline_area(v->mask, v->pixels))
			return 0;
		double score = choose_score(v, object, f, is_hidden ? SYNTH_ERROR_GUESSING : error);
		if (i)
			score = fmax(0.2, score - 0.1);
		if (put(out, v, object, sentence, score, e))
			return -1;
	}
	return 0;
}

int synth_detect(struct masks *out, const struct synth_detector *d, int number, const char *view, int count,
	const uint8_t *truth, int height, int width, struct err *e)
{
	struct detection v = {.d = d, .view = view, .truth = truth, .height = height, .width = width};

	v.pixels = (size_t)height * (size_t)width;
	v.mask = mem_alloc(v.pixels, 1, "candidate mask", e);
	if (!v.mask)
		return -1;
	rng_seed(&v.rng, d->seed, SYNTH_STREAM_VIEWS + (uint64_t)number);
	int bad = 0;
	for (int i = 0; i < d->n && !bad; i++)
		for (int k = 0; k < count && !bad; k++)
			bad = detect_sentence(out, &v, i, k, e);
	free(v.mask);
	return bad;
}
