#include "cmd/import/transforming.h"

#include "base/compare.h"
#include "base/mem.h"
#include "formats/cameras/camerafile.h"
#include "geom/neighbours.h"
#include "geom/up.h"

#include <math.h>

/* A stray's eighth neighbour is this many times as far as that of the middle Gaussian. Of the 116,268
 * Gaussians of a real desk 1.6% are strays. */
enum { NEIGHBOUR = 8, STRAY = 10 };

/* Numbers with commas between them and nothing else: how many, or -1. */
static int read_numbers(const char *text, const char *end, int most, double *numbers)
{
	for (int n = 0; n < most; n++) {
		char *after;
		if (strchr(" \t\n\r\v\f", *text))
			return -1;
		numbers[n] = strtod(text, &after);
		if (after == text || !isfinite(numbers[n]))
			return -1;
		if (after == end)
			return n + 1;
		if (*after != ',')
			return -1;
		text = after + 1;
	}
	return -1;
}

static int read_crop(const char *text, double box[6], struct err *e)
{
	int bad = read_numbers(text, text + strlen(text), 6, box) != 6;

	for (int k = 0; k < 3 && !bad; k++)
		bad = box[k] > box[k + 3];
	return bad ? err_set(e, ERR_USAGE, "--crop: '%s' is not X0,Y0,Z0,X1,Y1,Z1, the least values first",
			     text)
		   : 0;
}

/* A quaternion, or an axis and an angle. */
static int read_rotation(const char *text, double quat[4], struct err *e)
{
	const char *colon = strchr(text, ':');
	const char *end = text + strlen(text);
	double axis[3], degrees, length = 0;

	if (!colon) {
		if (read_numbers(text, end, 4, quat) == 4)
			length = hypot(hypot(quat[0], quat[1]), hypot(quat[2], quat[3]));
	} else if (read_numbers(text, colon, 3, axis) == 3 &&
		   read_numbers(colon + 1, end, 1, &degrees) == 1) {
		const double half = fmod(degrees, 720) * acos(-1) / 360;
		length = hypot(hypot(axis[0], axis[1]), axis[2]);
		quat[0] = cos(half);
		for (int k = 0; k < 3 && length > 0; k++)
			quat[k + 1] = sin(half) * axis[k] / length;
	}
	return length > 0 && isfinite(length)
		       ? 0
		       : err_set(e, ERR_USAGE, "--rotate: '%s' is not W,X,Y,Z or X,Y,Z:DEGREES, of a length",
				 text);
}

/* The scale at which two points are as far apart as is known. */
static int read_known(const char *text, double *scale, struct err *e)
{
	const char *equals = strchr(text, '=');
	double points[6], length = 0, distance = 0;

	if (equals && read_numbers(text, equals, 6, points) == 6 &&
		read_numbers(equals + 1, text + strlen(text), 1, &length) == 1)
		distance = hypot(hypot(points[0] - points[3], points[1] - points[4]), points[2] - points[5]);
	*scale = distance > 0 ? length / distance : 0;
	return *scale > 0 && isfinite(*scale)
		       ? 0
		       : err_set(e, ERR_USAGE,
				 "--known: '%s' is not X0,Y0,Z0,X1,Y1,Z1=LENGTH, two points and a length",
				 text);
}

/* q = by q. */
static void turn_by(double q[4], const double by[4])
{
	const double w = q[0], x = q[1], y = q[2], z = q[3];

	q[0] = by[0] * w - by[1] * x - by[2] * y - by[3] * z;
	q[1] = by[0] * x + by[1] * w + by[2] * z - by[3] * y;
	q[2] = by[0] * y - by[1] * z + by[2] * w + by[3] * x;
	q[3] = by[0] * z + by[1] * y - by[2] * x + by[3] * w;
}

/* The least turn that brings a unit vector to -y, which is up where y is down, as for a .ply. */
static void level(const double up[3], double quat[4])
{
	quat[0] = 1 - up[1];
	quat[1] = up[2];
	quat[2] = 0;
	quat[3] = -up[0];
	if (quat[0] < 1e-12) { /* upside down: half a turn about x */
		quat[0] = quat[3] = 0;
		quat[1] = 1;
	}
}

static int find_up(const struct transforming *o, double up[3], struct err *e)
{
	SCOPED_BY(cameras_free) struct cameras cameras = {0};

	if (camerafile_read(&cameras, o->up_from, e))
		return -1;
	cameras_up(&cameras, up);
	return 0;
}

static int read_move(const struct transforming *o, struct move *m, struct err *e)
{
	*m = (struct move){.scale = o->scale, .quat = {1, 0, 0, 0}};
	if (o->known && read_known(o->known, &m->scale, e))
		return -1;
	if (o->rotate && read_rotation(o->rotate, m->quat, e))
		return -1;
	if (o->translate && read_numbers(o->translate, o->translate + strlen(o->translate), 3, m->shift) != 3)
		return err_set(e, ERR_USAGE, "--translate: '%s' is not X,Y,Z", o->translate);
	return 0;
}

int transforming_check(const struct transforming *o, struct err *e)
{
	struct move m;
	double box[6];

	return (o->crop && read_crop(o->crop, box, e)) || read_move(o, &m, e) ? -1 : 0;
}

static int keep(struct splats *s, const char *kept, struct err *e)
{
	struct splats rest;

	if (splats_keep(&rest, s, kept, e))
		return -1;
	splats_free(s);
	*s = rest;
	return 0;
}

/* Leaves out what is outside the box; the box's faces are inside. */
static int crop(struct splats *s, const double offset[3], const double box[6], struct err *e)
{
	SCOPED char *kept = mem_alloc(s->n, 1, "splats", e);

	for (size_t i = 0; kept && i < s->n; i++) {
		kept[i] = 1;
		for (size_t k = 0; k < 3; k++) {
			const double x = (double)s->means[3 * i + k] + offset[k];
			kept[i] &= x >= box[k] && x <= box[k + 3];
		}
	}
	return !kept || keep(s, kept, e) ? -1 : 0;
}

static int drop_strays(struct splats *s, struct err *e)
{
	SCOPED char *kept = mem_alloc(s->n, 1, "splats", e);
	SCOPED float *far = mem_alloc(s->n, 2 * sizeof *far, "splats", e);

	if (!kept || !far || neighbours_find(s->means, s->n, NEIGHBOUR, far, e))
		return -1;
	if (!s->n)
		return 0;
	float *sorted = far + s->n;
	memcpy(sorted, far, s->n * sizeof *far);
	qsort(sorted, s->n, sizeof *sorted, compare_float);
	for (size_t i = 0; i < s->n; i++)
		kept[i] = far[i] <= STRAY * sorted[s->n / 2];
	return keep(s, kept, e);
}

int transforming_do(struct splats *s, double offset[3], const struct transforming *o,
	struct transforming_count *left_out, struct err *e)
{
	const size_t all = s->n;
	struct move m;
	double box[6];

	*left_out = (struct transforming_count){0};
	if (read_move(o, &m, e) || (o->up_from && find_up(o, left_out->up, e)) ||
		(o->crop && (read_crop(o->crop, box, e) || crop(s, offset, box, e))))
		return -1;
	left_out->outside = all - s->n;
	if (o->drop_strays && drop_strays(s, e))
		return -1;
	left_out->strays = all - left_out->outside - s->n;
	left_out->scale = m.scale;
	if (o->up_from) {
		double quat[4];
		level(left_out->up, quat);
		turn_by(quat, m.quat);
		memcpy(m.quat, quat, sizeof quat);
	}
	if (o->rotate || o->translate || o->up_from || m.scale != 1)
		splats_move(s, offset, &m);
	return 0;
}
