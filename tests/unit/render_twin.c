#include "render_twin.h"

#include <math.h>
#include <stdlib.h>

typedef long double real;

static real limit(real x, real low, real high)
{
	return x < low ? low : x > high ? high : x;
}

/* out = a b, all 3x3. */
static void multiply(const real a[3][3], const real b[3][3], real out[3][3])
{
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++) {
			out[i][j] = 0;
			for (int k = 0; k < 3; k++)
				out[i][j] += a[i][k] * b[k][j];
		}
}

static void transpose(const real a[3][3], real out[3][3])
{
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++)
			out[i][j] = a[j][i];
}

/* R S S^T R^T. */
static void covariance_world(const float scale[3], const float quat[4], real out[3][3])
{
	real length = sqrtl((real)quat[0] * quat[0] + (real)quat[1] * quat[1] + (real)quat[2] * quat[2] +
			    (real)quat[3] * quat[3]);
	real w = quat[0] / length, x = quat[1] / length, y = quat[2] / length, z = quat[3] / length;
	real rotation[3][3] = {
		{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
		{2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
		{2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)},
	};
	real stretch[3][3] = {{scale[0], 0, 0}, {0, scale[1], 0}, {0, 0, scale[2]}}, m[3][3], mt[3][3];

	multiply(rotation, stretch, m);
	transpose(m, mt);
	multiply(m, mt, out);
}

static int project(const struct splats *s, const struct camera *c, size_t i, struct twin_gaussian *g)
{
	const float *mean = s->means + 3 * i;
	double view[3];
	real world[3][3], sigma[3][3], turn[3][3], t[3][3], tt[3][3], half[3][3];

	for (int r = 0; r < 3; r++) {
		const double *row = c->world_to_camera[r];
		view[r] = row[0] * mean[0] + row[1] * mean[1] + row[2] * mean[2] + row[3];
		for (int k = 0; k < 3; k++)
			turn[r][k] = row[k];
	}
	if (!(view[2] > 0.2))
		return 0;
	real z = view[2], tan_x = 0.5L * c->width / c->fx, tan_y = 0.5L * c->height / c->fy;
	real x =
		limit(view[0] / z, -c->cx / c->fx - 0.3L * tan_x, (c->width - c->cx) / c->fx + 0.3L * tan_x) *
		z;
	real y = limit(view[1] / z, -c->cy / c->fy - 0.3L * tan_y,
			 (c->height - c->cy) / c->fy + 0.3L * tan_y) *
		 z;
	real jacobian[3][3] = {
		{c->fx / z, 0, -c->fx * x / (z * z)}, {0, c->fy / z, -c->fy * y / (z * z)}, {0, 0, 0}};
	covariance_world(s->scales + 3 * i, s->quats + 4 * i, world);
	multiply(jacobian, turn, t);
	transpose(t, tt);
	multiply(t, world, half);
	multiply(half, tt, sigma);
	real xx = sigma[0][0] + 0.3L, xy = sigma[0][1], yy = sigma[1][1] + 0.3L, det = xx * yy - xy * xy;
	*g = (struct twin_gaussian){
		.depth = view[2],
		.index = (int32_t)i,
		.x = c->fx * (view[0] / z) + c->cx,
		.y = c->fy * (view[1] / z) + c->cy,
		.conic = {yy / det, -xy / det, xx / det},
		.opacity = s->opacities[i],
	};
	return 1;
}

static int by_depth(const void *a, const void *b)
{
	const struct twin_gaussian *x = a, *y = b;

	if (x->depth != y->depth)
		return x->depth < y->depth ? -1 : 1;
	return (x->index > y->index) - (x->index < y->index);
}

void twin_prepare(struct twin *t, const struct splats *s, const struct camera *c)
{
	t->n = 0;
	t->items = malloc((s->n + 1) * sizeof *t->items);
	if (!t->items)
		abort();
	for (size_t i = 0; i < s->n; i++)
		t->n += (size_t)project(s, c, i, &t->items[t->n]);
	qsort(t->items, t->n, sizeof *t->items, by_depth);
}

void twin_free(struct twin *t)
{
	free(t->items);
	*t = (struct twin){0};
}

void twin_blend(const struct twin *t, int column, int row, struct twin_pixel *out)
{
	real left = 1;

	out->n = 0;
	out->margin = INFINITY;
	for (size_t i = 0; i < t->n; i++) {
		const struct twin_gaussian *g = &t->items[i];
		real dx = column + 0.5L - g->x, dy = row + 0.5L - g->y;
		real q = g->conic[0] * dx * dx + 2 * g->conic[1] * dx * dy + g->conic[2] * dy * dy;
		if (g->opacity == 0 || q > 12) /* 2 ln 255 = 11.08 */
			continue;
		real a = fminl(0.99L, g->opacity * expl(-0.5L * q));
		out->margin = fmin(out->margin, (double)fabsl(255 * a - 1));
		if (a < 1 / 255.0L)
			continue;
		out->margin = fmin(out->margin, (double)fabsl(left * (1 - a) / 1e-4L - 1));
		if (left * (1 - a) < 1e-4L)
			break;
		out->index[out->n] = g->index;
		out->weight[out->n++] = (double)(a * left);
		left *= 1 - a;
	}
	out->transmittance = (double)left;
}
