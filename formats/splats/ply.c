#include "formats/splats/ply.h"

#include "base/little.h"
#include "base/mem.h"
#include "formats/records/foreign.h"
#include "formats/splats/plyfile.h"
#include "formats/splats/plypacked.h"

#include <math.h>
#include <stdio.h>

/* A reader's slots: the properties every 3DGS file has, in this order, then f_rest_0 and on. */
static const char *const fixed_names[ROW_REST] = {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
	"scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"};

struct layout {
	long slot[ROW_MAX]; /* property index of each */
	int rest;	    /* number of f_rest properties: 3 (K-1) */
};

/* Where the rows come from: the usual layout, or packed ones, which are unpacked to that of fixed_names. */
struct source {
	struct plyfile *file;
	const struct plyfile_element *vertex;
	struct layout layout;
	int is_packed;
	double range[3][2]; /* of opacities, of all scales, and of all colours, as they are written */
	size_t small;	    /* scales below a half */
	struct plypacked packed;
	double *row; /* in the file's order; unused where packed */
	/* Of a file that is like another one: NULL where none is. */
	const struct ply_like *like;
	size_t moves[7];    /* where a row has its mean and its rotation */
	size_t (*stays)[2]; /* (stay_count) where it has the rest: from, to */
	size_t stay_count;
};

static int find_layout(
	struct layout *l, const struct plyfile *f, const struct plyfile_element *el, struct err *e)
{
	char name[32];

	for (int i = 0; i < ROW_REST; i++) {
		l->slot[i] = plyfile_need(f, el, fixed_names[i], e);
		if (l->slot[i] < 0)
			return -1;
	}
	l->rest = 0;
	for (size_t i = 0; i < el->n; i++)
		l->rest += !strncmp(el->properties[i].name, "f_rest_", 7);
	if (l->rest != 0 && l->rest != 9 && l->rest != 24 && l->rest != ROW_REST_MAX)
		return err_file(e, f->path,
			"%d f_rest properties, expected 0, 9, 24 or 45: harmonics of degree 0 to 3", l->rest);
	for (int i = 0; i < l->rest; i++) {
		snprintf(name, sizeof name, "f_rest_%d", i);
		l->slot[ROW_REST + i] = plyfile_need(f, el, name, e);
		if (l->slot[ROW_REST + i] < 0)
			return -1;
	}
	return 0;
}

/* `chunks` is the offset of the element of that name, where there is one. close_source in any case. */
static int open_source(struct source *in, struct plyfile *f, const struct plyfile_element *vertex,
	size_t chunks, struct err *e)
{
	*in = (struct source){.file = f,
		.vertex = vertex,
		.is_packed = plypacked_is(f),
		.range = {{INFINITY, -INFINITY}, {INFINITY, -INFINITY}, {INFINITY, -INFINITY}}};
	if (in->is_packed) {
		if (plypacked_open(&in->packed, f, vertex, chunks, e))
			return -1;
		in->layout.rest = in->packed.rest;
		return 0;
	}
	if (find_layout(&in->layout, f, vertex, e) || plyfile_check_rows(f, vertex, e))
		return -1;
	in->row = mem_alloc(vertex->n, sizeof *in->row, f->path, e);
	return in->row ? 0 : -1;
}

/* Whether the other file is the same up to its rows, and as long. */
static int is_like(const struct source *in, const struct ply_like *like)
{
	const struct plyfile *f = in->file;

	return like && like->splats && !in->is_packed && f->encoding != PLY_ASCII && !in->vertex->has_list &&
	       in->vertex->rows == like->splats->n &&
	       in->layout.rest == 3 * (like->splats->sh_coefficients - 1) && f->map.len == like->map.len &&
	       !memcmp(f->map.data, like->map.data, f->at);
}

static int find_stays(struct source *in, const struct ply_like *like, struct err *e)
{
	size_t at = 0, size;

	if (!is_like(in, like))
		return 0;
	if (!(in->stays = mem_alloc(in->vertex->n, sizeof *in->stays, in->file->path, e)))
		return -1;
	for (size_t p = 0; p < in->vertex->n; p++, at += size) {
		size_t moving = 0;
		size = plyfile_type_size(in->vertex->properties[p].type);
		while (moving < 7 && in->layout.slot[moving < 3 ? moving : ROW_ROT + moving - 3] != (long)p)
			moving++;
		if (moving < 7)
			in->moves[moving] = at;
		else if (in->stay_count && in->stays[in->stay_count - 1][1] == at)
			in->stays[in->stay_count - 1][1] += size;
		else
			memcpy(in->stays[in->stay_count++], (size_t[2]){at, at + size}, sizeof *in->stays);
	}
	in->like = like;
	return 0;
}

/* 1 where the row is the other file's but for its mean and rotation, which values get. */
static int next_like(struct source *in, double *values)
{
	struct plyfile *f = in->file;
	const unsigned char *row = f->map.data + f->at, *other = in->like->map.data + f->at;

	for (size_t k = 0; k < in->stay_count; k++)
		if (memcmp(row + in->stays[k][0], other + in->stays[k][0],
			    in->stays[k][1] - in->stays[k][0]) != 0)
			return 0;
	for (int k = 0; k < 7; k++) {
		const int slot = k < 3 ? k : ROW_ROT + k - 3;
		values[slot] = plyfile_value(
			f, f->at + in->moves[k], in->vertex->properties[in->layout.slot[slot]].type);
	}
	f->at += in->vertex->min_bytes;
	return 1;
}

static void close_source(struct source *in)
{
	plypacked_close(&in->packed);
	mem_free_all(in->row, in->stays);
}

static void note_range(struct source *in, const double *values)
{
	for (int k = ROW_DC; k < ROW_ROT; k++) {
		double *range = in->range[k < ROW_OPACITY ? 2 : k != ROW_OPACITY];
		range[0] = fmin(range[0], values[k]);
		range[1] = fmax(range[1], values[k]);
		in->small += k > ROW_OPACITY && values[k] < 0.5;
	}
}

/* Opacities, scales and colours as they are, which no training gives in place of logits, logarithms and
 * harmonics: those have values below 0 or, where the unit is small, few below a half. */
static int check_range(const struct source *in, struct err *e)
{
	const size_t n = in->vertex->rows < 4 ? 0 : in->vertex->rows; /* fewer may have any values */
	const double low = in->range[0][0], high = in->range[0][1], *colour = in->range[2];

	if (n && low >= 0 && low < high && (high <= 1 || (high > 50 && high <= 255)))
		return err_file(e, in->file->path,
			"all its opacities are from %g to %g: not logits, which 3DGS stores, log(o / (1 - o)) of o from 0 to 1",
			low, high);
	if (n && in->range[1][0] > 0 && in->range[1][0] < in->range[1][1] && 2 * in->small > 3 * n)
		return err_file(e, in->file->path,
			"all its scales are above 0, most below 0.5: not logarithms of sizes, which 3DGS stores");
	if (n >= 1000 && colour[0] >= 0 && colour[0] < colour[1] &&
		(colour[1] <= 1 || (colour[1] > 50 && colour[1] <= 255)))
		return err_file(e, in->file->path,
			"all its f_dc are from %g to %g: colours, not harmonics, which 3DGS stores, (c - 0.5) / 0.28209 of c from 0 to 1",
			colour[0], colour[1]);
	return 0;
}

static int next_row(void *reader, size_t row, double *values, struct err *e)
{
	struct source *in = reader;

	if (in->is_packed) {
		if (plypacked_row(&in->packed, in->file, in->vertex, row, values, e))
			return -1;
		values[ROW_OPACITY] = gaussian_logit(values[ROW_OPACITY]);
		return 0;
	}
	if (in->like && next_like(in, values))
		return 1;
	if (plyfile_row(in->file, in->vertex, row, in->row, e))
		return -1;
	for (int i = 0; i < ROW_REST + in->layout.rest; i++)
		values[i] = in->row[in->layout.slot[i]];
	note_range(in, values);
	return 0;
}

/* Properties of a .ply's vertices that one method writes, and 3DGS does not, or the other way round. */
static const struct {
	const char *has, *lacks, *what, *way_out;
} layouts[] = {
#define FOREIGN_PLY(...) {__VA_ARGS__},
#include "formats/records/foreign.def"
};

/* Codes where 3DGS has floats: half floats, or quantised. */
static int check_types(const struct plyfile *f, const struct plyfile_element *vertex, struct err *e)
{
	static const char *const names[] = {"f_dc_0", "opacity", "scale_0"};

	for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
		const long at = plyfile_property(vertex, names[i]);
		if (at >= 0 && vertex->properties[at].type < PLY_F32 && !vertex->properties[at].is_list)
			return err_file(e, f->path,
				"property '%s' has whole numbers, half floats or codes of a packed scene: export it with floats where it was made",
				names[i]);
	}
	return 0;
}

/* What other methods than 3DGS write into a .ply, told by its properties. formats/records/foreign.md. */
static int check_foreign(const struct plyfile *f, const struct plyfile_element *vertex, struct err *e)
{
	const struct plyfile_element *face = plyfile_find(f, "face");
	char mode[128];

	for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
		if (plyfile_property(vertex, layouts[i].has) >= 0 &&
			(!layouts[i].lacks || plyfile_property(vertex, layouts[i].lacks) < 0) &&
			(!layouts[i].lacks || plyfile_property(vertex, "rot_0") >= 0))
			return foreign_say(f->path, layouts[i].what, layouts[i].way_out, e);
	if (plyfile_property(vertex, "x") >= 0 && plyfile_property(vertex, "scale_0") < 0 &&
		plyfile_property(vertex, "rot_0") < 0 && plyfile_property(vertex, "packed_position") < 0)
		return err_file(e, f->path,
			"a %s, not a trained scene: it has points without scale and rotation; 3D Gaussian Splatting trains a scene from them, point_cloud/iteration_N/point_cloud.ply",
			face && face->rows ? "mesh" : "point cloud");
	if (f->mode) {
		snprintf(mode, sizeof mode, "%.*s", (int)strcspn(f->mode, "\r"), f->mode);
		return err_file(e, f->path,
			"trained for another way of rendering ('%s'), which would be wrong here: train it without that mode",
			mode);
	}
	return check_types(f, vertex, e);
}

/* The rows of the element `vertex`, which is next. */
static int read_vertices(struct splats *s, double offset[3], struct rows_report *report, struct plyfile *f,
	const struct plyfile_element *vertex, size_t chunks, const struct ply_like *like, struct err *e)
{
	SCOPED_BY(close_source) struct source in = {0};

	if (check_foreign(f, vertex, e) || open_source(&in, f, vertex, chunks, e) || find_stays(&in, like, e))
		return -1;
	const struct gaussian_rows rows = {
		f->path, vertex->rows, in.layout.rest, next_row, &in, like ? like->splats : NULL};
	return gaussian_rows_read(s, offset, report, &rows, e) || check_range(&in, e);
}

/* All elements in the file's order. */
static int read_elements(struct splats *s, double offset[3], struct rows_report *report, struct plyfile *f,
	const struct ply_like *like, struct err *e)
{
	const struct plyfile_element *vertex = plyfile_find(f, "vertex");
	size_t chunks = 0;
	int bad = 0;

	if (!vertex)
		return err_file(e, f->path, "no element 'vertex'");
	for (size_t i = 0; !bad && i < f->n; i++) {
		const struct plyfile_element *el = &f->elements[i];
		if (!strcmp(el->name, "chunk"))
			chunks = f->at;
		bad = el == vertex ? read_vertices(s, offset, report, f, vertex, chunks, like, e)
				   : plyfile_skip(f, el, e);
	}
	return -(bad || plyfile_end(f, e));
}

int ply_read_like(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, const struct ply_like *like, struct err *e)
{
	SCOPED_BY(plyfile_close) struct plyfile f = {0};

	return -(plyfile_open(&f, name, map, e) || read_elements(s, offset, report, &f, like, e));
}

static void put_header(FILE *out, const struct splats *s, const char *mean_type, int has_labels)
{
	int rest = 3 * (s->sh_coefficients - 1);

	fprintf(out, "ply\nformat binary_little_endian 1.0\nelement vertex %zu\n", s->n);
	for (int k = 0; k < 3; k++)
		fprintf(out, "property %s %c\n", mean_type, "xyz"[k]);
	fputs("property float nx\nproperty float ny\nproperty float nz\n", out);
	for (int k = 0; k < 3; k++)
		fprintf(out, "property float f_dc_%d\n", k);
	for (int k = 0; k < rest; k++)
		fprintf(out, "property float f_rest_%d\n", k);
	for (int k = ROW_OPACITY; k < ROW_REST; k++)
		fprintf(out, "property float %s\n", fixed_names[k]);
	fputs(has_labels ? "property int label\nend_header\n" : "end_header\n", out);
}

int ply_write(const struct splats *s, const double offset[3], const char *path, struct err *e)
{
	return ply_write_labelled(s, offset, NULL, path, e);
}

int ply_write_labelled(const struct splats *s, const double offset[3], const int32_t *labels,
	const char *path, struct err *e)
{
	unsigned char bytes[3 * 8 + (3 + ROW_MAX + 1) * 4];
	double row[ROW_MAX];
	const int rest = 3 * (s->sh_coefficients - 1);
	int is_far = offset[0] != 0 || offset[1] != 0 || offset[2] != 0;
	struct file_out out;

	if (file_out_open(&out, path, e))
		return -1;
	put_header(out.stream, s, is_far ? "double" : "float", labels != NULL);
	for (size_t i = 0; i < s->n; i++) {
		unsigned char *p = bytes;
		gaussian_row_of(s, i, row);
		for (int k = 0; k < 3; k++)
			p = is_far ? little_put_f64(p, row[ROW_MEAN + k] + offset[k])
				   : little_put_f32(p, row[ROW_MEAN + k]);
		for (int k = 0; k < 3; k++)
			p = little_put_f32(p, 0);
		for (int k = ROW_DC; k < ROW_OPACITY; k++)
			p = little_put_f32(p, row[k]);
		for (int k = 0; k < rest; k++)
			p = little_put_f32(p, row[ROW_REST + k]);
		for (int k = ROW_OPACITY; k < ROW_REST; k++)
			p = little_put_f32(p, row[k]);
		if (labels)
			p = little_put(p, (uint32_t)labels[i], 4);
		fwrite(bytes, 1, (size_t)(p - bytes), out.stream);
	}
	return file_out_commit(&out, e);
}
