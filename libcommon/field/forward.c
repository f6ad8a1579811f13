#include "field/forward.h"

#include "base/mem.h"
#include "field/panels.h"

#include <math.h>
#include <omp.h>

enum { G = BLOCK_G, D = REFER_D };

static int alloc_arrays(struct forward *f, struct err *e)
{
	const struct forward_setup *u = &f->setup;
	const enum refer_interaction i = u->layout->interaction;
	const size_t batch = (size_t)u->batch, n = batch * (size_t)u->longest;
	const int attention = i != REFER_NONE && i != REFER_ADD;
	const size_t channels[6] = {
		G, refer_uses_position(i) ? G : 0, i >= REFER_PCMI ? n : 0, attention ? n : 0, batch, batch};
	float **arrays[6] = {&f->arrays.g, &f->arrays.r, &f->arrays.beta, &f->arrays.alpha, &f->arrays.m,
		&f->arrays.sigma};
	size_t all = 0, floats;

	for (int k = 0; k < 6; k++)
		all += channels[k];
	if (mem_size(all, f->padded, &floats))
		return err_set(e, ERR_SYSTEM, "%zu Gaussians do not fit in memory", u->gaussians);
	f->slab = mem_zalloc(floats, sizeof(float), "features", e);
	f->position = mem_alloc(f->padded, 3 * sizeof(float), "positions", e);
	if (!f->slab || !f->position)
		return -1;
	float *at = f->slab;
	for (int k = 0; k < 6; k++) {
		*arrays[k] = channels[k] ? at : NULL;
		at += channels[k] * f->padded;
	}
	panels_pack(u->position, u->gaussians, 3, f->position);
	f->arrays.position = f->position;
	return 0;
}

/* A chunk's sums: l_max and l_sum (n), c_sum (n,G), each on lines of cache of its own. */
static size_t chunk_part(size_t n)
{
	return (n + 15) / 16 * 16;
}

static int alloc_sums(struct forward *f, struct err *e)
{
	const size_t batch = (size_t)f->setup.batch, n = batch * (size_t)f->setup.longest;
	const size_t chunk = 2 * chunk_part(n) + chunk_part(n * G);
	const struct block_model largest = {.words = (int)n, .z_size = 2 * G + f->setup.longest};

	f->scratch_size = (block_scratch_floats(&largest) + 15) / 16 * 16;
	f->scratch = mem_zalloc((size_t)f->threads, f->scratch_size * sizeof(float), "scratch", e);
	f->chunks = mem_zalloc(FORWARD_CHUNKS, chunk * sizeof(float), "sums", e);
	f->total = mem_zalloc(n * (G + 2), sizeof(double), "sums", e);
	f->vectors = mem_zalloc(n, D * sizeof(float), "words", e);
	f->first = mem_zalloc(batch + 1, sizeof *f->first, "batch", e);
	if (!f->scratch || !f->chunks || !f->total || !f->vectors || !f->first)
		return -1;
	for (int c = 0; c < FORWARD_CHUNKS; c++) {
		f->sums[c].l_max = f->chunks + (size_t)c * chunk;
		f->sums[c].l_sum = f->sums[c].l_max + chunk_part(n);
		f->sums[c].c_sum = f->sums[c].l_sum + chunk_part(n);
	}
	return 0;
}

int forward_init(struct forward *f, const struct forward_setup *setup, struct err *e)
{
	*f = (struct forward){.setup = *setup};
	if (!f->setup.kernels)
		f->setup.kernels = block_select(NULL);
	f->padded = panels_padded(setup->gaussians);
	f->blocks = f->padded / BLOCK_SIZE;
	f->threads = omp_get_max_threads();
	if (alloc_arrays(f, e) || alloc_sums(f, e))
		return -1;
	f->fold = fold_new(setup->layout, setup->similarity, setup->longest, setup->batch, e);
	return f->fold ? 0 : -1;
}

void forward_free(struct forward *f)
{
	fold_free(f->fold);
	mem_free_all(f->first, f->vectors, f->slab, f->position, f->chunks, f->total, f->scratch);
	*f = (struct forward){0};
}

void forward_each_block(
	struct forward *f, void (*run)(void *data, size_t block, int chunk, float *scratch), void *data)
{
#pragma omp parallel for schedule(dynamic) num_threads(f->threads)
	for (int c = 0; c < FORWARD_CHUNKS; c++) {
		const size_t from = f->blocks * (size_t)c / FORWARD_CHUNKS;
		const size_t to = f->blocks * (size_t)(c + 1) / FORWARD_CHUNKS;
		float *scratch = f->scratch + (size_t)omp_get_thread_num() * f->scratch_size;
		for (size_t b = from; b < to; b++)
			run(data, b, c, scratch);
	}
}

void forward_fold(struct forward *f, const float *parameters, int count)
{
	fold_begin(f->fold, parameters, f->setup.gaussians, f->first, count, &f->model);
	fold_words(f->fold, f->vectors, &f->model);
}

static void hidden_block(void *data, size_t block, int chunk, float *scratch)
{
	struct forward *f = data;

	f->setup.kernels->hidden(&f->model, &f->arrays, block, &f->sums[chunk], scratch);
}

void forward_hidden(struct forward *f, const float *x)
{
	const size_t n = (size_t)f->model.words;

	f->arrays.x = x;
	for (int c = 0; c < FORWARD_CHUNKS; c++) {
		for (size_t j = 0; j < n; j++)
			f->sums[c].l_max[j] = -INFINITY;
		memset(f->sums[c].l_sum, 0, sizeof(float) * n);
		memset(f->sums[c].c_sum, 0, sizeof(float) * n * G);
	}
	forward_each_block(f, hidden_block, f);
}

/* A word's softmax over Gaussians from the chunks' running sums: row (G) = cbar, *l_max and *l_sum. */
static void join_word(const struct forward *f, int j, double *row, double *l_max, double *l_sum)
{
	double top = -INFINITY, sum = 0;

	memset(row, 0, sizeof *row * G);
	for (int c = 0; c < FORWARD_CHUNKS; c++)
		top = fmax(top, (double)f->sums[c].l_max[j]);
	for (int c = 0; c < FORWARD_CHUNKS; c++) {
		const double scale = exp((double)f->sums[c].l_max[j] - top);
		sum += scale * (double)f->sums[c].l_sum[j];
		for (int k = 0; k < G; k++)
			row[k] += scale * (double)f->sums[c].c_sum[j * G + k];
	}
	for (int k = 0; k < G; k++)
		row[k] /= sum;
	*l_max = top;
	*l_sum = sum;
}

void forward_scores(struct forward *f)
{
	const int n = f->model.words;
	double *l_max = f->total, *l_sum = l_max + n, *cbar = l_sum + n;

	for (int j = 0; j < n && f->model.has_words; j++)
		join_word(f, j, cbar + j * G, l_max + j, l_sum + j);
	fold_scores(f->fold, cbar, l_max, l_sum, &f->model);
}

static void respond_block(void *data, size_t block, int chunk, float *scratch)
{
	struct forward *f = data;

	(void)chunk, (void)scratch;
	f->setup.kernels->respond(&f->model, &f->arrays, block);
}

void forward_respond(struct forward *f)
{
	forward_each_block(f, respond_block, f);
}
