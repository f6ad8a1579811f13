/* The near plane is the scene's: the same Gaussians are left out in any unit. */
#include "unit.h"
#include "splat/near.h"

#include <math.h>
#include <string.h>

enum { THINGS = 200, N = THINGS + 1 };

/* A camera at the origin before a wall of small Gaussians at depths 4 to 6, and one Gaussian at depth `at`,
 * all in a unit of which there are `unit` to one. Returns the near plane. */
static double near_of(double unit, double at, double size)
{
	struct camera c = {
		.width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 32, .cy = 24, .world_to_camera = {{1}}};
	const struct cameras cameras = {1, &c};
	struct splats s;
	struct err e;

	for (int k = 0; k < 4; k++)
		c.world_to_camera[k][k] = 1;
	if (!CHECK(!splats_alloc(&s, N, 1, &e), "%s", e.message))
		return 0;
	for (size_t i = 0; i < N; i++) {
		const double z = i < THINGS ? 4 + 2.0 * (double)i / THINGS : at;
		const double x[3] = {i < THINGS ? sin((double)i) : 0, i < THINGS ? cos((double)i) : 0, z};
		for (size_t k = 0; k < 3; k++) {
			s.means[3 * i + k] = (float)(unit * x[k]);
			s.scales[3 * i + k] = (float)(unit * (i < THINGS ? 0.05 : size));
		}
		memcpy(s.quats + 4 * i, (float[]){1, 0, 0, 0}, 4 * sizeof(float));
		s.opacities[i] = 0.9f;
	}
	CHECK(s.near == SPLATS_NEAR, "splats begin with that of 3DGS");
	CHECK(!near_find(&s, &cameras, &e), "%s", e.message);
	const double near = s.near;
	splats_free(&s);
	return near;
}

int main(void)
{
	static const double units[] = {1e-3, 0.04, 0.3, 1, 2, 30, 1e3};

	CHECK(near_of(1, 5, 0.05) == SPLATS_NEAR, "nothing is near");
	CHECK(near_of(30, 5, 0.05) == SPLATS_NEAR, "nothing is near in a large scene");
	CHECK(near_of(1, 0.15, 0.05) == SPLATS_NEAR, "0.2 leaves out what hides the view, as 3DGS does");
	for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
		const double u = units[i], none = near_of(u, 5, 0.05) / u, hides = near_of(u, 0.15, 0.05) / u,
			     small = near_of(u, 0.15, 1e-3) / u, thing = near_of(u, 1, 0.05) / u;
		CHECK(none > 0 && none < 4, "unit %g: the plane at %g is before what there is", u, none);
		CHECK(hides >= 0.1499 && hides < 4, "unit %g: at %g, what hides the view is left out", u,
			hides);
		CHECK((small < 0.15) == (near_of(1, 0.15, 1e-3) < 0.15),
			"unit %g: at %g, a small one is left out as in any", u, small);
		CHECK(thing < 1, "unit %g: at %g, a thing is shown", u, thing);
	}
	return unit_end();
}
