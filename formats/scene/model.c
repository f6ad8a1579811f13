#include "formats/scene/model.h"

#include "base/mem.h"
#include "formats/arrays/safetensors.h"
#include "mask/bits.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERSION_READ = 3 };

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
		return err_file(e, st->path, "metadata '%s' is '%s'", key, text ? text : "");
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
		return err_file(e, st->path, "metadata 'bounds' is not two corners");
	for (int k = 0; k < 3; k++)
		if (!isfinite(m->low[k]) || !isfinite(m->high[k]) || !(m->low[k] < m->high[k]))
			return err_file(e, st->path, "metadata 'bounds' is not low < high");
	return 0;
}

/* The Gaussians of the scene that have a row of features each. */
static int read_ids(struct model *m, const struct safetensors *st, struct err *e)
{
	if (!(m->ids = safetensors_copy(st, "ids", ST_I32, 1, (int64_t[]){-1}, &m->n, e)))
		return -1;
	m->learning = m->n;
	for (size_t i = 0; i < m->n; i++)
		if (m->ids[i] < 0 || (size_t)m->ids[i] >= m->scene_gaussians ||
			(i && m->ids[i] <= m->ids[i - 1]))
			return err_file(e, st->path, "tensor 'ids': item %zu does not rise within 0 to %lld",
				i, (long long)m->scene_gaussians - 1);
	return 0;
}

static int read_root(struct octree *t, const struct safetensors *st, struct err *e)
{
	const char *text = safetensors_meta(st, "root");
	int end = 0;

	if (!text ||
		sscanf(text, "[[%lf,%lf,%lf],%lf]%n", &t->low[0], &t->low[1], &t->low[2], &t->edge, &end) !=
			4 ||
		!end || text[end])
		return err_file(e, st->path, "metadata 'root' is not a corner and an edge");
	if (!isfinite(t->low[0]) || !isfinite(t->low[1]) || !isfinite(t->low[2]) || !isfinite(t->edge) ||
		!(t->edge > 0))
		return err_file(e, st->path, "metadata 'root' is not finite with an edge above 0");
	return 0;
}

/* The Gaussians that have a row, of those in the leaves: a bit of each of the scene's. Before version 3 there
 * were none, and all in a leaf had its row. */
static int read_learning(struct model *m, const struct safetensors *st, struct err *e)
{
	const size_t n = m->scene_gaussians;
	const int64_t bytes[] = {(int64_t)bits_bytes(n)};

	if (!safetensors_find(st, "learning"))
		return 0;
	const struct st_tensor *t = safetensors_need(st, "learning", ST_U8, 1, bytes, e);
	if (!t || !(m->ids = mem_alloc(n, sizeof *m->ids, st->path, e)))
		return -1;
	const uint8_t *bits = t->data;
	for (size_t i = 0; i < 8 * bits_bytes(n); i++)
		if (bits[i / 8] >> i % 8 & 1) {
			if (i >= n)
				return err_file(e, st->path,
					"tensor 'learning': bit %zu is set, of %zu Gaussians", i, n);
			m->ids[m->learning++] = (int32_t)i;
		}
	return 0;
}

/* The leaves whose Gaussians share a row of features. */
static int read_leaves(struct model *m, const struct safetensors *st, struct err *e)
{
	size_t bad;

	if (!(m->octree.codes = safetensors_copy(st, "leaves", ST_I64, 1, (int64_t[]){-1}, &m->n, e)) ||
		read_root(&m->octree, st, e))
		return -1;
	m->octree.n = m->n;
	if (octree_check(&m->octree, &bad))
		return err_file(
			e, st->path, "tensor 'leaves': item %zu is not a leaf after the one before", bad);
	return read_learning(m, st, e);
}

static int read_rows(struct model *m, const struct safetensors *st, struct err *e)
{
	long long scene;

	if (safetensors_meta_int(st, "gaussians", 0, INT32_MAX, &scene, e))
		return -1;
	m->scene_gaussians = (size_t)scene;
	m->has_leaves = safetensors_find(st, "leaves") != NULL;
	return m->has_leaves ? read_leaves(m, st, e) : read_ids(m, st, e);
}

static int read_features(struct model *m, const struct safetensors *st, struct err *e)
{
	const size_t width = (size_t)m->layout.feature_width;

	m->features = mem_alloc(m->n, sizeof(float) * width, st->path, e);
	return m->features ? precision_get(st, "features", m->precision, PRECISION_COLUMNS, m->n, width,
				     m->features, e)
			   : -1;
}

/* Vectors are few numbers, and exact whatever the precision. */
static int is_vector(int tensor)
{
	return tensor % 2 || tensor >= NORM_WEIGHT;
}

static int read_parameters(struct model *m, const struct safetensors *st, struct err *e)
{
	m->parameters = mem_alloc(m->layout.count, sizeof(float), st->path, e);
	if (!m->parameters)
		return -1;
	for (int t = 0; t < REFER_TENSORS; t++) {
		const int rows = m->layout.tensors[t].rows, columns = m->layout.tensors[t].columns;
		const char *name = m->layout.tensors[t].name;
		float *to = m->parameters + m->layout.tensors[t].offset;
		if (!rows)
			continue;
		if (!is_vector(t)) {
			if (precision_get(st, name, m->precision, PRECISION_ROWS, (size_t)rows,
				    (size_t)columns, to, e))
				return -1;
			continue;
		}
		const struct st_tensor *tensor = safetensors_need(st, name, ST_F32, 1, (int64_t[]){rows}, e);
		if (!tensor)
			return -1;
		memcpy(to, tensor->data, tensor->bytes);
		if (safetensors_check_finite(st, name, to, (size_t)rows, e))
			return -1;
	}
	return 0;
}

/* Version 1 had single precision only, and no word of it. */
static int read_precision(struct model *m, const struct safetensors *st, struct err *e)
{
	int precision = PRECISION_F32;

	if (safetensors_meta(st, "precision") && read_choice(st, "precision", precision_parse, &precision, e))
		return -1;
	m->precision = (enum precision)precision;
	return 0;
}

/* What the first layer of a network takes, which all other shapes follow from: 1 to `most` columns; -1 with
 * *e. */
static int read_width(const struct model *m, const struct safetensors *st, const char *name, int rows,
	int most, struct err *e)
{
	const struct st_tensor *first =
		safetensors_need(st, name, precision_dtype(m->precision), 2, (int64_t[]){rows, -1}, e);

	if (!first)
		return -1;
	if (first->shape[1] < 1 || first->shape[1] > most)
		return err_file(e, st->path, "tensor '%s': %lld columns, expected 1 to %d", name,
			(long long)first->shape[1], most);
	return (int)first->shape[1];
}

static int read_all(struct model *m, const struct safetensors *st, struct err *e)
{
	int interaction, similarity, text, feature;

	if (safetensors_need_format(st, "refer.model", VERSION_READ, e) ||
		read_choice(st, "interaction", refer_interaction_parse, &interaction, e) ||
		read_choice(st, "similarity", refer_similarity_parse, &similarity, e) ||
		read_precision(m, st, e) ||
		(text = read_width(m, st, "text.0.weight", REFER_T1, 65536, e)) < 0 ||
		(feature = read_width(m, st, "feature.0.weight", REFER_XH, REFER_MAX_X, e)) < 0)
		return -1;
	m->similarity = (enum refer_similarity)similarity;
	refer_layout_init(&m->layout, (enum refer_interaction)interaction, text, feature);
	return -(origin_read(&m->origin, st, e) || read_bounds(m, st, e) || read_rows(m, st, e) ||
		 read_features(m, st, e) || read_parameters(m, st, e));
}

int model_take(struct model *m, const struct safetensors *st, struct err *e)
{
	*m = (struct model){0};
	int bad = read_all(m, st, e);
	if (bad)
		model_free(m);
	return bad;
}

int model_read(struct model *m, const char *path, struct err *e)
{
	struct safetensors st;

	*m = (struct model){0};
	if (safetensors_open(&st, path, e))
		return -1;
	int bad = model_take(m, &st, e);
	safetensors_close(&st);
	return bad;
}

int model_rows(const struct model *m, const float *means, struct rows *rows, struct err *e)
{
	return m->has_leaves
		       ? rows_of_leaves(rows, &m->octree, means, m->scene_gaussians, m->ids, m->learning, e)
		       : rows_of_ids(rows, m->ids, m->n, m->scene_gaussians, e);
}

/* Which Gaussians have a row, where it is the leaf's that they lie in. */
static void put_learning(struct arrays_out *out, const struct model *m)
{
	const size_t bytes = bits_bytes(m->scene_gaussians);
	uint8_t *bits = arrays_out_memory(out, bytes, 1);

	if (bits)
		memset(bits, 0, bytes);
	for (size_t i = 0; i < m->learning && bits; i++)
		bits[m->ids[i] / 8] |= (uint8_t)(1 << m->ids[i] % 8);
	arrays_out_put(out, st_vector("learning", ST_U8, (int64_t)bytes, bits));
}

static void put_tensors(struct arrays_out *out, const struct model *m)
{
	arrays_out_put(out, m->has_leaves ? st_vector("leaves", ST_I64, (int64_t)m->n, m->octree.codes)
					  : st_vector("ids", ST_I32, (int64_t)m->n, m->ids));
	if (m->has_leaves && m->ids)
		put_learning(out, m);
	precision_put(out, "features", m->precision, PRECISION_COLUMNS, m->n, (size_t)m->layout.feature_width,
		m->features);
	for (int t = 0; t < REFER_TENSORS; t++) {
		const size_t rows = (size_t)m->layout.tensors[t].rows,
			     columns = (size_t)m->layout.tensors[t].columns;
		const float *from = m->parameters + m->layout.tensors[t].offset;
		if (rows && is_vector(t))
			precision_put_vector(out, m->layout.tensors[t].name, rows, from);
		else if (rows)
			precision_put(out, m->layout.tensors[t].name, m->precision, PRECISION_ROWS, rows,
				columns, from);
	}
}

int model_write(const struct model *m, const char *path, const char *options, long long seed, struct err *e)
{
	const double *low = m->low, *high = m->high, *root = m->octree.low;
	struct arrays_out out;

	arrays_out_begin(&out, path, "refer.model", "3", "refer-train", options, seed, e);
	arrays_out_text(&out, "interaction", refer_interaction_name(m->layout.interaction));
	arrays_out_text(&out, "similarity", refer_similarity_name(m->similarity));
	arrays_out_text(&out, "precision", precision_name(m->precision));
	arrays_out_text(&out, "gaussians", arrays_out_print(&out, "%zu", m->scene_gaussians));
	origin_put(&out, &m->origin);
	arrays_out_text(&out, "bounds",
		arrays_out_print(&out, "[[%.17g,%.17g,%.17g],[%.17g,%.17g,%.17g]]", low[0], low[1], low[2],
			high[0], high[1], high[2]));
	if (m->has_leaves)
		arrays_out_text(&out, "root",
			arrays_out_print(&out, "[[%.17g,%.17g,%.17g],%.17g]", root[0], root[1], root[2],
				m->octree.edge));
	put_tensors(&out, m);
	return arrays_out_end(&out);
}
