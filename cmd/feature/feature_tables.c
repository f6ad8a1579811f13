#include "cmd/feature/feature_lifting.h"

#include "base/compare.h"
#include "base/mem.h"
#include "formats/images/png.h"
#include "lift/source_weights.h"
#include "mask/rle.h"

#include <math.h>
#include <stdio.h>

enum { LABELS = 1 << 16 }; /* what 16 bits have */

static char *view_path(const struct feature_maps *m, size_t view, const char *suffix, struct err *e)
{
	return file_join(m->options->folder, m->scene->cameras.views[view].name, suffix, e);
}

/* Whether a map has the shape of its view. Cells may be of a picture that was made square for a network: only
 * those that lie across are refused. */
static int check_shape(const struct feature_maps *m, size_t view, const char *path, size_t rows,
	size_t columns, struct err *e)
{
	const struct camera *c = &m->scene->cameras.views[view];
	const int64_t h = (int64_t)rows, w = (int64_t)columns;

	if (m->kind == MAPS_CELLS && !rle_has_shape(w, h, c->height, c->width))
		return 0;
	return rle_check_shape("a map", h, w, "the view", c->height, c->width, e) ? err_prefix(e, path) : 0;
}

/* Whether sizes are those of a map (C,H,W), as PyTorch has them: the last two are the view's shape or a
 * square, and the first two are not. */
static int is_channels_first(const struct npy *t, const struct camera *c)
{
	const int64_t a = (int64_t)t->shape[0], b = (int64_t)t->shape[1], d = (int64_t)t->shape[2];

	return a != b && !rle_has_shape(a, b, c->height, c->width) &&
	       (b == d || rle_has_shape(b, d, c->height, c->width));
}

/* A table of features: VIEW.npy (H,W,C), or VIEW_f.npy (N,C). */
static int check_table(const struct npy *t, int dims, const char *path, struct err *e)
{
	size_t rows = 1;

	if (t->dims != dims)
		return err_set(e, ERR_FORMAT, "%s: has %d dimensions, not %d: %s", path, t->dims, dims,
			dims == 3 ? "height, width and channels" : "segments and channels");
	for (int k = 0; k < dims - 1; k++)
		if (mem_size(rows, t->shape[k], &rows) || rows > INT32_MAX)
			return err_set(e, ERR_FORMAT, "%s: more than %d features", path, INT32_MAX);
	if (t->shape[dims - 1] < 1 || t->shape[dims - 1] > FEATURES_MAX_CHANNELS)
		return err_set(e, ERR_FORMAT, "%s: %zu channels, not 1 to %d", path, t->shape[dims - 1],
			FEATURES_MAX_CHANNELS);
	if (dims == 3 && !rows)
		return err_set(e, ERR_FORMAT, "%s: a map of no pixels", path);
	return 0;
}

/* The view's array with this suffix, and how messages name it; of VIEW.npz `features`, or the one that
 * numpy.savez gives no name. */
static int open_array(const struct feature_maps *m, size_t view, const char *suffix, struct npy *t,
	char **called, struct err *e)
{
	static const char *const names[2] = {"features", "arr_0"};
	char ending[16];

	*called = NULL;
	if (m->is_npz)
		return npz_array(&m->npz, m->scene->cameras.views[view].name, suffix, t, called, e);
	snprintf(ending, sizeof ending, "%s.npy", suffix);
	char *path = *called = view_path(m, view, ending, e);
	SCOPED char *packed = view_path(m, view, ".npz", e);
	if (path && packed && !*suffix && !file_exists(path) && file_exists(packed)) {
		free(path);
		*called = NULL;
		return npz_open_main(packed, names, t, called, e);
	}
	return !path || !packed || npy_open(t, path, e);
}

static int open_table(
	const struct feature_maps *m, size_t view, struct npy *t, size_t *channels, struct err *e)
{
	const int is_map = m->kind == MAPS_CELLS;
	SCOPED char *called = NULL;

	if (open_array(m, view, is_map ? "" : "_f", t, &called, e) ||
		check_table(t, is_map ? 3 : 2, called, e) ||
		(is_map && check_shape(m, view, called, t->shape[0], t->shape[1], e)))
		return -1;
	*channels = t->shape[t->dims - 1];
	if (is_map && is_channels_first(t, &m->scene->cameras.views[view]))
		return err_set(e, ERR_FORMAT,
			"%s: %zux%zux%zu is channels, height and width, as it seems: transpose it (in NumPy by (1, 2, 0))",
			called, t->shape[0], t->shape[1], t->shape[2]);
	return 0;
}

int feature_tables_channels(const struct feature_maps *m, size_t view, size_t *channels, struct err *e)
{
	SCOPED_BY(npy_close) struct npy t = {0};

	if (m->kind != MAPS_CELLS && m->kind != MAPS_SEGMENTS)
		return 0;
	return open_table(m, view, &t, channels, e) ? -1 : 0;
}

/* The segments' numbers at a view's pixels, of one level of (L,H,W), or of (H,W). */
static int read_ids(const struct feature_maps *m, size_t view, const struct npy *ids, const char *path,
	int height, int width, struct feature_sources *s, struct err *e)
{
	const size_t level = (size_t)m->options->level, pixels = (size_t)height * (size_t)width;
	const size_t levels = ids->dims == 3 ? ids->shape[0] : 1, rows = s->table.shape[0];
	const size_t *shape = ids->shape + (ids->dims == 3);
	size_t cells;

	if (ids->dims != 2 && ids->dims != 3)
		return err_set(e, ERR_FORMAT, "%s: has %d dimensions, not 3: levels, height and width", path,
			ids->dims);
	if (level >= levels)
		return err_set(e, ERR_FORMAT, "%s: has %zu levels, so none is %zu", path, levels, level);
	if (mem_size(shape[0], shape[1], &cells) || cells > INT32_MAX || !cells)
		return err_set(e, ERR_FORMAT, "%s: %zux%zu pixels, not 1 to %d altogether", path, shape[1],
			shape[0], INT32_MAX);
	if (check_shape(m, view, path, shape[0], shape[1], e))
		return -1;
	source_cells(s->raw, height, width, shape[0], shape[1]);
	for (size_t p = 0; p < pixels; p++) {
		const size_t cell = (size_t)s->raw[p];
		const double id = npy_value(ids, level * cells + cell);
		if (!(id >= -1 && id < (double)rows) || id != floor(id))
			return err_set(e, ERR_FORMAT,
				"%s: level %zu, row %zu, column %zu is %g, not a whole number from -1 to %zd",
				path, level, cell / shape[1], cell % shape[1], id, (ssize_t)rows - 1);
		s->raw[p] = (int32_t)id;
	}
	return 0;
}

static int open_segments(const struct feature_maps *m, size_t view, int height, int width,
	struct feature_sources *s, struct err *e)
{
	SCOPED_BY(npy_close) struct npy ids = {0};
	SCOPED char *called = NULL;

	return open_array(m, view, "_s", &ids, &called, e) ||
	       read_ids(m, view, &ids, called, height, width, s, e);
}

static int open_features(const struct feature_maps *m, size_t view, int height, int width,
	struct feature_sources *s, size_t *rows, struct err *e)
{
	const char *name = m->scene->cameras.views[view].name;
	size_t channels;

	if (open_table(m, view, &s->table, &channels, e))
		return -1;
	if (channels != m->channels)
		return err_set(e, ERR_FORMAT, "%s: view '%s' has %zu channels, the views before it have %zu",
			m->options->folder, name, channels, m->channels);
	*rows = s->table.shape[0];
	if (m->kind == MAPS_SEGMENTS)
		return open_segments(m, view, height, width, s, e);
	*rows *= s->table.shape[1];
	source_cells(s->raw, height, width, s->table.shape[0], s->table.shape[1]);
	return 0;
}

static int open_labels(const struct feature_maps *m, size_t view, int height, int width,
	struct feature_sources *s, struct err *e)
{
	SCOPED char *path = view_path(m, view, ".png", e);
	SCOPED int32_t *labels = NULL;
	int own[2];

	if (!path || png_read_labels(path, &labels, &own[0], &own[1], e) ||
		check_shape(m, view, path, own[0], own[1], e))
		return -1;
	source_cells(s->raw, height, width, (size_t)own[0], (size_t)own[1]);
	for (size_t p = 0, n = (size_t)height * (size_t)width; p < n; p++)
		s->raw[p] = labels[s->raw[p]];
	return 0;
}

static int paint(const struct feature_maps *m, size_t at, int height, int width, struct feature_sources *s,
	struct err *e)
{
	const size_t pixels = (size_t)height * (size_t)width;

	if (m->row[at] < 0)
		return 0;
	if (rle_decode_at(&m->set.items[at].rle, height, width, s->mask, e))
		return -1;
	for (size_t p = 0; p < pixels; p++)
		if (s->mask[p])
			s->raw[p] = m->row[at];
	return 0;
}

/* The surest mask is on top, of equally sure ones the later. */
static int paint_masks(const struct feature_maps *m, size_t view, int height, int width,
	struct feature_sources *s, struct err *e)
{
	const size_t pixels = (size_t)height * (size_t)width;
	size_t begin, end;

	mask_index_view(&m->index, m->scene->cameras.views[view].name, &begin, &end);
	SCOPED struct ranked *order = mem_alloc(end - begin, sizeof *order, "masks", e);
	int bad = !order || mem_room((void **)&s->mask, &s->mask_room, pixels, 1, "mask", e);
	for (size_t k = begin; k < end && order; k++) {
		const size_t at = m->index.keys[k].at;
		order[k - begin] = (struct ranked){mask_confidence(&m->set.items[at]), at};
	}
	if (order)
		qsort(order, end - begin, sizeof *order, ranked_rising);
	for (size_t p = 0; p < pixels; p++)
		s->raw[p] = m->kind == MAPS_MASKS ? -1 : 0;
	for (size_t k = 0; k < end - begin && !bad; k++)
		bad = paint(m, order[k].at, height, width, s, e);
	return bad ? -1 : 0;
}

int feature_tables_open(const struct feature_maps *m, size_t view, int height, int width,
	struct feature_sources *s, size_t *rows, struct err *e)
{
	npy_close(&s->table);
	switch (m->kind) {
	case MAPS_LABELS:
		*rows = LABELS;
		return open_labels(m, view, height, width, s, e);
	case MAPS_MASKS:
		*rows = m->text.n;
		return paint_masks(m, view, height, width, s, e);
	case MAPS_MASK_LABELS:
		*rows = m->set.n + 1;
		return paint_masks(m, view, height, width, s, e);
	default:
		return open_features(m, view, height, width, s, rows, e);
	}
}

/* All channels of a source. */
static void read_row(const struct feature_maps *m, const struct feature_sources *s, size_t row, float *to)
{
	if (row == FEATURES_ZERO)
		memset(to, 0, m->channels * sizeof *to);
	else if (m->kind == MAPS_MASKS)
		memcpy(to, m->text.sentences + row * m->channels, m->channels * sizeof *to);
	else
		npy_floats(&s->table, row * m->channels, m->channels, to);
}

/* 1 / |x|, 0 for a length of 0; NaN where a number is not finite. */
static double one_over_length(const float *x, size_t n)
{
	double sum = 0;

	for (size_t i = 0; i < n; i++)
		sum += (double)x[i] * (double)x[i];
	if (!isfinite(sum))
		return NAN;
	return sum > 0 ? 1 / sqrt(sum) : 0;
}

int feature_maps_features(const struct feature_maps *m, const struct feature_sources *s, size_t first,
	size_t n, float *features, double *factor, struct err *e)
{
	size_t bad = s->count;
	int is_out = 0;

#pragma omp parallel reduction(min : bad) reduction(| : is_out)
	{
		struct err own;
		SCOPED float *row = mem_alloc(m->channels, sizeof *row, "features", &own);
		is_out = !row;
#pragma omp for schedule(static)
		for (size_t k = 0; k < s->count; k++) {
			if (!row)
				continue;
			read_row(m, s, s->row[k], row);
			factor[k] = one_over_length(row, m->channels);
			memcpy(features + k * n, row + first, n * sizeof *row);
			if (isnan(factor[k]) && k < bad)
				bad = k;
		}
	}
	if (is_out)
		return err_set(e, ERR_SYSTEM, "features: out of memory");
	return bad < s->count ? err_set(e, ERR_FORMAT, "feature %zu is not finite", s->row[bad]) : 0;
}
