#include "synth/surface.h"

#include "geom/vector.h"

#include <math.h>

static void add(struct synth_surface *s, struct synth_patch p)
{
	if (s->n == SYNTH_PATCHES || !(p.area > 0))
		return;
	s->area += p.area;
	s->patches[s->n++] = p;
}

/* The angle by which the profile turns at its point i. */
static double turn_at(int i, const double (*profile)[2])
{
	double x0 = profile[i][0] - profile[i - 1][0], y0 = profile[i][1] - profile[i - 1][1];
	double x1 = profile[i + 1][0] - profile[i][0], y1 = profile[i + 1][1] - profile[i][1];

	return fabs(atan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1));
}

void synth_surface_turn(struct synth_surface *s, enum synth_tint tint, const double centre[3], int n,
	const double (*profile)[2])
{
	static const double sharp = 0.4; /* radians */

	for (int i = 0; i + 1 < n; i++) {
		double r0 = profile[i][0], z0 = profile[i][1], r1 = profile[i + 1][0], z1 = profile[i + 1][1];
		double length = hypot(r1 - r0, z1 - z0), area = PI * (r0 + r1) * length, turned = 0;
		struct synth_patch p = {.kind = SYNTH_FRUSTUM,
			.tint = tint,
			.area = area,
			.centre = {centre[0], centre[1], centre[2]},
			.r0 = r0,
			.z0 = z0,
			.r1 = r1,
			.z1 = z1};
		for (int end = 0; end < 2; end++) {
			int at = i + end;
			/* On the axis the surface goes on on the other side. */
			double turn = at > 0 && at + 1 < n    ? turn_at(at, profile)
				      : profile[at][0] > 1e-9 ? PI
							      : 2 * atan2(fabs(z1 - z0), fabs(r1 - r0));
			p.is_sharp[end] = turn > sharp;
			turned += p.is_sharp[end] ? 0 : turn / 2;
		}
		p.bend = turned > 1e-9 ? length / turned : INFINITY;
		add(s, p);
	}
}

static void add_rectangle(struct synth_surface *s, enum synth_tint tint, const double corner[3],
	const double u[3], const double v[3])
{
	struct synth_patch p = {.kind = SYNTH_RECTANGLE, .tint = tint};
	double outwards[3];

	vector_cross(u, v, outwards);
	p.area = vector_length(outwards);
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

	add_rectangle(s, top, (double[3]){x, y, z + height}, along, across);
	add_rectangle(s, sides, (double[3]){x, y, z}, along, up);
	add_rectangle(s, sides, (double[3]){x, y + depth, z}, up, along);
	add_rectangle(s, sides, (double[3]){x, y, z}, up, across);
	add_rectangle(s, sides, (double[3]){x + width, y, z}, across, up);
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

static double clamp(double x, double low, double high)
{
	return low > high ? (low + high) / 2 : fmin(fmax(x, low), high);
}

static void frustum_at(
	const struct synth_patch *p, double a, double b, double margin, struct synth_spot *spot)
{
	double dr = p->r1 - p->r0, dz = p->z1 - p->z0, length = hypot(dr, dz);
	/* Area grows with the radius squared. */
	double r = sqrt(p->r0 * p->r0 + a * (p->r1 * p->r1 - p->r0 * p->r0));
	double t = fabs(dr) > 1e-9 ? (r - p->r0) / dr : a, c = cos(2 * PI * b), s = sin(2 * PI * b);

	t = clamp(t, p->is_sharp[0] ? margin / length : 0, p->is_sharp[1] ? 1 - margin / length : 1);
	r = p->r0 + t * dr;
	spot->point[0] = p->centre[0] + r * c;
	spot->point[1] = p->centre[1] + r * s;
	spot->point[2] = p->centre[2] + p->z0 + t * dz;
	spot->normal[0] = dz / length * c;
	spot->normal[1] = dz / length * s;
	spot->normal[2] = -dr / length;
	spot->along[0] = dr / length * c;
	spot->along[1] = dr / length * s;
	spot->along[2] = dz / length;
	spot->room[0] =
		fmin(p->is_sharp[0] ? t * length : INFINITY, p->is_sharp[1] ? (1 - t) * length : INFINITY);
	spot->bend[0] = p->bend;
	/* A level ring is flat, but ends at its outer rim; others curve round the axis. */
	double rim = fmax(p->r0, p->r1);
	int is_sharp = p->is_sharp[p->r1 > p->r0], is_level = fabs(dz) < 1e-9;
	spot->room[1] = is_level && is_sharp ? sqrt(fmax(0, rim * rim - r * r)) : INFINITY;
	spot->bend[1] = is_level ? INFINITY : r * length / fabs(dz);
}

static void rectangle_at(
	const struct synth_patch *p, double a, double b, double margin, struct synth_spot *spot)
{
	double width = vector_length(p->u), depth = vector_length(p->v);

	a = clamp(a, margin / width, 1 - margin / width);
	b = clamp(b, margin / depth, 1 - margin / depth);
	vector_cross(p->u, p->v, spot->normal);
	for (int k = 0; k < 3; k++) {
		spot->point[k] = p->centre[k] + a * p->u[k] + b * p->v[k];
		spot->normal[k] /= p->area;
		spot->along[k] = p->u[k] / width;
	}
	spot->room[0] = width * fmin(a, 1 - a);
	spot->room[1] = depth * fmin(b, 1 - b);
	spot->bend[0] = spot->bend[1] = INFINITY;
}

static void half_ring_at(const struct synth_patch *p, double a, double b, struct synth_spot *spot)
{
	double turn = PI * (a - 0.5), c = cos(2 * PI * b), s = sin(2 * PI * b), r = p->r0 + p->r1 * c;

	spot->point[0] = p->centre[0] + r * cos(turn);
	spot->point[1] = p->centre[1] + p->r1 * s;
	spot->point[2] = p->centre[2] + r * sin(turn);
	spot->normal[0] = c * cos(turn);
	spot->normal[1] = s;
	spot->normal[2] = c * sin(turn);
	spot->along[0] = -sin(turn);
	spot->along[1] = 0;
	spot->along[2] = cos(turn);
	spot->room[0] = spot->room[1] = INFINITY;
	spot->bend[0] = p->r0;
	spot->bend[1] = p->r1;
}

void synth_surface_spot(
	const struct synth_surface *s, double a, double b, double margin, struct synth_spot *spot)
{
	double at = a * s->area;
	int i = 0;

	while (i + 1 < s->n && at >= s->patches[i].area)
		at -= s->patches[i++].area;
	const struct synth_patch *p = &s->patches[i];
	at = fmin(at / p->area, 1);
	spot->tint = p->tint;
	switch (p->kind) {
	case SYNTH_FRUSTUM:
		frustum_at(p, at, b, margin, spot);
		break;
	case SYNTH_RECTANGLE:
		rectangle_at(p, at, b, margin, spot);
		break;
	case SYNTH_HALF_RING:
		half_ring_at(p, at, b, spot);
		break;
	}
}

static double patch_reach(const struct synth_patch *p, const double d[3])
{
	const double level = hypot(d[0], d[1]);

	switch (p->kind) {
	case SYNTH_FRUSTUM:
		return fmax(p->r0 * level + p->z0 * d[2], p->r1 * level + p->z1 * d[2]);
	case SYNTH_RECTANGLE:
		return fmax(0, vector_dot(p->u, d)) + fmax(0, vector_dot(p->v, d));
	case SYNTH_HALF_RING: {
		/* The ring's point that is farthest along d, then the tube's around it. */
		const double along = d[0] > 0 ? hypot(d[0], d[2]) : fabs(d[2]);
		return p->r0 * along + p->r1 * hypot(along, d[1]);
	}
	}
	return 0;
}

double synth_surface_reach(const struct synth_surface *s, const double d[3])
{
	double most = -INFINITY;

	for (int i = 0; i < s->n; i++) {
		const struct synth_patch *p = &s->patches[i];
		most = fmax(most, vector_dot(p->centre, d) + patch_reach(p, d));
	}
	return most;
}
