/* formats/scene/motion.h: which stored time a time is, and that times leave no traces of each other. */
#include "formats/scene/motion.h"
#include "unit.h"

int main(void)
{
	static const double at[] = {0, 1, 3};
	static const int32_t ids[] = {1};
	static const float means[] = {1, 2, 3, 4, 5, 6, 7, 8, 9},
			   quats[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
	const struct motion m = {.times = 3,
		.moved = 1,
		.gaussians = 2,
		.at = at,
		.ids = ids,
		.means = means,
		.quats = quats,
		.file = {.path = (char[]){"m"}}};
	static const struct {
		double t;
		size_t frame;
	} nearest[] = {{0, 0}, {0.5, 0}, {0.51, 1}, {1, 1}, {2, 1}, {2.01, 2}, {3, 2}};
	float own_means[6] = {9, 9, 9, 1, 2, 3}, own_quats[8] = {1, 0, 0, 0, 1, 0, 0, 0};
	struct splats s = {.n = 2, .means = own_means, .quats = own_quats};
	struct err e;
	size_t frame;

	for (size_t i = 0; i < sizeof nearest / sizeof *nearest; i++)
		CHECK(!motion_find(&m, nearest[i].t, &frame, &e) && frame == nearest[i].frame, "time %g",
			nearest[i].t);
	CHECK(motion_find(&m, 3.5, &frame, &e) && e.code == ERR_FORMAT, "after the last");
	CHECK(!strcmp(e.message, "m: time 3.5 is not within its times, 0 to 3"), "%s", e.message);
	CHECK(motion_find(&m, -0.1, &frame, &e) && motion_find(&m, (double)NAN, &frame, &e),
		"before, and none");
	CHECK(!motion_set(&m, 3, &s, &e), "%s", e.message);
	CHECK(own_means[0] == 9 && own_means[3] == 7 && own_means[5] == 9 && own_quats[6] == 1, "the last");
	CHECK(!motion_set(&m, 0.2, &s, &e), "%s", e.message);
	CHECK(own_means[3] == 1 && own_quats[4] == 1 && own_quats[6] == 0, "the first again");
	return unit_end();
}
