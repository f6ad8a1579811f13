#include "formats/model.h"

#include "base/mem.h"
#include "formats/safetensors.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void model_free(struct model *m)
{
	free(m->ids);
	octree_free(&m->octree);
	free(m->features);
	free(m->parameters);
	*m = (struct model){0};
}

/* A metadata value that `parse` knows, or an error that names the key. */
static int read_choice(
	const struct safetensors *st, const char *key, int (*parse)(const char *), int *value, struct err *e)
{
	const char *text = safetensors_meta(st, key);

	*value = text ? parse(text) : -1;
	if (*value < 0)
		return err_set(e, ERR_FORMAT, "%s: metadata '%s' is '%s'", st->path, key, text ? text : "");
	return 0;
}

static int read_bounds(struct model *m, const struct safetensors *st, struct err *e)
{
	const char *text = safetensors_meta(st, "bounds");
	int end = 0;

	if (!text ||
		sscanf(text, "[[%lf,%lf,%lf],[%lf,%lf,%lf]]%n", &m->low[0], &m->low[1], &m->low[2],
			&m->high[0], &m->high[1], &m->high[2], &end) != 6 ||
		!end || text[end])
		return err_set(e, ERR_FORMAT, "%s: metadata 'bounds' is not two corners", st->path);
	for (int k = 0; k < 3; k++)
		if (!isfinite(m->low[k]) || !isfinite(m->high[k]) || !(m->low[k] < m->high[k]))
			return err_set(e, ERR_FORMAT, "%s: metadata 'bounds' is not low < high", st->path);
	return 0;
}

static int read_ids(struct model *m, const struct safetensors *st, const struct st_tensor *ids, struct err *e)
{
	const int32_t *from = ids->data;

	m->n = (size_t)ids->shape[0];
	m->ids = mem_alloc(m->n, sizeof *m->ids, st->path, e);
	if (!m->ids)
		return -1;
	memcpy(m->ids, from, ids->bytes);
	for (size_t i = 0; i < m->n; i++)
		if (from[i] < 0 || (size_t)from[i] >= m->scene_gaussians || (i && from[i] <= from[i - 1]))
			return err_set(e, ERR_FORMAT,
				"%s: tensor 'ids': item %zu does not rise within 0 to %lld", st->path, i,
				(long long)m->scene_gaussians - 1);
	return 0;
}

static int read_octree(struct model *m, const struct safetensors *st, struct err *e)
{
	const struct st_tensor *leaves = safetensors_need(st, "leaves", ST_I64, 1, (int64_t[]){-1}, e);
	const char *text = safetensors_meta(st, "root");
	struct octree *t = &m->octree;
	int end = 0;
	size_t bad;

	if (!leaves)
		return -1;
	if (!text ||
		sscanf(text, "[[%lf,%lf,%lf],%lf]%n", &t->low[0], &t->low[1], &t->low[2], &t->edge, &end) !=
			4 ||
		!end || text[end])
		return err_set(e, ERR_FORMAT, "%s: metadata 'root' is not a corner and an edge", st->path);
	if (!isfinite(t->low[0] + t->low[1] + t->low[2] + t->edge) || !(t->edge > 0))
		return err_set(
			e, ERR_FORMAT, "%s: metadata 'root' is not finite with an edge above 0", st->path);
	m->n = t->n = (size_t)leaves->shape[0];
	t->codes = mem_alloc(t->n, sizeof *t->codes, st->path, e);
	if (!t->codes)
		return -1;
	memcpy(t->codes, leaves->data, leaves->bytes);
	if (octree_check(t, &bad))
		return err_set(e, ERR_FORMAT,
			"%s: tensor 'leaves': item %zu is not a leaf after the one before", st->path, bad);
	return 0;
}

static int read_features(struct model *m, const struct safetensors *st, struct err *e)
{
	long long scene;
	const int has_leaves = safetensors_find(st, "leaves") != NULL;
	const struct st_tensor *ids =
		has_leaves ? NULL : safetensors_need(st, "ids", ST_I32, 1, (int64_t[]){-1}, e);

	if ((!ids && !has_leaves) || safetensors_meta_int(st, "gaussians", 0, INT32_MAX, &scene, e))
		return -1;
	m->scene_gaussians = (size_t)scene;
	if (has_leaves ? read_octree(m, st, e) : read_ids(m, st, ids, e))
		return -1;
	const struct st_tensor *x =
		safetensors_need(st, "features", ST_F32, 2, (int64_t[]){(int64_t)m->n, REFER_X}, e);
	if (!x)
		return -1;
	m->features = mem_alloc(m->n, sizeof(float) * REFER_X, st->path, e);
	if (!m->features)
		return -1;
	memcpy(m->features, x->data, x->bytes);
	for (size_t i = 0; i < m->n * REFER_X; i++)
		if (!isfinite(m->features[i]))
			return err_set(
				e, ERR_FORMAT, "%s: tensor 'features': item %zu is not finite", st->path, i);
	return 0;
}

static int read_parameters(struct model *m, const struct safetensors *st, struct err *e)
{
	m->parameters = mem_alloc(m->layout.count, sizeof(float), st->path, e);
	if (!m->parameters)
		return -1;
	for (int t = 0; t < REFER_TENSORS; t++) {
		const int rows = m->layout.tensors[t].rows, is_bias = t % 2 || t >= NORM_WEIGHT;
		if (!rows)
			continue;
		const struct st_tensor *tensor = safetensors_need(st, m->layout.tensors[t].name, ST_F32,
			is_bias ? 1 : 2, (int64_t[]){rows, m->layout.tensors[t].columns}, e);
		if (!tensor)
			return -1;
		float *to = m->parameters + m->layout.tensors[t].offset;
		memcpy(to, tensor->data, tensor->bytes);
		for (size_t i = 0; i < tensor->bytes / sizeof(float); i++)
			if (!isfinite(to[i]))
				return err_set(e, ERR_FORMAT, "%s: tensor '%s': item %zu is not finite",
					st->path, tensor->name, i);
	}
	return 0;
}

static int read_all(struct model *m, const struct safetensors *st, struct err *e)
{
	int interaction, similarity;
	const struct st_tensor *first;

	if (safetensors_need_format(st, "refer.model", 1, e) ||
		read_choice(st, "interaction", refer_interaction_parse, &interaction, e) ||
		read_choice(st, "similarity", refer_similarity_parse, &similarity, e) ||
		!(first = safetensors_need(st, "text.0.weight", ST_F32, 2, (int64_t[]){REFER_T1, -1}, e)))
		return -1;
	if (first->shape[1] < 1 || first->shape[1] > 65536)
		return err_set(e, ERR_FORMAT, "%s: tensor 'text.0.weight': %lld columns, expected 1 to 65536",
			st->path, (long long)first->shape[1]);
	m->similarity = (enum refer_similarity)similarity;
	refer_layout_init(&m->layout, (enum refer_interaction)interaction, (int)first->shape[1]);
	return read_bounds(m, st, e) || read_features(m, st, e) || read_parameters(m, st, e) ? -1 : 0;
}

int model_read(struct model *m, const char *path, struct err *e)
{
	struct safetensors st;

	*m = (struct model){0};
	if (safetensors_open(&st, path, e))
		return -1;
	int bad = read_all(m, &st, e);
	safetensors_close(&st);
	if (bad)
		model_free(m);
	return bad;
}

int model_rows(const struct model *m, const float *means, struct rows *rows, struct err *e)
{
	return m->octree.n ? rows_of_leaves(rows, &m->octree, means, m->scene_gaussians, e)
			   : rows_of_ids(rows, m->ids, m->n, m->scene_gaussians, e);
}

int model_write(const struct model *m, const char *path, const char *options, long long seed, struct err *e)
{
	struct st_tensor tensors[REFER_TENSORS + 2] = {m->octree.n ? (struct st_tensor){.name = "leaves",
									     .dtype = ST_I64,
									     .dims = 1,
									     .shape = {(int64_t)m->n},
									     .data = m->octree.codes}
								   : (struct st_tensor){.name = "ids",
									     .dtype = ST_I32,
									     .dims = 1,
									     .shape = {(int64_t)m->n},
									     .data = m->ids},
		{.name = "features",
			.dtype = ST_F32,
			.dims = 2,
			.shape = {(int64_t)m->n, REFER_X},
			.data = m->features}};
	char bounds[256], root[128], gaussians[32], seed_text[32];
	size_t n = 2;

	for (int t = 0; t < REFER_TENSORS; t++)
		if (m->layout.tensors[t].rows)
			tensors[n++] = (struct st_tensor){.name = m->layout.tensors[t].name,
				.dtype = ST_F32,
				.dims = t % 2 || t >= NORM_WEIGHT ? 1 : 2,
				.shape = {m->layout.tensors[t].rows, m->layout.tensors[t].columns},
				.data = m->parameters + m->layout.tensors[t].offset};
	snprintf(bounds, sizeof bounds, "[[%.17g,%.17g,%.17g],[%.17g,%.17g,%.17g]]", m->low[0], m->low[1],
		m->low[2], m->high[0], m->high[1], m->high[2]);
	snprintf(root, sizeof root, "[[%.17g,%.17g,%.17g],%.17g]", m->octree.low[0], m->octree.low[1],
		m->octree.low[2], m->octree.edge);
	snprintf(gaussians, sizeof gaussians, "%zu", m->scene_gaussians);
	snprintf(seed_text, sizeof seed_text, "%lld", seed);
	struct st_meta meta[] = {{"format", "refer.model"}, {"version", "1"}, {"tool", "refer-train"},
		{"options", options}, {"seed", seed_text},
		{"interaction", refer_interaction_name(m->layout.interaction)},
		{"similarity", refer_similarity_name(m->similarity)}, {"gaussians", gaussians},
		{"bounds", bounds}, {"root", root}};
	const size_t count = sizeof meta / sizeof *meta - (m->octree.n ? 0 : 1);
	return safetensors_write(path, tensors, n, meta, count, e);
}
