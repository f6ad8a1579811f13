/* A model has two steps. From the ray to a plane: the ray itself, or, of a fisheye, its direction times its
 * angle from the axis. Then a formula distorts the plane, and focal lengths and principal point make pixels
 * of it. The way back inverts the formula, in closed form where there is one. */
#include "geom/lens.h"

#include <float.h>
#include <math.h>
#include <string.h>
#include <strings.h>

enum { NEWTON_STEPS = 50 };

/* A ray that comes back farther off than this, relative to 1 and its length, is not its pixel's. */
static const double same_ray = 1e-6;

/* The pinhole's size, relative to the photograph's: COLMAP's defaults. */
static const double least_scale = 0.2, most_scale = 2;

typedef void formula(const double *k, const double in[2], double out[2]);

struct lens_model {
	const char *name;
	int parameters, focals, is_fisheye;
	formula *distort; /* NULL: does nothing */
	formula *restore; /* its inverse; NULL: Newton's method. Not a number where there is none. */
};

static double square(const double in[2])
{
	return in[0] * in[0] + in[1] * in[1];
}

static void scale(const double in[2], double by, double out[2])
{
	out[0] = in[0] * by;
	out[1] = in[1] * by;
}

/* 1 + k1 r2 + k2 r2^2 + ... */
static double polynomial(const double *k, int n, double r2)
{
	double value = 0;

	while (n-- > 0)
		value = (value + k[n]) * r2;
	return 1 + value;
}

/* The tangential terms of Brown's model at `at`. */
static void add_tangential(double p1, double p2, const double at[2], double out[2])
{
	const double r2 = square(at), product = at[0] * at[1];

	out[0] += 2 * p1 * product + p2 * (r2 + 2 * at[0] * at[0]);
	out[1] += 2 * p2 * product + p1 * (r2 + 2 * at[1] * at[1]);
}

static void radial1(const double *k, const double in[2], double out[2])
{
	scale(in, polynomial(k, 1, square(in)), out);
}

static void radial2(const double *k, const double in[2], double out[2])
{
	scale(in, polynomial(k, 2, square(in)), out);
}

static void radial4(const double *k, const double in[2], double out[2])
{
	scale(in, polynomial(k, 4, square(in)), out);
}

/* k1 k2 p1 p2 */
static void opencv(const double *k, const double in[2], double out[2])
{
	radial2(k, in, out);
	add_tangential(k[2], k[3], in, out);
}

/* k1 k2 p1 p2 k3 k4 k5 k6 */
static void full_opencv(const double *k, const double in[2], double out[2])
{
	const double over[3] = {k[0], k[1], k[4]}, r2 = square(in);

	scale(in, polynomial(over, 3, r2) / polynomial(k + 5, 3, r2), out);
	add_tangential(k[2], k[3], in, out);
}

/* omega, the field of view in radians */
static void fov(const double *k, const double in[2], double out[2])
{
	const double r = sqrt(square(in)), slope = 2 * tan(*k / 2);

	scale(in, r > 1e-9 ? atan(r * slope) / (r * *k) : slope / *k, out);
}

static void fov_back(const double *k, const double in[2], double out[2])
{
	const double r = sqrt(square(in)), slope = 2 * tan(*k / 2);

	if (fabs(r * *k) >= acos(0))
		scale(in, NAN, out);
	else
		scale(in, r > 1e-9 ? tan(r * *k) / (r * slope) : *k / slope, out);
}

/* k1 k2 p1 p2 k3 k4 sx1 sy1 */
static void thin_prism(const double *k, const double in[2], double out[2])
{
	const double radial[4] = {k[0], k[1], k[4], k[5]}, r2 = square(in);

	scale(in, polynomial(radial, 4, r2), out);
	add_tangential(k[2], k[3], in, out);
	out[0] += k[6] * r2;
	out[1] += k[7] * r2;
}

/* k0 to k5, p0 p1, s0 to s3: the later terms are of what the first made. */
static void rad_tan_thin_prism(const double *k, const double in[2], double out[2])
{
	double radial[2];

	scale(in, polynomial(k, 6, square(in)), radial);
	const double r2 = square(radial);
	memcpy(out, radial, sizeof radial);
	add_tangential(k[7], k[6], radial, out);
	out[0] += k[8] * r2 + k[9] * r2 * r2;
	out[1] += k[10] * r2 + k[11] * r2 * r2;
}

/* k: in is out / (1 + k |out|^2) */
static void division(const double *k, const double in[2], double out[2])
{
	scale(in, 2 / (1 + sqrt(1 - 4 * *k * square(in))), out);
}

static void division_back(const double *k, const double in[2], double out[2])
{
	const double below = 1 + *k * square(in);

	scale(in, below > 0 ? 1 / below : NAN, out);
}

/* alpha beta */
static void eucm(const double *k, const double in[2], double out[2])
{
	scale(in, 1 / (k[0] * sqrt(k[1] * square(in) + 1) + 1 - k[0]), out);
}

static void eucm_back(const double *k, const double in[2], double out[2])
{
	const double alpha = k[0], r2 = k[1] * square(in);
	const double depth = (1 - alpha * alpha * r2) / (alpha * sqrt(1 - (2 * alpha - 1) * r2) + 1 - alpha);

	scale(in, depth > 0 ? 1 / depth : NAN, out);
}

/* The place is COLMAP's number. */
static const struct lens_model models[] = {
	{"SIMPLE_PINHOLE", 3, 1, 0, NULL, NULL},
	{"PINHOLE", 4, 2, 0, NULL, NULL},
	{"SIMPLE_RADIAL", 4, 1, 0, radial1, NULL},
	{"RADIAL", 5, 1, 0, radial2, NULL},
	{"OPENCV", 8, 2, 0, opencv, NULL},
	{"OPENCV_FISHEYE", 8, 2, 1, radial4, NULL},
	{"FULL_OPENCV", 12, 2, 0, full_opencv, NULL},
	{"FOV", 5, 2, 0, fov, fov_back},
	{"SIMPLE_RADIAL_FISHEYE", 4, 1, 1, radial1, NULL},
	{"RADIAL_FISHEYE", 5, 1, 1, radial2, NULL},
	{"THIN_PRISM_FISHEYE", 12, 2, 1, thin_prism, NULL},
	{"RAD_TAN_THIN_PRISM_FISHEYE", 16, 2, 1, rad_tan_thin_prism, NULL},
	{"SIMPLE_DIVISION", 4, 1, 0, division, division_back},
	{"DIVISION", 5, 2, 0, division, division_back},
	{"SIMPLE_FISHEYE", 3, 1, 1, NULL, NULL},
	{"FISHEYE", 4, 2, 1, NULL, NULL},
	{"EUCM", 6, 2, 0, eucm, eucm_back},
};
enum { MODELS = sizeof models / sizeof *models };

const struct lens_model *lens_model_numbered(uint32_t id)
{
	return id < MODELS ? &models[id] : NULL;
}

const struct lens_model *lens_model_named(const char *name, size_t length)
{
	for (int i = 0; i < MODELS; i++)
		if (strlen(models[i].name) == length && !strncasecmp(models[i].name, name, length))
			return &models[i];
	return NULL;
}

const char *lens_model_name(const struct lens_model *m)
{
	return m->name;
}

int lens_model_parameters(const struct lens_model *m)
{
	return m->parameters;
}

int lens_model_focals(const struct lens_model *m)
{
	return m->focals;
}

static const double *distortion(const struct lens *l)
{
	return l->parameters + l->model->focals + 2;
}

int lens_is_distorted(const struct lens *l)
{
	const int first = l->model->focals + 2;
	int is_zero = 1;

	if (l->model->is_fisheye)
		return 1;
	/* EUCM's beta does nothing where its alpha is 0. */
	for (int i = first; i < (l->model->distort == eucm ? first + 1 : l->model->parameters); i++)
		is_zero &= l->parameters[i] == 0;
	return !is_zero;
}

int lens_is_same(const struct lens *a, const struct lens *b)
{
	int is_same = a->model == b->model && a->width == b->width && a->height == b->height;

	for (int i = 0; i < LENS_PARAMETERS; i++)
		is_same &= a->parameters[i] == b->parameters[i];
	return is_same;
}

/* (u, v) on the plane as a pixel, and back. */
static void to_pixel(const struct lens *l, const double plane[2], double pixel[2])
{
	for (int i = 0; i < 2; i++)
		pixel[i] = l->parameters[i ? l->model->focals - 1 : 0] * plane[i] +
			   l->parameters[l->model->focals + i];
}

static void from_pixel(const struct lens *l, const double pixel[2], double plane[2])
{
	for (int i = 0; i < 2; i++)
		plane[i] = (pixel[i] - l->parameters[l->model->focals + i]) /
			   l->parameters[i ? l->model->focals - 1 : 0];
}

/* One step of Newton's method towards the point that the formula takes to `to`; its length, not a number
 * where there is none. Derivatives are central differences, whose error matters not. */
static double newton_step(const struct lens *l, const double to[2], double at[2])
{
	double j[2][2], value[2];

	for (int i = 0; i < 2; i++) {
		const double h = 1e-6 * (1 + fabs(at[i]));
		double place[2] = {at[0], at[1]}, above[2], below[2];
		place[i] = at[i] + h;
		l->model->distort(distortion(l), place, above);
		place[i] = at[i] - h;
		l->model->distort(distortion(l), place, below);
		for (int k = 0; k < 2; k++)
			j[k][i] = (above[k] - below[k]) / (2 * h);
	}
	l->model->distort(distortion(l), at, value);
	const double determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0], x = to[0] - value[0],
		     y = to[1] - value[1];
	const double step[2] = {
		(j[1][1] * x - j[0][1] * y) / determinant, (j[0][0] * y - j[1][0] * x) / determinant};
	at[0] += step[0];
	at[1] += step[1];
	return determinant > 0 ? sqrt(square(step)) : NAN;
}

static int restore(const struct lens *l, double plane[2])
{
	const double to[2] = {plane[0], plane[1]};

	if (!l->model->distort || !lens_is_distorted(l))
		return 0;
	if (l->model->restore) {
		l->model->restore(distortion(l), to, plane);
		return isfinite(square(plane)) ? 0 : -1;
	}
	for (int i = 0; i < NEWTON_STEPS; i++) {
		const double length = newton_step(l, to, plane);
		if (!isfinite(length))
			return -1;
		if (length <= 1e-13 * (1 + sqrt(square(plane))))
			return plane[0] * to[0] + plane[1] * to[1] >= 0 ? 0 : -1;
	}
	return -1;
}

int lens_unproject(const struct lens *l, const double pixel[2], double ray[2])
{
	from_pixel(l, pixel, ray);
	if (restore(l, ray))
		return -1;
	const double angle = sqrt(square(ray));
	if (l->model->is_fisheye && angle >= acos(0))
		return -1;
	if (l->model->is_fisheye && angle > 0)
		scale(ray, tan(angle) / angle, ray);
	return 0;
}

int lens_project(const struct lens *l, const double ray[2], double pixel[2])
{
	const double r = sqrt(square(ray));
	double plane[2], back[2];

	scale(ray, l->model->is_fisheye && r > 0 ? atan(r) / r : 1, plane);
	if (l->model->distort && lens_is_distorted(l)) {
		const double from[2] = {plane[0], plane[1]};
		l->model->distort(distortion(l), from, plane);
	}
	to_pixel(l, plane, pixel);
	if (!isfinite(square(pixel)) || lens_unproject(l, pixel, back))
		return -1;
	return hypot(back[0] - ray[0], back[1] - ray[1]) <= same_ray * (1 + r * r) ? 0 : -1;
}

/* Where a pinhole sees what a pixel of the photograph shows. */
static int to_view(const struct lens *l, const struct camera *c, double x, double y, double pixel[2])
{
	double ray[2];

	if (lens_unproject(l, (double[]){x, y}, ray))
		return -1;
	pixel[0] = c->fx * ray[0] + c->cx;
	pixel[1] = c->fy * ray[1] + c->cy;
	return 0;
}

/* Along one axis: the scale at which the innermost places of the first and the last border, as the pinhole
 * sees them, are borders. */
static double find_scale(double centre, double size, double first, double last)
{
	const double inverse = fmax(centre / (centre - first), (size - 0.5 - centre) / (last - centre));

	return fmin(fmax(1 / inverse, least_scale), most_scale);
}

void lens_pinhole(const struct lens *l, struct camera *c)
{
	double left = -DBL_MAX, right = DBL_MAX, top = -DBL_MAX, bottom = DBL_MAX, at[2];
	const int focals = l->model->focals, w = l->width, h = l->height;

	c->fx = l->parameters[0];
	c->fy = l->parameters[focals - 1];
	c->cx = l->parameters[focals];
	c->cy = l->parameters[focals + 1];
	for (int y = 0; y < h; y++) {
		if (!to_view(l, c, 0.5, y + 0.5, at))
			left = fmax(left, at[0]);
		if (!to_view(l, c, w - 0.5, y + 0.5, at))
			right = fmin(right, at[0]);
	}
	for (int x = 0; x < w; x++) {
		if (!to_view(l, c, x + 0.5, 0.5, at))
			top = fmax(top, at[1]);
		if (!to_view(l, c, x + 0.5, h - 0.5, at))
			bottom = fmin(bottom, at[1]);
	}
	c->width = (int)fmax(1, find_scale(c->cx, w, left, right) * w);
	c->height = (int)fmax(1, find_scale(c->cy, h, top, bottom) * h);
	c->cx *= (double)c->width / w;
	c->cy *= (double)c->height / h;
}

void cameras_undistort(struct cameras *c)
{
	for (size_t i = 0; i < c->n; i++) {
		struct camera *v = &c->views[i], *before = i ? v - 1 : NULL;
		if (!v->lens.model)
			continue;
		if (!before || !lens_is_same(&before->lens, &v->lens)) {
			lens_pinhole(&v->lens, v);
			continue;
		}
		v->width = before->width;
		v->height = before->height;
		v->fx = before->fx;
		v->fy = before->fy;
		v->cx = before->cx;
		v->cy = before->cy;
	}
}

/* The index of the pixel at x, y of a picture of width x height when it has columns x rows; -1 outside. */
static int32_t place(double x, double y, int width, int height, int rows, int columns)
{
	const double column = floor(x * columns / width), row = floor(y * rows / height);

	return column >= 0 && column < columns && row >= 0 && row < rows ? (int32_t)(row * columns + column)
									 : -1;
}

void lens_map(const struct lens *l, const struct camera *c, int is_back, int rows, int columns, int32_t *map)
{
	const int width = is_back ? l->width : c->width, height = is_back ? l->height : c->height;

#pragma omp parallel for schedule(static)
	for (int y = 0; y < height; y++)
		for (int x = 0; x < width; x++) {
			const double ray[2] = {(x + 0.5 - c->cx) / c->fx, (y + 0.5 - c->cy) / c->fy};
			double pixel[2];
			map[(size_t)y * (size_t)width + (size_t)x] =
				(is_back ? to_view(l, c, x + 0.5, y + 0.5, pixel)
					 : lens_project(l, ray, pixel))
					? -1
					: place(pixel[0], pixel[1], is_back ? c->width : l->width,
						  is_back ? c->height : l->height, rows, columns);
		}
}
