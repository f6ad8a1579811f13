#include "splat/gaussian_rows.h"

#include "base/mem.h"
#include "base/quantile.h"

#include <float.h>
#include <math.h>

enum { SAMPLES = 65536 };

enum verdict { KEEP, NOT_FINITE, ZERO_QUAT };

double gaussian_logit(double opacity)
{
	if (opacity <= 0)
		return -110;
	if (opacity >= 1)
		return 30;
	return log(opacity / (1 - opacity));
}

/* The quaternion of a row: as it is, unless its length has a square that leaves the floats, which would be
 * zero or infinite to every reader of the scene. */
static enum verdict put_quat(float *quat, const double *q)
{
	double largest = 0, length = 0;

	for (int k = 0; k < 4; k++)
		largest = fmax(largest, fabs(q[k]));
	if (largest == 0)
		return ZERO_QUAT;
	for (int k = 0; k < 4; k++)
		length += q[k] / largest * (q[k] / largest);
	length = largest * sqrt(length);
	for (int k = 0; k < 4; k++)
		quat[k] = (float)(length < 1e-6 || length > 1e6 ? q[k] / length : q[k]);
	return KEEP;
}

/* The logits of 1 and 0, and the logarithm of 0, are infinite: opaque, clear and flat Gaussians. */
static int has_limit(int k, double value)
{
	return k == ROW_OPACITY ? !isnan(value) : k >= ROW_SCALE && k < ROW_ROT && value < 0;
}

/* The row as Gaussian i of s, its mean in double. Nothing that scene_read would refuse is kept. */
static enum verdict put_gaussian(struct splats *s, size_t i, double *mean, int rest, const double *row)
{
	float *scale = s->scales + 3 * i;
	float *sh = s->sh + 3 * (size_t)s->sh_coefficients * i;

	for (int k = 0; k < ROW_REST + rest; k++) {
		/* A quarter of the largest float leaves room for the offset to be taken away. */
		double limit = k < ROW_DC ? FLT_MAX / 4 : FLT_MAX;
		if (!(fabs(row[k]) <= limit) && !has_limit(k, row[k]))
			return NOT_FINITE;
	}
	for (int k = 0; k < 3; k++) {
		mean[k] = row[ROW_MEAN + k];
		scale[k] = (float)exp(row[ROW_SCALE + k]);
	}
	if (!isfinite(scale[0] + scale[1] + scale[2]))
		return NOT_FINITE;
	if (put_quat(s->quats + 4 * i, row + ROW_ROT) != KEEP)
		return ZERO_QUAT;
	s->opacities[i] = (float)(1 / (1 + exp(-row[ROW_OPACITY])));
	int per_channel = rest / 3;
	for (int c = 0; c < 3; c++) {
		sh[c] = (float)row[ROW_DC + c];
		for (int k = 0; k < per_channel; k++)
			sh[3 * (k + 1) + c] = (float)row[ROW_REST + c * per_channel + k];
	}
	return KEEP;
}

/* The same where all but the mean and the rotation is that of Gaussian k of `like`. */
static enum verdict put_moved(
	struct splats *s, size_t i, double *mean, const struct splats *like, size_t k, const double *row)
{
	const size_t width = 3 * (size_t)s->sh_coefficients;

	for (int d = 0; d < 3; d++) {
		if (!(fabs(row[ROW_MEAN + d]) <= FLT_MAX / 4))
			return NOT_FINITE;
		mean[d] = row[ROW_MEAN + d];
	}
	for (int d = 0; d < 4; d++)
		if (!(fabs(row[ROW_ROT + d]) <= FLT_MAX))
			return NOT_FINITE;
	memcpy(s->scales + 3 * i, like->scales + 3 * k, 3 * sizeof *s->scales);
	memcpy(s->sh + width * i, like->sh + width * k, width * sizeof *s->sh);
	s->opacities[i] = like->opacities[k];
	return put_quat(s->quats + 4 * i, row + ROW_ROT);
}

/* The one that comes k-th in rising order, from 0. */
static double item(struct quantile_item *items, size_t n, size_t k)
{
	return quantile_passed(items, n, (double)k + 0.5);
}

/* The rule of ply.md: far from the origin, compared with the scene's own size, means an offset. */
int gaussian_offset(double offset[3], const double *means, size_t n, struct err *e)
{
	size_t step = (n + SAMPLES - 1) / SAMPLES, count = 0;
	double median[3], spread = 0, far = 0;

	memset(offset, 0, 3 * sizeof *offset);
	if (!n)
		return 0;
	SCOPED struct quantile_item *items = mem_alloc((n + step - 1) / step, sizeof *items, "means", e);
	if (!items)
		return -1;
	for (int k = 0; k < 3; k++) {
		count = 0;
		for (size_t i = 0; i < n; i += step)
			items[count++] = (struct quantile_item){means[3 * i + (size_t)k], 1};
		median[k] = item(items, count, count / 2);
		spread = fmax(
			spread, item(items, count, count - 1 - count / 4) - item(items, count, count / 4));
		far = fmax(far, fabs(median[k]));
	}
	const double unit = spread > 0 && spread < 1 ? exp2(floor(log2(spread))) : 1;
	for (int k = 0; far > 16 * fmax(spread, unit) && k < 3; k++)
		offset[k] = round(median[k] / unit) * unit + 0.0; /* no -0 */
	return 0;
}

static int note_dropped(
	struct rows_report *report, size_t *capacity, size_t row, enum verdict why, struct err *e)
{
	size_t used = report->not_finite + report->zero_quat;

	if (mem_grow((void **)&report->dropped, capacity, used + 1, sizeof *report->dropped,
		    "left-out Gaussians", e))
		return -1;
	report->dropped[used] = row;
	if (why == NOT_FINITE)
		report->not_finite++;
	else
		report->zero_quat++;
	return 0;
}

static int read_all(struct splats *s, double *means, struct rows_report *report,
	const struct gaussian_rows *from, struct err *e)
{
	size_t kept = 0, capacity = 0;
	double row[ROW_MAX];
	int bad = 0;

	for (size_t i = 0; !bad && i < from->n; i++) {
		const int got = from->next(from->reader, i, row, e);
		if ((bad = got < 0 ? -1 : 0))
			break;
		enum verdict v = got ? put_moved(s, kept, means + 3 * kept, from->like, i, row)
				     : put_gaussian(s, kept, means + 3 * kept, from->rest, row);
		if (v == KEEP)
			kept++;
		else
			bad = note_dropped(report, &capacity, i, v, e);
	}
	s->n = kept;
	report->read = from->n;
	return bad;
}

int gaussian_rows_read(struct splats *s, double offset[3], struct rows_report *report,
	const struct gaussian_rows *from, struct err *e)
{
	const size_t n = from->n;
	size_t unused;

	*report = (struct rows_report){0};
	if (mem_size(n, ROW_MAX * sizeof(double), &unused))
		return err_set(e, ERR_SYSTEM, "%s: %zu Gaussians do not fit in memory", from->path, n);
	if (splats_alloc(s, n, 1 + from->rest / 3, e))
		return -1;
	SCOPED double *means = mem_alloc(n, 3 * sizeof *means, "means", e);
	if (!means || read_all(s, means, report, from, e) || gaussian_offset(offset, means, s->n, e))
		return -1;
	for (size_t i = 0; i < 3 * s->n; i++)
		s->means[i] = (float)(means[i] - offset[i % 3]);
	if (n && !s->n)
		return err_file(e, from->path,
			"none of its %zu Gaussians can be used: %zu have a value that is not finite, %zu a zero quaternion",
			n, report->not_finite, report->zero_quat);
	return 0;
}

int gaussian_row_of(const struct splats *s, size_t i, double *values)
{
	const float *sh = s->sh + 3 * (size_t)s->sh_coefficients * i;
	const int per_channel = s->sh_coefficients - 1;

	for (int k = 0; k < 3; k++) {
		values[ROW_MEAN + k] = s->means[3 * i + (size_t)k];
		/* The logarithm of 0 is not finite; the smallest float's stands for it. */
		values[ROW_SCALE + k] = log(fmax((double)s->scales[3 * i + (size_t)k], FLT_TRUE_MIN));
		values[ROW_DC + k] = sh[k];
	}
	values[ROW_OPACITY] = gaussian_logit(s->opacities[i]);
	for (int k = 0; k < 4; k++)
		values[ROW_ROT + k] = s->quats[4 * i + (size_t)k];
	for (int c = 0; c < 3; c++)
		for (int k = 0; k < per_channel; k++)
			values[ROW_REST + c * per_channel + k] = sh[3 * (k + 1) + c];
	return ROW_REST + 3 * per_channel;
}

int gaussian_flip_sign(int coefficient, int axes)
{
	/* The axes in which each harmonic from Y_0 on is odd: y, z, x; xy, yz, -, xz, -; ... */
	static const char odd[16] = {0, FLIP_Y, FLIP_Z, FLIP_X, FLIP_X | FLIP_Y, FLIP_Y | FLIP_Z, 0,
		FLIP_X | FLIP_Z, 0, FLIP_Y, FLIP_X | FLIP_Y | FLIP_Z, FLIP_Y, FLIP_Z, FLIP_X, FLIP_Z, FLIP_X};
	const int turned = odd[coefficient] & axes;

	return (turned & 1) ^ (turned >> 1 & 1) ^ (turned >> 2 & 1) ? -1 : 1;
}
