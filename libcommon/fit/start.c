#include "fit/start.h"

#include "base/mem.h"
#include "geom/neighbours.h"
#include "splat/sh.h"

#include <math.h>

#define OPACITY 0.5f /* 3DGS-MCMC's; 3DGS has 0.1 */
enum { NEIGHBOURS = 3 };

static void find_mean(const struct camera *const *cameras, size_t n, double mean[3])
{
	double centre[3];

	memset(mean, 0, 3 * sizeof *mean);
	for (size_t i = 0; i < n; i++) {
		camera_centre(cameras[i], centre);
		for (int k = 0; k < 3; k++)
			mean[k] += centre[k] / (double)n;
	}
}

double start_size(const struct camera *const *cameras, size_t n, const float *points, size_t points_n)
{
	double mean[3], sum = 0;

	find_mean(cameras, n, mean);
	for (size_t i = 0; i < points_n; i++) {
		const float *p = points + 3 * i;
		sum += hypot(hypot(p[0] - mean[0], p[1] - mean[1]), p[2] - mean[2]) / (double)points_n;
	}
	return sum > 0 ? sum : 1;
}

double start_extent(const struct camera *const *cameras, size_t n, const float *points, size_t points_n)
{
	double mean[3], centre[3], middle[3] = {0}, most = 0, far = 0;

	find_mean(cameras, n, mean);
	for (size_t i = 0; i < n; i++) {
		camera_centre(cameras[i], centre);
		most = fmax(
			most, hypot(hypot(centre[0] - mean[0], centre[1] - mean[1]), centre[2] - mean[2]));
	}
	for (size_t i = 0; i < 3 * points_n; i++)
		middle[i % 3] += points[i] / (double)points_n;
	far = hypot(hypot(middle[0] - mean[0], middle[1] - mean[1]), middle[2] - mean[2]);
	return most > 1e-3 * far ? 1.1 * most : far > 0 ? 0.1 * far : 1;
}

void start_points(const struct camera *const *cameras, size_t cameras_n, double *points, uint8_t *colors,
	size_t n, struct rng *rng)
{
	double low[3], high[3], centre[3], most = 0;

	for (size_t i = 0; i < cameras_n; i++) {
		camera_centre(cameras[i], centre);
		for (int k = 0; k < 3; k++) {
			low[k] = i && low[k] < centre[k] ? low[k] : centre[k];
			high[k] = i && high[k] > centre[k] ? high[k] : centre[k];
			most = fmax(most, high[k] - low[k]);
		}
	}
	most = most > 0 ? most : 1;
	for (size_t i = 0; i < 3 * n; i++) {
		points[i] = rng_range(rng, low[i % 3] - most, high[i % 3] + most);
		colors[i] = 127;
	}
}

size_t start_number(size_t points)
{
	return points < 2000 ? 20000 : points > 50000 ? 500000 : 10 * points;
}

int start_at_points(
	struct fit_gaussians *g, const float *points, const uint8_t *colors, size_t n, struct err *e)
{
	float *const *to = g->at[FIT_VALUE];
	const size_t room = g->capacity - g->n < n ? g->capacity - g->n : n;
	SCOPED float *far = mem_zalloc(n, 2 * sizeof *far, "points", e);
	int bad = !far;

	for (int k = 1; k <= NEIGHBOURS && !bad; k++) {
		bad = neighbours_find(points, n, k, far + n, e) != 0;
		for (size_t i = 0; i < n && !bad; i++)
			far[i] += far[n + i] * far[n + i] / NEIGHBOURS;
	}
	for (size_t i = 0; i < n && !bad; i++) {
		const size_t at = g->n;
		/* alone, or on top of another */
		const float scale = isfinite(far[i]) ? sqrtf(fmaxf(far[i], 1e-14f)) : 0.1f;
		if ((i + 1) * room / n == i * room / n)
			continue;
		memcpy(to[FIT_MEAN] + 3 * at, points + 3 * i, 3 * sizeof(float));
		for (size_t k = 0; k < 3; k++) {
			to[FIT_SCALE][3 * at + k] = logf(scale);
			to[FIT_SH][3 * at + k] = ((float)colors[3 * i + k] / 255 - 0.5f) / (float)SH_C0;
		}
		to[FIT_QUAT][4 * at] = 1;
		to[FIT_LOGIT][at] = logf(OPACITY / (1 - OPACITY));
		g->n++;
	}
	return bad ? -1 : 0;
}
