#include "train/step.h"

#include "base/mem.h"
#include "field/forward.h"
#include "field/image_loss.h"
#include "field/text_mlp.h"

enum { L = BLOCK_LANES, G = BLOCK_G, CHUNKS = FORWARD_CHUNKS };

/* The parts of a chunk's sums in the backward pass, in the order of struct block_sums. */
enum part {
	DUH,
	DUQ,
	DY,
	DK,
	DGRAM,
	DM0,
	MEAN,
	DP_GRAM,
	DFEATURE0,
	DFEATURE0_BIAS,
	DFEATURE1,
	DFEATURE1_BIAS,
	DPOSITION0,
	DPOSITION0_BIAS,
	DPOSITION1,
	DPOSITION1_BIAS,
	PARTS
};

struct step {
	struct step_setup setup;
	struct text_mlp words;
	size_t *chosen; /* (R) sentences of the step: its targets' first, or all in order */
	size_t chosen_count;
	int *chosen_objects; /* (R) */
	char *is_chosen;     /* (R) */
	size_t *places;	     /* (batch) of the targets in chosen */
	struct forward forward;
	float *slab;	       /* the per-Gaussian arrays of the backward pass, but dx */
	float *response, *top; /* (padded) one sentence's channel */
	struct image_loss images;
	float *dvectors;	  /* (n,128) */
	double *fg, *dfg, *score; /* (S,128), (S,128), (2,R) */
	struct block_sums sums[CHUNKS];
	size_t at[PARTS + 1]; /* where each part lies in a chunk's slab, for the current step */
	float *chunks;	      /* (CHUNKS, chunk_size) */
	size_t chunk_size;
	double *total; /* (chunk_size) the chunks' sums, added in order */
	void (*ended)(void *data, enum step_phase phase);
	void *ended_data;
};

void step_watch(struct step *s, void (*ended)(void *data, enum step_phase phase), void *data)
{
	s->ended = ended;
	s->ended_data = data;
}

static void phase_ended(const struct step *s, enum step_phase phase)
{
	if (s->ended)
		s->ended(s->ended_data, phase);
}

/* Lengths of a chunk's parts for n words, S sentences and z channels; x has `width`. */
static void lay_out(
	size_t at[PARTS + 1], size_t n, size_t sentences, size_t z, int is_normalised, size_t width)
{
	const size_t length[PARTS] = {n * G, n * G, n * G, sentences * z,
		is_normalised ? sentences * (z + 1) * z : 0, sentences, sentences * z, (size_t)G * G,
		REFER_XH * width, REFER_XH, REFER_H * REFER_XH, REFER_H, REFER_PH * 3, REFER_PH,
		REFER_H * REFER_PH, REFER_H};

	at[0] = 0;
	for (int p = 0; p < PARTS; p++)
		at[p + 1] = at[p] + (length[p] + 15) / 16 * 16;
}

static void set_chunks(struct step *s)
{
	lay_out(s->at, (size_t)s->forward.model.words, (size_t)s->forward.model.sentences,
		(size_t)s->forward.model.z_size, s->forward.model.is_normalised,
		(size_t)s->forward.model.feature_width);
	for (int c = 0; c < CHUNKS; c++) {
		float *base = s->chunks + (size_t)c * s->chunk_size;
		float **parts[PARTS] = {&s->sums[c].duh, &s->sums[c].duq, &s->sums[c].dy, &s->sums[c].dk,
			&s->sums[c].dgram, &s->sums[c].dm0, &s->sums[c].mean, &s->sums[c].dp_gram,
			&s->sums[c].dfeature0, &s->sums[c].dfeature0_bias, &s->sums[c].dfeature1,
			&s->sums[c].dfeature1_bias, &s->sums[c].dposition0, &s->sums[c].dposition0_bias,
			&s->sums[c].dposition1, &s->sums[c].dposition1_bias};
		for (int p = 0; p < PARTS; p++)
			*parts[p] = base + s->at[p];
	}
}

static void clear_parts(struct step *s, enum part from, enum part to)
{
	for (int c = 0; c < CHUNKS; c++)
		memset(s->chunks + (size_t)c * s->chunk_size + s->at[from], 0,
			sizeof(float) * (s->at[to + 1] - s->at[from]));
}

/* total = the chunks' parts, added in order. */
static void add_chunks(struct step *s, enum part from, enum part to)
{
	const size_t begin = s->at[from], end = s->at[to + 1], part = 1024;

#pragma omp parallel for schedule(static) num_threads(s->forward.threads)
	for (size_t first = begin; first < end; first += part) {
		const size_t last = end - first > part ? first + part : end;
		memset(s->total + first, 0, sizeof(double) * (last - first));
		for (int c = 0; c < CHUNKS; c++)
			for (size_t i = first; i < last; i++)
				s->total[i] += (double)s->chunks[(size_t)c * s->chunk_size + i];
	}
}

static void gather_block(void *data, size_t block, int chunk, float *scratch)
{
	struct step *s = data;

	(void)scratch;
	s->forward.setup.kernels->gather(&s->forward.model, &s->forward.arrays, block, &s->sums[chunk]);
}

static void scores_back_block(void *data, size_t block, int chunk, float *scratch)
{
	struct step *s = data;

	s->forward.setup.kernels->scores_back(
		&s->forward.model, &s->forward.arrays, block, &s->sums[chunk], scratch);
}

static void hidden_back_block(void *data, size_t block, int chunk, float *scratch)
{
	struct step *s = data;

	s->forward.setup.kernels->hidden_back(
		&s->forward.model, &s->forward.arrays, block, &s->sums[chunk], scratch);
}

/* Runs a phase of the backward pass over all blocks. */
static void run_phase(struct step *s, enum step_phase phase)
{
	phase_ended(s, STEP_FOLD);
	forward_each_block(&s->forward,
		phase == STEP_GATHER	    ? gather_block
		: phase == STEP_SCORES_BACK ? scores_back_block
					    : hidden_back_block,
		s);
	phase_ended(s, phase);
}

static int check_sentences(const struct step_setup *u, int *longest, struct err *e)
{
	*longest = 1;
	for (size_t r = 0; r < u->sentences; r++) {
		int64_t n = u->offsets[r + 1] - u->offsets[r];
		if (n < 1)
			return err_set(e, ERR_FORMAT, "sentence %zu has no words", r);
		if (n > BLOCK_WORDS)
			return err_set(e, ERR_FORMAT, "sentence %zu has %lld words, more than %d", r,
				(long long)n, BLOCK_WORDS);
		if (n > *longest)
			*longest = (int)n;
	}
	return 0;
}

static int alloc_arrays(struct step *s, struct err *e)
{
	const struct step_setup *u = &s->setup;
	const enum refer_interaction i = u->layout->interaction;
	const int normalised = u->similarity == REFER_COSINE || i == REFER_PCMI_PROJ;
	const size_t batch = (size_t)u->batch, padded = s->forward.padded;
	const size_t channels[4] = {batch, batch, normalised ? G : 0, normalised && i == REFER_ADD ? G : 0};
	struct block_arrays *a = &s->forward.arrays;
	float **arrays[4] = {&a->dm, &a->top, &a->dg, &a->dr};
	size_t all = 0, floats;

	for (int k = 0; k < 4; k++)
		all += channels[k];
	if (mem_size(all, padded, &floats))
		return err_set(e, ERR_SYSTEM, "%zu Gaussians do not fit in memory", u->gaussians);
	s->slab = mem_zalloc(floats, sizeof(float), "features", e);
	s->response = mem_zalloc(padded, 2 * sizeof(float), "responses", e);
	if (!s->slab || !s->response ||
		image_loss_init(&s->images, u->pixels, padded, u->batch, s->forward.threads, e))
		return -1;
	s->top = s->response + padded;
	float *at = s->slab;
	for (int k = 0; k < 4; k++) {
		*arrays[k] = channels[k] ? at : NULL;
		at += channels[k] * padded;
	}
	return 0;
}

static int alloc_sums(struct step *s, int longest, struct err *e)
{
	const struct step_setup *u = &s->setup;
	const size_t batch = (size_t)u->batch, n = batch * (size_t)longest, z = 2 * G + (size_t)longest;
	const int normalised = u->similarity == REFER_COSINE || u->layout->interaction == REFER_PCMI_PROJ;
	size_t at[PARTS + 1];

	lay_out(at, n, batch, z, normalised, (size_t)u->layout->feature_width);
	s->chunk_size = at[PARTS];
	s->chunks = mem_zalloc(CHUNKS, s->chunk_size * sizeof(float), "sums", e);
	s->total = mem_zalloc(s->chunk_size, sizeof(double), "sums", e);
	s->dvectors = mem_zalloc(n, REFER_D * sizeof(float), "words", e);
	s->fg = mem_zalloc(2 * (batch * REFER_D + u->sentences), sizeof(double), "contrast", e);
	s->places = mem_zalloc(batch, sizeof *s->places, "batch", e);
	s->chosen = mem_zalloc(u->sentences, sizeof *s->chosen, "batch", e);
	s->chosen_objects = mem_zalloc(u->sentences, sizeof *s->chosen_objects, "batch", e);
	s->is_chosen = mem_zalloc(u->sentences, 1, "batch", e);
	if (!s->chunks || !s->total || !s->dvectors || !s->fg || !s->places || !s->chosen ||
		!s->chosen_objects || !s->is_chosen)
		return -1;
	s->dfg = s->fg + batch * REFER_D;
	s->score = s->dfg + batch * REFER_D;
	return 0;
}

struct step *step_new(const struct step_setup *setup, struct err *e)
{
	struct forward_setup forward = {.layout = setup->layout,
		.similarity = setup->similarity,
		.gaussians = setup->gaussians,
		.position = setup->position,
		.batch = setup->batch,
		.kernels = setup->kernels};
	struct step *s;

	if (check_sentences(setup, &forward.longest, e) || !(s = mem_zalloc(1, sizeof *s, "step", e)))
		return NULL;
	s->setup = *setup;
	if (forward_init(&s->forward, &forward, e) || alloc_arrays(s, e) ||
		alloc_sums(s, forward.longest, e) ||
		text_mlp_init(&s->words, setup->layout, setup->sentences, setup->offsets, setup->words,
			TEXT_MLP_LEARNING, e)) {
		step_free(s);
		return NULL;
	}
	return s;
}

void step_free(struct step *s)
{
	if (!s)
		return;
	text_mlp_free(&s->words);
	forward_free(&s->forward);
	mem_free_all(s->places, s->chosen, s->chosen_objects, s->is_chosen, s->slab, s->response);
	image_loss_free(&s->images);
	mem_free_all(s->dvectors, s->fg, s->chunks, s->total, s);
}

/* From words to responses, in arrays.m. */
static void forward(struct step *s, const float *parameters, const float *x, int count)
{
	struct forward *f = &s->forward;

	for (int i = 0; i < count; i++) {
		const int64_t *at = s->words.at + s->places[i];
		text_mlp_vectors(&s->words, parameters, s->places[i], f->vectors + f->first[i] * REFER_D);
		f->first[i + 1] = f->first[i] + (int)(at[1] - at[0]);
	}
	forward_fold(f, parameters, count);
	set_chunks(s);
	phase_ended(s, STEP_FOLD);
	forward_hidden(f, x);
	phase_ended(s, STEP_HIDDEN);
	forward_scores(f);
	phase_ended(s, STEP_FOLD);
	forward_respond(f);
	phase_ended(s, STEP_RESPOND);
}

/* Images, their loss, and dm. */
static double image_losses(
	struct step *s, const struct view_weights *view, const struct step_target *targets, int count)
{
	const size_t whole = s->setup.gaussians / L * L, channels = (size_t)count;
	const uint8_t *masks[BLOCK_WORDS];

	/* the padding of a last panel may hold what a step of other channels left */
	memset(s->forward.arrays.dm + whole * channels, 0,
		sizeof(float) * (s->forward.padded - whole) * channels);
	for (int i = 0; i < count; i++)
		masks[i] = targets[i].mask;
	return image_loss_run(&s->images, view, s->forward.arrays.m, count, masks, s->forward.arrays.dm);
}

/* How often each chosen sentence counts, to stand for all: of other objects, and of that one. */
static void count_times(const struct step *s, int object, double times[2])
{
	size_t all[2] = {0}, chosen[2] = {0};

	for (size_t r = 0; r < s->setup.sentences; r++)
		all[s->setup.objects[r] == object]++;
	for (size_t k = 0; k < s->chosen_count; k++)
		chosen[s->chosen_objects[k] == object]++;
	for (int i = 0; i < 2; i++)
		times[i] = chosen[i] ? (double)all[i] / (double)chosen[i] : 1;
}

/* The contrast of each sentence; its gradient goes to fold's dmean and words.de. */
static double contrast_losses(struct step *s, const struct step_target *targets, int count, size_t top_count)
{
	double sum = 0;

	for (int i = 0; i < count; i++) {
		panels_get(s->forward.arrays.m, s->forward.padded, count, i, s->response);
		memset(s->top, 0, sizeof(float) * s->forward.padded);
		contrast_top_set(s->response, s->setup.counts, s->setup.gaussians, top_count, s->top);
		panels_put(s->forward.arrays.top, s->forward.padded, count, i, s->top);
	}
	phase_ended(s, STEP_TOP);
	clear_parts(s, MEAN, MEAN);
	run_phase(s, STEP_GATHER);
	add_chunks(s, MEAN, MEAN);
	fold_top(s->forward.fold, s->total + s->at[MEAN], s->fg);
	memset(s->words.de, 0, sizeof(float) * s->chosen_count * REFER_D);
	for (int i = 0; i < count; i++) {
		const int object = s->setup.objects[targets[i].sentence];
		double times[2];
		count_times(s, object, times);
		sum += contrast_loss(s->setup.contrast, s->setup.temperature, s->fg + i * REFER_D, s->words.e,
			       s->chosen_objects, s->chosen_count, object, times, s->setup.lambda / count,
			       s->dfg + i * REFER_D, s->words.de, s->score) /
		       count;
	}
	fold_top_back(s->forward.fold, s->dfg, &s->forward.model);
	return sum;
}

static void add_tensor(struct step *s, enum part part, enum refer_tensor t, float *gradient)
{
	const struct refer_layout *l = s->setup.layout;
	const size_t count = (size_t)l->tensors[t].rows * (size_t)l->tensors[t].columns;

	for (size_t i = 0; i < count; i++)
		gradient[l->tensors[t].offset + i] += (float)s->total[s->at[part] + i];
}

/* From dm and dmean to every gradient. */
static void backward(struct step *s, const float *parameters, int count, float *gradient, float *dx)
{
	const int has_contrast = s->setup.contrast != REFER_CONTRAST_NONE;

	clear_parts(s, DUH, DM0);
	run_phase(s, STEP_SCORES_BACK);
	add_chunks(s, DUH, DM0);
	fold_scores_back(s->forward.fold, s->total + s->at[DUH], s->total + s->at[DUQ], s->total + s->at[DK],
		s->total + s->at[DGRAM], s->total + s->at[DM0], &s->forward.model);
	s->forward.arrays.dx = dx;
	clear_parts(s, DY, DY);
	clear_parts(s, DP_GRAM, DPOSITION1_BIAS);
	run_phase(s, STEP_HIDDEN_BACK);
	add_chunks(s, DY, DY);
	add_chunks(s, DP_GRAM, DPOSITION1_BIAS);
	for (int i = 0; i < 4; i++) {
		add_tensor(s, DFEATURE0 + (enum part)i, FEATURE_0_WEIGHT + (enum refer_tensor)i, gradient);
		add_tensor(s, DPOSITION0 + (enum part)i, POSITION_0_WEIGHT + (enum refer_tensor)i, gradient);
	}
	fold_end(s->forward.fold, s->total + s->at[DY], s->total + s->at[DP_GRAM], gradient, s->dvectors);
	phase_ended(s, STEP_FOLD);
	text_mlp_back_begin(&s->words, parameters, gradient, has_contrast);
	for (int i = 0; i < count; i++)
		text_mlp_back_vectors(&s->words, parameters, gradient, s->places[i],
			s->dvectors + s->forward.first[i] * REFER_D);
	text_mlp_back_end(&s->words, parameters, gradient);
	phase_ended(s, STEP_WORDS);
}

static void choose(struct step *s, size_t sentence)
{
	if (s->is_chosen[sentence])
		return;
	s->is_chosen[sentence] = 1;
	s->chosen[s->chosen_count] = sentence;
	s->chosen_objects[s->chosen_count++] = s->setup.objects ? s->setup.objects[sentence] : 0;
}

/* The sentences of the step: all, or the targets and those that are named. */
static void choose_sentences(struct step *s, const struct step_target *targets, int count, int is_contrasted,
	const struct step_others *others)
{
	const int is_all = is_contrasted && !others;

	s->chosen_count = 0;
	memset(s->is_chosen, 0, s->setup.sentences);
	for (int i = 0; i < count; i++)
		s->places[i] = is_all ? targets[i].sentence : (size_t)i;
	for (int i = 0; i < count && !is_all; i++)
		choose(s, targets[i].sentence);
	for (size_t r = 0; r < s->setup.sentences && is_all; r++)
		choose(s, r);
	for (size_t k = 0; is_contrasted && others && k < others->count; k++)
		choose(s, others->list[k]);
	text_mlp_choose(&s->words, s->chosen, s->chosen_count);
}

struct step_losses step_run(struct step *s, const float *parameters, const float *x,
	const struct view_weights *view, const struct step_target *targets, int count, size_t top_count,
	const struct step_others *others, float *gradient, float *dx)
{
	const int has_contrast = s->setup.contrast != REFER_CONTRAST_NONE;
	struct step_losses losses = {0};

	memset(gradient, 0, sizeof *gradient * s->setup.layout->count);
	choose_sentences(s, targets, count, has_contrast, others);
	text_mlp_hidden(&s->words, parameters);
	if (has_contrast)
		text_mlp_embed(&s->words, parameters);
	phase_ended(s, STEP_WORDS);
	forward(s, parameters, x, count);
	losses.bce = image_losses(s, view, targets, count);
	phase_ended(s, STEP_IMAGES);
	if (has_contrast) {
		losses.contrast = contrast_losses(s, targets, count, top_count);
	} else {
		memset(s->forward.arrays.top, 0, sizeof(float) * s->forward.padded * (size_t)count);
		fold_top_back(s->forward.fold, NULL, &s->forward.model);
	}
	backward(s, parameters, count, gradient, dx);
	losses.total = losses.bce + s->setup.lambda * losses.contrast;
	return losses;
}

size_t step_gaussians(const struct step *s)
{
	const struct step_setup *u = &s->setup;
	size_t sum = 0;

	for (size_t i = 0; i < u->gaussians; i++)
		sum += u->counts ? u->counts[i] : 1;
	return sum;
}

void step_respond(struct step *s, const float *parameters, const float *x, size_t sentence, float *m)
{
	s->places[0] = 0;
	text_mlp_choose(&s->words, &sentence, 1);
	text_mlp_hidden(&s->words, parameters);
	forward(s, parameters, x, 1);
	panels_get(s->forward.arrays.m, s->forward.padded, 1, 0, s->response);
	memcpy(m, s->response, sizeof *m * s->setup.gaussians);
}
