#include "synth/surface.h"

#include <math.h>

#define PI 3.14159265358979323846

static void add(struct synth_surface *s, struct synth_patch p)
{
	if (s->n == SYNTH_PATCHES || !(p.area > 0))
		return;
	s->area += p.area;
	s->patches[s->n++] = p;
}

void synth_surface_turn(struct synth_surface *s, enum synth_tint tint, const double centre[3], int n,
	const double (*profile)[2])
{
	for (int i = 0; i + 1 < n; i++) {
		double r0 = profile[i][0], z0 = profile[i][1], r1 = profile[i + 1][0], z1 = profile[i + 1][1];
		double area = PI * (r0 + r1) * hypot(r1 - r0, z1 - z0);
		add(s, (struct synth_patch){.kind = SYNTH_FRUSTUM,
			       .tint = tint,
			       .area = area,
			       .centre = {centre[0], centre[1], centre[2]},
			       .r0 = r0,
			       .z0 = z0,
			       .r1 = r1,
			       .z1 = z1});
	}
}

static void cross(const double a[3], const double b[3], double out[3])
{
	out[0] = a[1] * b[2] - a[2] * b[1];
	out[1] = a[2] * b[0] - a[0] * b[2];
	out[2] = a[0] * b[1] - a[1] * b[0];
}

static double norm(const double a[3])
{
	return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

void synth_surface_rectangle(struct synth_surface *s, enum synth_tint tint, const double corner[3],
	const double u[3], const double v[3])
{
	struct synth_patch p = {.kind = SYNTH_RECTANGLE, .tint = tint};
	double outwards[3];

	cross(u, v, outwards);
	p.area = norm(outwards);
	for (int k = 0; k < 3; k++) {
		p.centre[k] = corner[k];
		p.u[k] = u[k];
		p.v[k] = v[k];
	}
	add(s, p);
}

void synth_surface_box(struct synth_surface *s, enum synth_tint top, enum synth_tint sides,
	const double centre[3], double width, double depth, double height)
{
	double x = centre[0] - width / 2, y = centre[1] - depth / 2, z = centre[2];
	double along[3] = {width, 0, 0}, across[3] = {0, depth, 0}, up[3] = {0, 0, height};

	synth_surface_rectangle(s, top, (double[3]){x, y, z + height}, along, across);
	synth_surface_rectangle(s, sides, (double[3]){x, y, z}, along, up);
	synth_surface_rectangle(s, sides, (double[3]){x, y + depth, z}, up, along);
	synth_surface_rectangle(s, sides, (double[3]){x, y, z}, up, across);
	synth_surface_rectangle(s, sides, (double[3]){x + width, y, z}, across, up);
}

void synth_surface_half_ring(struct synth_surface *s, const double centre[3], double ring, double tube)
{
	add(s, (struct synth_patch){.kind = SYNTH_HALF_RING,
		       .tint = SYNTH_OWN,
		       .area = 2 * PI * PI * ring * tube,
		       .centre = {centre[0], centre[1], centre[2]},
		       .r0 = ring,
		       .r1 = tube});
}

static void frustum_at(const struct synth_patch *p, double a, double b, double point[3], double normal[3])
{
	/* Area grows with the radius squared. */
	double r = sqrt(p->r0 * p->r0 + a * (p->r1 * p->r1 - p->r0 * p->r0)), dr = p->r1 - p->r0,
	       dz = p->z1 - p->z0;
	double t = fabs(dr) > 1e-9 ? (r - p->r0) / dr : a, length = hypot(dr, dz);
	double c = cos(2 * PI * b), s = sin(2 * PI * b);

	point[0] = p->centre[0] + r * c;
	point[1] = p->centre[1] + r * s;
	point[2] = p->centre[2] + p->z0 + t * dz;
	normal[0] = dz / length * c;
	normal[1] = dz / length * s;
	normal[2] = -dr / length;
}

static void rectangle_at(const struct synth_patch *p, double a, double b, double point[3], double normal[3])
{
	cross(p->u, p->v, normal);
	for (int k = 0; k < 3; k++) {
		point[k] = p->centre[k] + a * p->u[k] + b * p->v[k];
		normal[k] /= p->area;
	}
}

static void half_ring_at(const struct synth_patch *p, double a, double b, double point[3], double normal[3])
{
	double turn = PI * (a - 0.5), c = cos(2 * PI * b), s = sin(2 * PI * b), r = p->r0 + p->r1 * c;

	point[0] = p->centre[0] + r * cos(turn);
	point[1] = p->centre[1] + p->r1 * s;
	point[2] = p->centre[2] + r * sin(turn);
	normal[0] = c * cos(turn);
	normal[1] = s;
	normal[2] = c * sin(turn);
}

enum synth_tint synth_surface_at(
	const struct synth_surface *s, double a, double b, double point[3], double normal[3])
{
	double at = a * s->area;
	int i = 0;

	while (i + 1 < s->n && at >= s->patches[i].area)
		at -= s->patches[i++].area;
	const struct synth_patch *p = &s->patches[i];
	at = fmin(at / p->area, 1);
	switch (p->kind) {
	case SYNTH_FRUSTUM:
		frustum_at(p, at, b, point, normal);
		break;
	case SYNTH_RECTANGLE:
		rectangle_at(p, at, b, point, normal);
		break;
	case SYNTH_HALF_RING:
		half_ring_at(p, at, b, point, normal);
		break;
	}
	return p->tint;
}
