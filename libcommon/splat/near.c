#include "splat/near.h"

#include "base/mem.h"
#include "splat/kernels.h"

#include <math.h>
#include <stdint.h>

#define NEAR_FIRST 0.05	 /* of the Gaussians in view */
#define NEAR_SHARE 0.02	 /* what 0.2 is of d in a real scene of 3DGS */
#define NEAR_MOST 0.1	 /* of d */
#define NEAR_COVERS 0.03 /* of a picture; there, all that hide a view cover 0.4, no thing 0.025 */
#define NEAR_SAME 5e-4	 /* of all pictures */

/* Depths are counted by the first bits of their floats: by steps of 1/4096. Views count in slabs. */
enum { DROPPED_BITS = 11, STEPS = 1 << (31 - DROPPED_BITS), SLABS = 8 };

static double depth(const struct camera *c, const float *mean)
{
	const double *row = c->world_to_camera[2];

	return row[0] * mean[0] + row[1] * mean[1] + row[2] * mean[2] + row[3];
}

static void count_view(const struct splats *s, const struct camera *c, uint64_t *counts)
{
	for (size_t i = 0; i < s->n; i++) {
		const float *m = s->means + 3 * i;
		double x[3];
		if (!(depth(c, m) > 0) || !(255 * (double)s->opacities[i] >= 1))
			continue;
		camera_transform(c, (double[3]){m[0], m[1], m[2]}, x);
		const double column = c->fx * x[0] + c->cx * x[2], row = c->fy * x[1] + c->cy * x[2];
		if (!(column >= 0 && column <= c->width * x[2] && row >= 0 && row <= c->height * x[2]))
			continue;
		const float z = (float)x[2];
		uint32_t bits;
		memcpy(&bits, &z, sizeof bits);
		counts[bits >> DROPPED_BITS]++;
	}
}

/* d, or 0 where no view has a Gaussian. */
static int find_first(const struct splats *s, const struct cameras *cameras, double *first, struct err *e)
{
	SCOPED uint64_t *counts = mem_zalloc(STEPS, SLABS * sizeof *counts, "depths", e);
	uint64_t all = 0, passed = 0;
	uint32_t k = 0;
	float z;

	*first = 0;
	if (!counts)
		return -1;
#pragma omp parallel for schedule(dynamic)
	for (size_t slab = 0; slab < SLABS; slab++)
		for (size_t v = slab; v < cameras->n; v += SLABS)
			count_view(s, &cameras->views[v], counts + slab * STEPS);
	for (size_t i = STEPS; i < (size_t)SLABS * STEPS; i++)
		counts[i % STEPS] += counts[i];
	for (size_t i = 0; i < STEPS; i++)
		all += counts[i];
	while (all && (double)(passed += counts[k]) <= NEAR_FIRST * (double)all)
		k++;
	k <<= DROPPED_BITS;
	memcpy(&z, &k, sizeof z);
	*first = (double)z;
	return 0;
}

/* The share of the picture that a lane's Gaussian covers, at most that of its box. */
static double covers(const struct project_lens *lens, const struct project_batch *b, int l)
{
	const double whole = exp2(b->log_opacity[l]) * acos(-1) / (log(2) * b->l11[l] * b->l22[l]);
	const double box =
		(double)(b->columns[1][l] - b->columns[0][l] + 1) * (b->rows[1][l] - b->rows[0][l] + 1);

	return fmin(whole, box) / (lens->width * lens->height);
}

/* What a view shows of the Gaussians between two depths. */
struct between {
	double last;   /* the largest depth of one that covers NEAR_COVERS; else the lower of the two */
	double covers; /* shares of the picture, added up */
};

static struct between look(const struct splats *s, const struct camera *c, double low, double high)
{
	const struct kernels *kernels = kernels_of(cpu_level());
	struct project_batch b __attribute__((aligned(64))) = {0};
	struct between found = {.last = low};
	struct project_lens lens;

	project_lens_make(&lens, c, low);
	for (size_t i = 0; i < s->n;) {
		int lanes = 0;
		for (; i < s->n && lanes < PROJECT_LANES; i++) {
			const double z = depth(c, s->means + 3 * i);
			lanes += z > low && z <= high && project_take(&b, s, i, lanes);
		}
		kernels->project(&lens, &b, lanes);
		for (int l = 0; l < lanes; l++) {
			const double share = b.seen[l] ? covers(&lens, &b, l) : 0;
			found.covers += share;
			if (share >= NEAR_COVERS)
				found.last = fmax(found.last, b.z[l]);
		}
	}
	return found;
}

/* In all views: the largest last, and the mean of covers. */
static int look_all(const struct splats *s, const struct cameras *cameras, double low, double high,
	struct between *all, struct err *e)
{
	SCOPED struct between *views = mem_alloc(cameras->n, sizeof *views, "views", e);

	*all = (struct between){.last = low};
	if (!views)
		return -1;
#pragma omp parallel for schedule(dynamic)
	for (size_t v = 0; v < cameras->n; v++)
		views[v] = look(s, &cameras->views[v], low, high);
	for (size_t v = 0; v < cameras->n; v++) {
		all->last = fmax(all->last, views[v].last);
		all->covers += views[v].covers / (double)cameras->n;
	}
	return 0;
}

int near_find(struct splats *s, const struct cameras *cameras, struct err *e)
{
	struct between found;
	double first;

	if (find_first(s, cameras, &first, e))
		return -1;
	if (!(first > 0))
		return 0;
	if (look_all(s, cameras, NEAR_SHARE * first, NEAR_MOST * first, &found, e))
		return -1;
	const double near = found.last, same = SPLATS_NEAR <= NEAR_MOST * first ? NEAR_SAME : 0;
	if (SPLATS_NEAR < first &&
		look_all(s, cameras, fmin(near, SPLATS_NEAR), fmax(near, SPLATS_NEAR), &found, e))
		return -1;
	if (!(SPLATS_NEAR < first && found.covers <= same))
		s->near = near;
	return 0;
}
