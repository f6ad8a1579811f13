/* Views of which only some tiles are wanted: blended there as in the whole view, and 0 elsewhere. */
#include "unit.h"

#include "base/rng.h"
#include "render_compare.h"
#include "splat/render.h"
#include "splat/view.h"

/* Gaussians around a camera that looks along z, few of them wanted: sizes from needles to larger than the
 * view. */
static struct splats scattered(size_t n, struct rng *r)
{
	struct splats s;
	struct err e;

	if (splats_alloc(&s, n, 1, &e))
		abort();
	for (size_t i = 0; i < n; i++) {
		const double z = rng_range(r, -1, 6), size = 0.02 * exp(1.2 * rng_normal(r));
		s.means[3 * i] = (float)(z * rng_range(r, -1.2, 1.2));
		s.means[3 * i + 1] = (float)(z * rng_range(r, -1.2, 1.2));
		s.means[3 * i + 2] = (float)z;
		for (size_t k = 0; k < 3; k++)
			s.scales[3 * i + k] = (float)(size * exp(rng_normal(r)));
		for (size_t k = 0; k < 4; k++)
			s.quats[4 * i + k] = (float)rng_normal(r);
		s.opacities[i] = (float)rng_uniform(r);
	}
	return s;
}

/* A camera that is turned, off its centre, and longer in one direction. */
static struct camera make_camera(struct rng *r, int width, int height)
{
	const double turn = rng_range(r, -0.4, 0.4);
	struct camera c = {.width = width,
		.height = height,
		.fx = rng_range(r, 0.5, 2) * width,
		.fy = rng_range(r, 0.5, 2) * height,
		.cx = rng_range(r, 0.2, 0.8) * width,
		.cy = rng_range(r, 0.2, 0.8) * height};

	c.world_to_camera[0][0] = c.world_to_camera[2][2] = cos(turn);
	c.world_to_camera[0][2] = sin(turn);
	c.world_to_camera[2][0] = -sin(turn);
	c.world_to_camera[1][1] = c.world_to_camera[3][3] = 1;
	return c;
}

/* As answers have them: some below 0 everywhere but at few Gaussians. values (N,channels) */
static void fill(struct rng *r, size_t n, int channels, double part, float *values, uint8_t *is_wanted)
{
	for (size_t i = 0; i < n; i++) {
		is_wanted[i] = rng_uniform(r) < part;
		for (int k = 0; k < channels; k++)
			values[i * (size_t)channels + (size_t)k] =
				is_wanted[i] && rng_below(r, 2) ? (float)rng_uniform(r) : -0.01f;
	}
}

static size_t shown; /* values above 0 so far */

static void check(uint64_t seed, size_t n, int width, int height, double part)
{
	enum { CHANNELS = 3 };
	const size_t pixels = (size_t)width * (size_t)height;
	float *values = malloc(n * CHANNELS * sizeof *values),
	      *whole = malloc(pixels * CHANNELS * sizeof *whole),
	      *some = malloc(pixels * CHANNELS * sizeof *some);
	uint8_t *is_wanted = malloc(n);
	size_t wrong = 0, above = 0, lost = 0;
	struct rng r;
	struct err e;

	rng_seed(&r, seed, 1);
	struct splats s = scattered(n, &r);
	const struct camera c = make_camera(&r, width, height);
	fill(&r, n, CHANNELS, part, values, is_wanted);
	struct render_view *all = render_prepare(&s, &c, &e),
			   *where = render_prepare_where(&s, &c, is_wanted, &e);
	if (CHECK(all && where, "%s", e.message)) {
		render_packed(all, values, CHANNELS, whole, NULL);
		render_packed(where, values, CHANNELS, some, NULL);
		for (size_t p = 0; p < pixels * CHANNELS; p++) {
			wrong += some[p] != 0 && some[p] != whole[p];
			above += whole[p] > 0;
			lost += whole[p] > 0 && !(some[p] > 0);
		}
		CHECK(!wrong, "seed %d: %zu values differ", (int)seed, wrong);
		CHECK(!lost, "seed %d: %zu of %zu values above 0 are lost", (int)seed, lost, above);
		shown += above;
		CHECK(where->visible <= all->visible && (part > 0 || !where->visible),
			"seed %d: %zu Gaussians", (int)seed, where->visible);
		/* and the whole view in the same memory */
		CHECK(!render_again(where, &s, &c, &e) && where->visible == all->visible, "seed %d: again",
			(int)seed);
	}
	render_free(all);
	render_free(where);
	splats_free(&s);
	free(values);
	free(whole);
	free(some);
	free(is_wanted);
}

/* A small thing in a corner leaves most Gaussians out. */
static void most_are_left_out(void)
{
	const struct camera c = camera_at_origin(320, 240, 300);
	enum { N = 4000 };
	uint8_t is_wanted[N] = {1};
	struct rng r;
	struct err e;

	rng_seed(&r, 5, 1);
	struct splats s = scattered(N, &r);
	memcpy(s.means, (float[]){-0.9f, -0.6f, 2}, 3 * sizeof(float));
	memcpy(s.scales, (float[]){0.01f, 0.01f, 0.01f}, 3 * sizeof(float));
	s.opacities[0] = 0.9f;
	struct render_view *all = render_prepare(&s, &c, &e),
			   *where = render_prepare_where(&s, &c, is_wanted, &e);
	if (CHECK(all && where, "%s", e.message))
		CHECK(where->visible > 0 && where->visible < all->visible / 2, "%zu of %zu", where->visible,
			all->visible);
	render_free(all);
	render_free(where);
	splats_free(&s);
}

int main(void)
{
	for (uint64_t seed = 1; seed <= 40; seed++)
		check(seed, 400, 100 + (int)seed % 40, 70 + (int)seed % 33, seed % 3 ? 0.03 : 0.3);
	CHECK(shown > 10000, "%zu values are above 0", shown);
	check(41, 1500, 90, 60, 0);
	check(42, 1500, 17, 1, 0.5);
	most_are_left_out();
	return unit_end();
}
