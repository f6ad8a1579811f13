#include "train/step.h"

#include "base/mem.h"
#include "field/fold.h"
#include "field/image_loss.h"
#include "field/text_mlp.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { L = BLOCK_LANES, G = BLOCK_G, CHUNKS = 32 };

/* The parts of a chunk's sums, in the order of struct block_sums. */
enum part {
	L_MAX,
	L_SUM,
	C_SUM,
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
	struct fold *fold;
	struct block_model model;
	struct block_arrays arrays;
	size_t blocks, padded;
	int max_words; /* of a step */
	int *first;    /* (batch+1) */
	float *slab;   /* all per-Gaussian arrays but x and dx */
	float *position;
	float *response, *top; /* (padded) one sentence's channel */
	struct image_loss images;
	float *vectors, *dvectors; /* (n,128) */
	double *fg, *dfg, *score;  /* (S,128), (S,128), (R) */
	struct block_sums sums[CHUNKS];
	size_t at[PARTS + 1]; /* where each part lies in a chunk's slab, for the current step */
	float *chunks;	      /* (CHUNKS, chunk_size) */
	size_t chunk_size;
	double *total;	/* (chunk_size) the chunks' sums, added in order */
	float *scratch; /* (threads, scratch_size) */
	size_t scratch_size;
	int threads;
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

size_t step_padded(size_t gaussians)
{
	return (gaussians + BLOCK_SIZE - 1) / BLOCK_SIZE * BLOCK_SIZE;
}

static size_t panel_index(size_t i, int channels, int c)
{
	return i / L * (size_t)channels * L + (size_t)c * L + i % L;
}

static void pack(const float *rows, size_t n, int channels, float *panels)
{
	memset(panels, 0, sizeof *panels * step_padded(n) * (size_t)channels);
	for (size_t i = 0; i < n; i++)
		for (int c = 0; c < channels; c++)
			panels[panel_index(i, channels, c)] = rows[i * (size_t)channels + (size_t)c];
}

void step_pack(const float *x, size_t gaussians, int width, float *panels)
{
	pack(x, gaussians, width, panels);
}

void step_unpack(const float *panels, size_t gaussians, int width, float *x)
{
	for (size_t i = 0; i < gaussians; i++)
		for (int c = 0; c < width; c++)
			x[i * (size_t)width + (size_t)c] = panels[panel_index(i, width, c)];
}

/* Lengths of a chunk's parts for n words, S sentences and z channels; x has `width`. */
static void lay_out(
	size_t at[PARTS + 1], size_t n, size_t sentences, size_t z, int is_normalised, size_t width)
{
	const size_t length[PARTS] = {n, n, n * G, n * G, n * G, n * G, sentences * z,
		is_normalised ? sentences * (z + 1) * z : 0, sentences, sentences * z, (size_t)G * G,
		REFER_XH * width, REFER_XH, REFER_H * REFER_XH, REFER_H, REFER_PH * 3, REFER_PH,
		REFER_H * REFER_PH, REFER_H};

	at[0] = 0;
	for (int p = 0; p < PARTS; p++)
		at[p + 1] = at[p] + (length[p] + 15) / 16 * 16;
}

static void set_chunks(struct step *s)
{
	lay_out(s->at, (size_t)s->model.words, (size_t)s->model.sentences, (size_t)s->model.z_size,
		s->model.is_normalised, (size_t)s->model.feature_width);
	for (int c = 0; c < CHUNKS; c++) {
		float *base = s->chunks + (size_t)c * s->chunk_size;
		float **parts[PARTS] = {&s->sums[c].l_max, &s->sums[c].l_sum, &s->sums[c].c_sum,
			&s->sums[c].duh, &s->sums[c].duq, &s->sums[c].dy, &s->sums[c].dk, &s->sums[c].dgram,
			&s->sums[c].dm0, &s->sums[c].mean, &s->sums[c].dp_gram, &s->sums[c].dfeature0,
			&s->sums[c].dfeature0_bias, &s->sums[c].dfeature1, &s->sums[c].dfeature1_bias,
			&s->sums[c].dposition0, &s->sums[c].dposition0_bias, &s->sums[c].dposition1,
			&s->sums[c].dposition1_bias};
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

#pragma omp parallel for schedule(static) num_threads(s->threads)
	for (size_t first = begin; first < end; first += part) {
		const size_t last = end - first > part ? first + part : end;
		memset(s->total + first, 0, sizeof(double) * (last - first));
		for (int c = 0; c < CHUNKS; c++)
			for (size_t i = first; i < last; i++)
				s->total[i] += (double)s->chunks[(size_t)c * s->chunk_size + i];
	}
}

/* Runs a phase over all blocks, each chunk's in order. */
static void run_phase(struct step *s, enum step_phase phase)
{
	const struct block_kernels *k = s->setup.kernels;

	phase_ended(s, STEP_FOLD);
#pragma omp parallel for schedule(dynamic) num_threads(s->threads)
	for (int c = 0; c < CHUNKS; c++) {
		float *scratch = s->scratch + (size_t)omp_get_thread_num() * s->scratch_size;
		for (size_t b = s->blocks * (size_t)c / CHUNKS; b < s->blocks * (size_t)(c + 1) / CHUNKS; b++)
			switch (phase) {
			case STEP_HIDDEN:
				k->hidden(&s->model, &s->arrays, b, &s->sums[c], scratch);
				break;
			case STEP_RESPOND:
				k->respond(&s->model, &s->arrays, b);
				break;
			case STEP_GATHER:
				k->gather(&s->model, &s->arrays, b, &s->sums[c]);
				break;
			case STEP_SCORES_BACK:
				k->scores_back(&s->model, &s->arrays, b, &s->sums[c], scratch);
				break;
			default:
				k->hidden_back(&s->model, &s->arrays, b, &s->sums[c], scratch);
				break;
			}
	}
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
	const size_t n = (size_t)s->max_words, batch = (size_t)u->batch;
	const int attention = i != REFER_NONE && i != REFER_ADD;
	const size_t channels[10] = {G, refer_uses_position(i) ? G : 0, i >= REFER_PCMI ? n : 0,
		attention ? n : 0, batch, batch, batch, batch, normalised ? G : 0,
		normalised && i == REFER_ADD ? G : 0};
	float **arrays[10] = {&s->arrays.g, &s->arrays.r, &s->arrays.beta, &s->arrays.alpha, &s->arrays.m,
		&s->arrays.sigma, &s->arrays.dm, &s->arrays.top, &s->arrays.dg, &s->arrays.dr};
	size_t all = 0, floats;

	for (int k = 0; k < 10; k++)
		all += channels[k];
	if (mem_size(all, s->padded, &floats))
		return err_set(e, ERR_SYSTEM, "%zu Gaussians do not fit in memory", u->gaussians);
	s->slab = mem_zalloc(floats, sizeof(float), "features", e);
	s->position = mem_alloc(s->padded, 3 * sizeof(float), "positions", e);
	s->response = mem_zalloc(s->padded, 2 * sizeof(float), "responses", e);
	if (!s->slab || !s->position || !s->response ||
		image_loss_init(&s->images, u->pixels, s->padded, u->batch, s->threads, e))
		return -1;
	s->top = s->response + s->padded;
	float *at = s->slab;
	for (int k = 0; k < 10; k++) {
		*arrays[k] = channels[k] ? at : NULL;
		at += channels[k] * s->padded;
	}
	pack(u->position, u->gaussians, 3, s->position);
	s->arrays.position = s->position;
	return 0;
}

static int alloc_sums(struct step *s, struct err *e)
{
	const struct step_setup *u = &s->setup;
	const size_t batch = (size_t)u->batch, n = (size_t)s->max_words;
	const size_t longest = n / batch, z = 2 * G + longest;
	const int normalised = u->similarity == REFER_COSINE || u->layout->interaction == REFER_PCMI_PROJ;
	size_t at[PARTS + 1];

	lay_out(at, n, batch, z, normalised, (size_t)u->layout->feature_width);
	s->chunk_size = at[PARTS];
	const struct block_model largest = {.words = s->max_words, .z_size = (int)z};
	s->scratch_size = (block_scratch_floats(&largest) + 15) / 16 * 16;
	s->chunks = mem_zalloc(CHUNKS, s->chunk_size * sizeof(float), "sums", e);
	s->total = mem_zalloc(s->chunk_size, sizeof(double), "sums", e);
	s->scratch = mem_zalloc((size_t)s->threads, s->scratch_size * sizeof(float), "scratch", e);
	s->vectors = mem_zalloc(n, 2 * REFER_D * sizeof(float), "words", e);
	s->fg = mem_zalloc(2 * batch * REFER_D + u->sentences, sizeof(double), "contrast", e);
	s->first = mem_zalloc(batch + 1, sizeof *s->first, "batch", e);
	s->places = mem_zalloc(batch, sizeof *s->places, "batch", e);
	s->chosen = mem_zalloc(u->sentences, sizeof *s->chosen, "batch", e);
	s->chosen_objects = mem_zalloc(u->sentences, sizeof *s->chosen_objects, "batch", e);
	s->is_chosen = mem_zalloc(u->sentences, 1, "batch", e);
	if (!s->chunks || !s->total || !s->scratch || !s->vectors || !s->fg || !s->first || !s->places ||
		!s->chosen || !s->chosen_objects || !s->is_chosen)
		return -1;
	s->dvectors = s->vectors + n * REFER_D;
	s->dfg = s->fg + batch * REFER_D;
	s->score = s->dfg + batch * REFER_D;
	return 0;
}

struct step *step_new(const struct step_setup *setup, struct err *e)
{
	struct step *s;
	int longest;

	if (check_sentences(setup, &longest, e) || !(s = mem_zalloc(1, sizeof *s, "step", e)))
		return NULL;
	s->setup = *setup;
	if (!s->setup.kernels)
		s->setup.kernels = block_select(NULL);
	s->padded = step_padded(setup->gaussians);
	s->blocks = s->padded / BLOCK_SIZE;
	s->max_words = longest * setup->batch;
	s->threads = omp_get_max_threads();
	if (alloc_arrays(s, e) || alloc_sums(s, e) ||
		text_mlp_init(&s->words, setup->layout, setup->sentences, setup->offsets, setup->words, e) ||
		!(s->fold = fold_new(setup->layout, setup->similarity, longest, setup->batch, e))) {
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
	fold_free(s->fold);
	free(s->first);
	free(s->places);
	free(s->chosen);
	free(s->chosen_objects);
	free(s->is_chosen);
	free(s->slab);
	free(s->position);
	free(s->response);
	image_loss_free(&s->images);
	free(s->vectors);
	free(s->fg);
	free(s->chunks);
	free(s->total);
	free(s->scratch);
	free(s);
}

/* The softmax over Gaussians from the chunks' running sums: cbar, l_max and l_sum in place of the totals. */
static void join_word_positions(struct step *s)
{
	double *top = s->total + s->at[L_MAX], *sum = s->total + s->at[L_SUM],
	       *mean = s->total + s->at[C_SUM];

	for (int j = 0; j < s->model.words; j++) {
		double *row = mean + j * G;
		top[j] = -INFINITY;
		sum[j] = 0;
		memset(row, 0, sizeof *row * G);
		for (int c = 0; c < CHUNKS; c++)
			top[j] = fmax(top[j], (double)s->sums[c].l_max[j]);
		for (int c = 0; c < CHUNKS; c++) {
			double scale = exp((double)s->sums[c].l_max[j] - top[j]);
			sum[j] += scale * (double)s->sums[c].l_sum[j];
			for (int k = 0; k < G; k++)
				row[k] += scale * (double)s->sums[c].c_sum[j * G + k];
		}
		for (int k = 0; k < G; k++)
			row[k] /= sum[j];
	}
}

/* From words to responses, in arrays.m. */
static void forward(struct step *s, const float *parameters, const float *x, int count)
{
	struct block_model *b = &s->model;

	s->first[0] = 0;
	for (int i = 0; i < count; i++) {
		const int64_t *at = s->words.at + s->places[i];
		text_mlp_vectors(&s->words, parameters, s->places[i], s->vectors + s->first[i] * REFER_D);
		s->first[i + 1] = s->first[i] + (int)(at[1] - at[0]);
	}
	fold_begin(s->fold, parameters, s->setup.gaussians, s->first, count, b);
	fold_words(s->fold, s->vectors, b);
	s->arrays.x = x;
	set_chunks(s);
	clear_parts(s, L_MAX, C_SUM);
	for (int c = 0; c < CHUNKS; c++)
		for (int j = 0; j < b->words; j++)
			s->sums[c].l_max[j] = -INFINITY;
	run_phase(s, STEP_HIDDEN);
	if (b->has_words)
		join_word_positions(s);
	fold_scores(s->fold, s->total + s->at[C_SUM], s->total + s->at[L_MAX], s->total + s->at[L_SUM], b);
	run_phase(s, STEP_RESPOND);
}

/* One sentence's channel of a panel array, to or from (padded) floats. */
static void channel_get(const float *panels, size_t padded, int channels, int c, float *out)
{
	for (size_t i = 0; i < padded; i += L)
		memcpy(out + i, panels + panel_index(i, channels, c), sizeof(float) * L);
}

static void channel_put(float *panels, size_t padded, int channels, int c, const float *in)
{
	for (size_t i = 0; i < padded; i += L)
		memcpy(panels + panel_index(i, channels, c), in + i, sizeof(float) * L);
}

/* Images, their loss, and dm. */
static double image_losses(
	struct step *s, const struct view_weights *view, const struct step_target *targets, int count)
{
	const size_t whole = s->setup.gaussians / L * L, channels = (size_t)count;
	const uint8_t *masks[BLOCK_WORDS];

	/* the padding of a last panel may hold what a step of other channels left */
	memset(s->arrays.dm + whole * channels, 0, sizeof(float) * (s->padded - whole) * channels);
	for (int i = 0; i < count; i++)
		masks[i] = targets[i].mask;
	return image_loss_run(&s->images, view, s->arrays.m, count, masks, s->arrays.dm);
}

/* How often each chosen sentence of another object counts, to stand for all of them. */
static double times_of_others(const struct step *s, int object)
{
	size_t all = 0, chosen = 0;

	for (size_t r = 0; r < s->setup.sentences; r++)
		all += s->setup.objects[r] != object;
	for (size_t k = 0; k < s->chosen_count; k++)
		chosen += s->chosen_objects[k] != object;
	return chosen ? (double)all / (double)chosen : 1;
}

/* The contrast of each sentence; its gradient goes to fold's dmean and words.de. */
static double contrast_losses(struct step *s, const struct step_target *targets, int count, size_t top_count)
{
	double sum = 0;

	for (int i = 0; i < count; i++) {
		channel_get(s->arrays.m, s->padded, count, i, s->response);
		memset(s->top, 0, sizeof(float) * s->padded);
		contrast_top_set(s->response, s->setup.gaussians, top_count, s->top);
		channel_put(s->arrays.top, s->padded, count, i, s->top);
	}
	phase_ended(s, STEP_TOP);
	clear_parts(s, MEAN, MEAN);
	run_phase(s, STEP_GATHER);
	add_chunks(s, MEAN, MEAN);
	fold_top(s->fold, s->total + s->at[MEAN], s->fg);
	memset(s->words.de, 0, sizeof(float) * s->chosen_count * REFER_D);
	for (int i = 0; i < count; i++) {
		const int object = s->setup.objects[targets[i].sentence];
		sum += contrast_loss(s->setup.contrast, s->setup.temperature, s->fg + i * REFER_D, s->words.e,
			       s->chosen_objects, s->chosen_count, object, times_of_others(s, object),
			       s->setup.lambda / count, s->dfg + i * REFER_D, s->words.de, s->score) /
		       count;
	}
	fold_top_back(s->fold, s->dfg, &s->model);
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
	fold_scores_back(s->fold, s->total + s->at[DUH], s->total + s->at[DUQ], s->total + s->at[DK],
		s->total + s->at[DGRAM], s->total + s->at[DM0], &s->model);
	s->arrays.dx = dx;
	clear_parts(s, DY, DY);
	clear_parts(s, DP_GRAM, DPOSITION1_BIAS);
	run_phase(s, STEP_HIDDEN_BACK);
	add_chunks(s, DY, DY);
	add_chunks(s, DP_GRAM, DPOSITION1_BIAS);
	for (int i = 0; i < 4; i++) {
		add_tensor(s, DFEATURE0 + (enum part)i, FEATURE_0_WEIGHT + (enum refer_tensor)i, gradient);
		add_tensor(s, DPOSITION0 + (enum part)i, POSITION_0_WEIGHT + (enum refer_tensor)i, gradient);
	}
	fold_end(s->fold, s->total + s->at[DY], s->total + s->at[DP_GRAM], gradient, s->dvectors);
	phase_ended(s, STEP_FOLD);
	text_mlp_back_begin(&s->words, parameters, gradient, has_contrast);
	for (int i = 0; i < count; i++)
		text_mlp_back_vectors(
			&s->words, parameters, gradient, s->places[i], s->dvectors + s->first[i] * REFER_D);
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

/* The sentences of the step: all, or the targets, those of their objects, and the others that are named. */
static void choose_sentences(struct step *s, const struct step_target *targets, int count, int is_contrasted,
	const struct step_others *others)
{
	const int *objects = s->setup.objects;

	s->chosen_count = 0;
	memset(s->is_chosen, 0, s->setup.sentences);
	for (int i = 0; i < count; i++)
		s->places[i] = is_contrasted && !others ? targets[i].sentence : (size_t)i;
	for (int i = 0; i < count && (!is_contrasted || others); i++)
		choose(s, targets[i].sentence);
	for (size_t r = 0; r < s->setup.sentences && is_contrasted; r++) {
		int is_own = !others;
		for (int i = 0; i < count && !is_own; i++)
			is_own = objects[r] == objects[targets[i].sentence];
		if (is_own)
			choose(s, r);
	}
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
		memset(s->arrays.top, 0, sizeof(float) * s->padded * (size_t)count);
		fold_top_back(s->fold, NULL, &s->model);
	}
	backward(s, parameters, count, gradient, dx);
	losses.total = losses.bce + s->setup.lambda * losses.contrast;
	return losses;
}

void step_respond(struct step *s, const float *parameters, const float *x, size_t sentence, float *m)
{
	s->places[0] = 0;
	text_mlp_choose(&s->words, &sentence, 1);
	text_mlp_hidden(&s->words, parameters);
	forward(s, parameters, x, 1);
	channel_get(s->arrays.m, s->padded, 1, 0, s->response);
	memcpy(m, s->response, sizeof *m * s->setup.gaussians);
}
