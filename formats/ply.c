#include "formats/ply.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/foreign.h"
#include "formats/plyfile.h"
#include "formats/plypacked.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIXED = 14, REST_MAX = 45, SAMPLES = 65536 };

/* A reader's slots: the properties every 3DGS file has, in this order, then f_rest_0 and on. */
static const char *const fixed_names[FIXED] = {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
	"scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"};
enum { SLOT_MEAN = 0, SLOT_DC = 3, SLOT_OPACITY = 6, SLOT_SCALE = 7, SLOT_ROT = 10 };

struct layout {
	long slot[FIXED + REST_MAX]; /* property index of each */
	int rest;		     /* number of f_rest properties: 3 (K-1) */
};

/* Where the rows come from: the usual layout, or packed ones, which are unpacked to that of fixed_names. */
struct source {
	struct plyfile *file;
	const struct plyfile_element *vertex;
	struct layout layout;
	int is_packed;
	struct plypacked packed;
	double *row;
};

enum verdict { KEEP, NOT_FINITE, ZERO_QUAT };

static int find_layout(
	struct layout *l, const struct plyfile *f, const struct plyfile_element *el, struct err *e)
{
	char name[32];

	for (int i = 0; i < FIXED; i++) {
		l->slot[i] = plyfile_need(f, el, fixed_names[i], e);
		if (l->slot[i] < 0)
			return -1;
	}
	l->rest = 0;
	for (size_t i = 0; i < el->n; i++)
		l->rest += !strncmp(el->properties[i].name, "f_rest_", 7);
	if (l->rest != 0 && l->rest != 9 && l->rest != 24 && l->rest != REST_MAX)
		return err_set(
			e, ERR_FORMAT, "%s: %d f_rest properties, expected 0, 9, 24 or 45", f->path, l->rest);
	for (int i = 0; i < l->rest; i++) {
		snprintf(name, sizeof name, "f_rest_%d", i);
		l->slot[FIXED + i] = plyfile_need(f, el, name, e);
		if (l->slot[FIXED + i] < 0)
			return -1;
	}
	return 0;
}

/* The inverse of the sigmoid. 0 and 1 have none: these give them back in single precision. */
static double logit(double o)
{
	if (o <= 0)
		return -110;
	if (o >= 1)
		return 30;
	return log(o / (1 - o));
}

/* `chunks` is the offset of the element of that name, where there is one. Release with close_source in any
 * case. */
static int open_source(struct source *in, struct plyfile *f, const struct plyfile_element *vertex,
	size_t chunks, struct err *e)
{
	size_t width = vertex->n;

	*in = (struct source){.file = f, .vertex = vertex, .is_packed = plypacked_is(f)};
	if (in->is_packed) {
		if (plypacked_open(&in->packed, f, vertex, chunks, e))
			return -1;
		in->layout.rest = in->packed.rest;
		for (int i = 0; i < FIXED + REST_MAX; i++)
			in->layout.slot[i] = i;
		width = FIXED + REST_MAX;
	} else if (find_layout(&in->layout, f, vertex, e) || plyfile_check_rows(f, vertex, e)) {
		return -1;
	}
	in->row = mem_alloc(width, sizeof *in->row, f->path, e);
	return in->row ? 0 : -1;
}

static void close_source(struct source *in)
{
	plypacked_close(&in->packed);
	free(in->row);
}

static int next_row(struct source *in, size_t row, struct err *e)
{
	if (!in->is_packed)
		return plyfile_row(in->file, in->vertex, row, in->row, e);
	if (plypacked_row(&in->packed, in->file, in->vertex, row, in->row, e))
		return -1;
	in->row[SLOT_OPACITY] = logit(in->row[SLOT_OPACITY]);
	return 0;
}

/* The row as Gaussian i of s, its mean in double. Nothing that scene_read would refuse is kept. */
static enum verdict put_gaussian(
	struct splats *s, size_t i, double *mean, const struct layout *l, const double *row)
{
	float *scale = s->scales + 3 * i, *quat = s->quats + 4 * i;
	float *sh = s->sh + 3 * (size_t)s->sh_coefficients * i;
	double q[4], largest = 0, length = 0;

	for (int k = 0; k < FIXED + l->rest; k++) {
		/* A quarter of the largest float leaves room for the offset to be taken away. */
		double limit = k < SLOT_DC ? FLT_MAX / 4 : FLT_MAX;
		if (!(fabs(row[l->slot[k]]) <= limit))
			return NOT_FINITE;
	}
	for (int k = 0; k < 3; k++) {
		mean[k] = row[l->slot[SLOT_MEAN + k]];
		scale[k] = (float)exp(row[l->slot[SLOT_SCALE + k]]);
	}
	if (!isfinite(scale[0] + scale[1] + scale[2]))
		return NOT_FINITE;
	for (int k = 0; k < 4; k++) {
		q[k] = row[l->slot[SLOT_ROT + k]];
		largest = fmax(largest, fabs(q[k]));
	}
	if (largest == 0)
		return ZERO_QUAT;
	for (int k = 0; k < 4; k++)
		length += q[k] / largest * (q[k] / largest);
	length = largest * sqrt(length);
	/* A length whose square leaves the floats would be zero or infinite to every reader of the scene. */
	for (int k = 0; k < 4; k++)
		quat[k] = (float)(length < 1e-6 || length > 1e6 ? q[k] / length : q[k]);
	s->opacities[i] = (float)(1 / (1 + exp(-row[l->slot[SLOT_OPACITY]])));
	int per_channel = l->rest / 3;
	for (int c = 0; c < 3; c++) {
		sh[c] = (float)row[l->slot[SLOT_DC + c]];
		for (int k = 0; k < per_channel; k++)
			sh[3 * (k + 1) + c] = (float)row[l->slot[FIXED + c * per_channel + k]];
	}
	return KEEP;
}

static int by_value(const void *a, const void *b)
{
	double x = *(const double *)a, y = *(const double *)b;

	return (x > y) - (x < y);
}

/* The rule of ply.md: far from the origin, compared with the scene's own size, means an offset. */
static int choose_offset(double offset[3], const double *means, size_t n, struct err *e)
{
	size_t step = (n + SAMPLES - 1) / SAMPLES, count = 0;
	double median[3], spread = 1, far = 0;

	memset(offset, 0, 3 * sizeof *offset);
	if (!n)
		return 0;
	double *sorted = mem_alloc((n + step - 1) / step, sizeof *sorted, "means", e);
	if (!sorted)
		return -1;
	for (int k = 0; k < 3; k++) {
		count = 0;
		for (size_t i = 0; i < n; i += step)
			sorted[count++] = means[3 * i + (size_t)k];
		qsort(sorted, count, sizeof *sorted, by_value);
		median[k] = sorted[count / 2];
		spread = fmax(spread, sorted[count - 1 - count / 4] - sorted[count / 4]);
		far = fmax(far, fabs(median[k]));
	}
	free(sorted);
	for (int k = 0; far > 16 * spread && k < 3; k++)
		offset[k] = round(median[k]) + 0.0; /* no -0 */
	return 0;
}

static int note_dropped(
	struct ply_report *report, size_t *capacity, size_t row, enum verdict why, struct err *e)
{
	void *block = report->dropped;
	size_t used = report->not_finite + report->zero_quat;

	if (mem_grow(&block, capacity, used + 1, sizeof *report->dropped, "left-out Gaussians", e))
		return -1;
	report->dropped = block;
	report->dropped[used] = row;
	if (why == NOT_FINITE)
		report->not_finite++;
	else
		report->zero_quat++;
	return 0;
}

static int read_gaussians(
	struct splats *s, double *means, struct ply_report *report, struct source *in, struct err *e)
{
	size_t kept = 0, capacity = 0;
	int bad = 0;

	for (size_t i = 0; !bad && i < in->vertex->rows; i++) {
		bad = next_row(in, i, e);
		if (bad)
			break;
		enum verdict v = put_gaussian(s, kept, means + 3 * kept, &in->layout, in->row);
		if (v == KEEP)
			kept++;
		else
			bad = note_dropped(report, &capacity, i, v, e);
	}
	s->n = kept;
	report->read = in->vertex->rows;
	return bad;
}

static int read_vertices(
	struct splats *s, double offset[3], struct ply_report *report, struct source *in, struct err *e)
{
	size_t n = in->vertex->rows, unused;

	if (mem_size(n, (FIXED + REST_MAX) * sizeof(double), &unused))
		return err_set(e, ERR_SYSTEM, "%s: %zu Gaussians do not fit in memory", in->file->path, n);
	if (splats_alloc(s, n, 1 + in->layout.rest / 3, e))
		return -1;
	double *means = mem_alloc(n, 3 * sizeof *means, "means", e);
	int bad = !means || read_gaussians(s, means, report, in, e) || choose_offset(offset, means, s->n, e);
	for (size_t i = 0; !bad && i < 3 * s->n; i++)
		s->means[i] = (float)(means[i] - offset[i % 3]);
	free(means);
	return -bad;
}

/* All elements in the file's order. */
static int read_elements(
	struct splats *s, double offset[3], struct ply_report *report, struct plyfile *f, struct err *e)
{
	const struct plyfile_element *vertex = plyfile_find(f, "vertex");
	size_t chunks = 0;
	int bad = 0;

	if (!vertex)
		return err_set(e, ERR_FORMAT, "%s: no element 'vertex'", f->path);
	for (size_t i = 0; !bad && i < f->n; i++) {
		const struct plyfile_element *el = &f->elements[i];
		if (!strcmp(el->name, "chunk"))
			chunks = f->at;
		if (el == vertex) {
			struct source in;
			bad = foreign_vertices(f, vertex, e) ? -1 : 0;
			if (bad)
				break;
			bad = open_source(&in, f, vertex, chunks, e) ||
			      read_vertices(s, offset, report, &in, e);
			close_source(&in);
		} else {
			bad = plyfile_skip(f, el, e);
		}
	}
	return bad || plyfile_end(f, e) ? -1 : 0;
}

int ply_read(struct splats *s, double offset[3], struct ply_report *report, const char *path, struct err *e)
{
	struct ply_report local = {0};
	struct plyfile f;

	*s = (struct splats){0};
	if (report)
		*report = local;
	if (plyfile_open(&f, path, e))
		return -1;
	int bad = read_elements(s, offset, &local, &f, e);
	plyfile_close(&f);
	if (bad)
		splats_free(s);
	if (bad || !report)
		free(local.dropped);
	else
		*report = local;
	return bad;
}

static unsigned char *put_bytes(unsigned char *p, uint64_t bits, int size)
{
	for (int i = 0; i < size; i++)
		*p++ = (unsigned char)(bits >> 8 * i);
	return p;
}

static unsigned char *put_float(unsigned char *p, double value)
{
	float single = (float)value;
	uint32_t bits;

	memcpy(&bits, &single, 4);
	return put_bytes(p, bits, 4);
}

static unsigned char *put_double(unsigned char *p, double value)
{
	uint64_t bits;

	memcpy(&bits, &value, 8);
	return put_bytes(p, bits, 8);
}

static void put_header(FILE *out, const struct splats *s, const char *mean_type)
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
	for (int k = SLOT_OPACITY; k < FIXED; k++)
		fprintf(out, "property float %s\n", fixed_names[k]);
	fputs("end_header\n", out);
}

int ply_write(const struct splats *s, const double offset[3], const char *path, struct err *e)
{
	unsigned char row[3 * 8 + (3 + FIXED + REST_MAX) * 4];
	int is_far = offset[0] != 0 || offset[1] != 0 || offset[2] != 0;
	struct file_out out;

	if (file_out_open(&out, path, e))
		return -1;
	put_header(out.stream, s, is_far ? "double" : "float");
	for (size_t i = 0; i < s->n; i++) {
		const float *sh = s->sh + 3 * (size_t)s->sh_coefficients * i;
		unsigned char *p = row;
		for (int k = 0; k < 3; k++)
			p = is_far ? put_double(p, (double)s->means[3 * i + (size_t)k] + offset[k])
				   : put_float(p, s->means[3 * i + (size_t)k]);
		for (int k = 0; k < 3; k++)
			p = put_float(p, 0);
		for (int c = 0; c < 3; c++)
			p = put_float(p, sh[c]);
		for (int c = 0; c < 3; c++)
			for (int k = 1; k < s->sh_coefficients; k++)
				p = put_float(p, sh[3 * k + c]);
		p = put_float(p, logit(s->opacities[i]));
		/* The logarithm of 0 is not finite; the smallest float's stands for it. */
		for (int k = 0; k < 3; k++)
			p = put_float(p, log(fmax((double)s->scales[3 * i + (size_t)k], FLT_TRUE_MIN)));
		for (int k = 0; k < 4; k++)
			p = put_float(p, s->quats[4 * i + (size_t)k]);
		fwrite(row, 1, (size_t)(p - row), out.stream);
	}
	return file_out_commit(&out, e);
}
