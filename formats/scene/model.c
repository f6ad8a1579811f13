#include "formats/scene/model.h"

#include "base/mem.h"
#include "formats/arrays/arrays_in.h"
#include "mask/bits.h"

#include <math.h>
#include <stdio.h>

enum { VERSION_READ = 3 };

void model_free(struct model *m)
{
	octree_free(&m->octree);
	mem_free_all(m->ids, m->features, m->parameters);
	*m = (struct model){0};
}

/* A metadata value that `parse` knows. */
static int read_choice(struct arrays_in *in, const char *key, int (*parse)(const char *))
{
	const char *text = safetensors_meta(in->st, key);
	const int value = text ? parse(text) : -1;

	if (value < 0 && !in->bad)
		in->bad = err_file(in->e, in->st->path, "metadata '%s' is '%s'", key, text ? text : "");
	return value;
}

static void read_bounds(struct model *m, struct arrays_in *in)
{
	const char *text = safetensors_meta(in->st, "bounds");
	int end = 0, is_fine = 1;

	if (in->bad)
		return;
	if (!text ||
		sscanf(text, "[[%lf,%lf,%lf],[%lf,%lf,%lf]]%n", &m->low[0], &m->low[1], &m->low[2],
			&m->high[0], &m->high[1], &m->high[2], &end) != 6 ||
		!end || text[end]) {
		in->bad = err_file(in->e, in->st->path, "metadata 'bounds' is not two corners");
		return;
	}
	for (int k = 0; k < 3; k++)
		is_fine &= isfinite(m->low[k]) && isfinite(m->high[k]) && m->low[k] < m->high[k];
	if (!is_fine)
		in->bad = err_file(in->e, in->st->path, "metadata 'bounds' is not low < high");
}

/* The Gaussians of the scene that have a row of features each. */
static void read_ids(struct model *m, struct arrays_in *in)
{
	m->ids = arrays_in_vector(in, "ids", ST_I32, -1, &m->n);
	m->learning = m->n;
	for (size_t i = 0; i < m->n && !in->bad; i++)
		if (m->ids[i] < 0 || (size_t)m->ids[i] >= m->scene_gaussians ||
			(i && m->ids[i] <= m->ids[i - 1]))
			in->bad = err_file(in->e, in->st->path,
				"tensor 'ids': item %zu does not rise within 0 to %lld", i,
				(long long)m->scene_gaussians - 1);
}

static void read_root(struct octree *t, struct arrays_in *in)
{
	const char *text = safetensors_meta(in->st, "root");
	int end = 0;

	if (in->bad)
		return;
	if (!text ||
		sscanf(text, "[[%lf,%lf,%lf],%lf]%n", &t->low[0], &t->low[1], &t->low[2], &t->edge, &end) !=
			4 ||
		!end || text[end])
		in->bad = err_file(in->e, in->st->path, "metadata 'root' is not a corner and an edge");
	else if (!isfinite(t->low[0]) || !isfinite(t->low[1]) || !isfinite(t->low[2]) || !isfinite(t->edge) ||
		 !(t->edge > 0))
		in->bad = err_file(in->e, in->st->path, "metadata 'root' is not finite with an edge above 0");
}

/* The Gaussians that have a row, of those in the leaves: a bit of each of the scene's. Before version 3 there
 * were none, and all in a leaf had its row. */
static void read_learning(struct model *m, struct arrays_in *in)
{
	const size_t n = m->scene_gaussians;
	const uint8_t *bits = arrays_in_place(in, "learning", ST_U8, (int64_t)bits_bytes(n), NULL);

	m->ids = bits ? mem_alloc(n, sizeof *m->ids, in->st->path, in->e) : NULL;
	in->bad |= !m->ids;
	for (size_t i = 0; i < 8 * bits_bytes(n) && !in->bad; i++) {
		if (!(bits[i / 8] >> i % 8 & 1))
			continue;
		if (i < n)
			m->ids[m->learning++] = (int32_t)i;
		else
			in->bad = err_file(in->e, in->st->path,
				"tensor 'learning': bit %zu is set, of %zu Gaussians", i, n);
	}
}

/* The leaves whose Gaussians share a row of features. */
static void read_leaves(struct model *m, struct arrays_in *in)
{
	size_t wrong;

	m->octree.codes = arrays_in_vector(in, "leaves", ST_I64, -1, &m->n);
	m->octree.n = m->n;
	read_root(&m->octree, in);
	if (!in->bad && octree_check(&m->octree, &wrong))
		in->bad = err_file(in->e, in->st->path,
			"tensor 'leaves': item %zu is not a leaf after the one before", wrong);
	if (safetensors_find(in->st, "learning"))
		read_learning(m, in);
}

/* Vectors are few numbers, and exact whatever the precision. */
static int is_vector(int tensor)
{
	return tensor % 2 || tensor >= NORM_WEIGHT;
}

static void read_parameters(struct model *m, struct arrays_in *in)
{
	m->parameters = in->bad ? NULL : mem_alloc(m->layout.count, sizeof(float), in->st->path, in->e);
	in->bad |= !m->parameters;
	for (int t = 0; t < REFER_TENSORS && !in->bad; t++) {
		const size_t rows = (size_t)m->layout.tensors[t].rows,
			     columns = (size_t)m->layout.tensors[t].columns;
		const char *name = m->layout.tensors[t].name;
		float *to = m->parameters + m->layout.tensors[t].offset;
		if (rows && !is_vector(t)) {
			in->bad = precision_get(
				in->st, name, m->precision, PRECISION_ROWS, rows, columns, to, in->e);
		} else if (rows) {
			arrays_in_fill(in, name, to, rows);
		}
	}
}

/* What the first layer of a network takes, which all other shapes follow from: 1 to `most` columns. */
static int read_width(const struct model *m, struct arrays_in *in, const char *name, int rows, int most)
{
	const int64_t shape[] = {rows, -1};
	const struct st_tensor *first =
		in->bad ? NULL
			: safetensors_need(in->st, name, precision_dtype(m->precision), 2, shape, in->e);

	in->bad |= !first;
	if (first && (first->shape[1] < 1 || first->shape[1] > most))
		in->bad = err_file(in->e, in->st->path, "tensor '%s': %lld columns, expected 1 to %d", name,
			(long long)first->shape[1], most);
	return in->bad ? 0 : (int)first->shape[1];
}

static int read_all(struct model *m, const struct safetensors *st, struct err *e)
{
	struct arrays_in in;

	arrays_in_begin(&in, st, "refer.model", VERSION_READ, e);
	const int interaction = read_choice(&in, "interaction", refer_interaction_parse);
	m->similarity = (enum refer_similarity)read_choice(&in, "similarity", refer_similarity_parse);
	/* Where nothing is said, it is words, and logits. */
	if (safetensors_meta(st, "query"))
		m->query = (enum refer_query)read_choice(&in, "query", refer_query_parse);
	if (safetensors_meta(st, "blend"))
		m->blend = (enum refer_blend)read_choice(&in, "blend", refer_blend_parse);
	/* Version 1 had single precision only, and no word of it. */
	if (safetensors_meta(st, "precision"))
		m->precision = (enum precision)read_choice(&in, "precision", precision_parse);
	const int text = read_width(m, &in, "text.0.weight", REFER_T1, 65536),
		  feature = read_width(m, &in, "feature.0.weight", REFER_XH, REFER_MAX_X);
	if (in.bad || origin_read(&m->origin, st, e))
		return -1;
	refer_layout_init(&m->layout, (enum refer_interaction)interaction, text, feature);
	read_bounds(m, &in);
	m->scene_gaussians = arrays_in_count(&in, "gaussians");
	m->has_leaves = safetensors_find(st, "leaves") != NULL;
	(m->has_leaves ? read_leaves : read_ids)(m, &in);
	m->features = in.bad ? NULL : mem_alloc(m->n, (size_t)feature * sizeof *m->features, st->path, e);
	in.bad = !m->features || precision_get(st, "features", m->precision, PRECISION_COLUMNS, m->n,
					 (size_t)feature, m->features, e);
	read_parameters(m, &in);
	return in.bad ? -1 : 0;
}

int model_take(struct model *m, const struct safetensors *st, struct err *e)
{
	*m = (struct model){0};
	return read_all(m, st, e);
}

int model_read(struct model *m, const char *path, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	*m = (struct model){0};
	if (safetensors_open(&st, path, e))
		return -1;
	return model_take(m, &st, e);
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
	arrays_out_text(&out, "query", refer_query_name(m->query));
	arrays_out_text(&out, "blend", refer_blend_name(m->blend));
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
