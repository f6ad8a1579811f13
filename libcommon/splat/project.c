#include "splat/project.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
	BLOCK = 4096, /* Gaussians a parallel task */
	RADIX_BITS = 11,
	RADIX_PASSES = 3,
	KEY_BITS = 32,
};

#define NEAR_PLANE 0.2
#define LOW_PASS 0.3 /* px^2 */

/* What a camera contributes to every Gaussian. */
struct lens {
	const struct camera *camera;
	double normal[3][3];	/* row k: the cross product of the rotation's other two rows */
	double low[2], high[2]; /* limits of x/z and y/z in the Jacobian */
};

static void lens_make(struct lens *lens, const struct camera *c)
{
	double half_x = 0.5 * c->width / c->fx, half_y = 0.5 * c->height / c->fy;

	lens->camera = c;
	for (int k = 0; k < 3; k++) {
		const double *a = c->world_to_camera[(k + 1) % 3], *b = c->world_to_camera[(k + 2) % 3];
		for (int i = 0; i < 3; i++)
			lens->normal[k][i] =
				a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
	}
	/* 1.3 times the half field of view where the principal point is central: 0.3 of it beyond each edge
	 */
	lens->low[0] = -c->cx / c->fx - 0.3 * half_x;
	lens->high[0] = (c->width - c->cx) / c->fx + 0.3 * half_x;
	lens->low[1] = -c->cy / c->fy - 0.3 * half_y;
	lens->high[1] = (c->height - c->cy) / c->fy + 0.3 * half_y;
}

static double clamp(double x, double low, double high)
{
	return x < low ? low : x > high ? high : x;
}

static double dot(const double a[3], const double b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Row k is the Gaussian's axis k in the world: the columns of its rotation, for a quaternion of any length.
 */
static void quat_axes(const float q[4], double axis[3][3])
{
	double w = q[0], x = q[1], y = q[2], z = q[3], two = 2 / (w * w + x * x + y * y + z * z);

	axis[0][0] = 1 - two * (y * y + z * z);
	axis[0][1] = two * (x * y + w * z);
	axis[0][2] = two * (x * z - w * y);
	axis[1][0] = two * (x * y - w * z);
	axis[1][1] = 1 - two * (x * x + z * z);
	axis[1][2] = two * (y * z + w * x);
	axis[2][0] = two * (x * z + w * y);
	axis[2][1] = two * (y * z - w * x);
	axis[2][2] = 1 - two * (x * x + y * y);
}

/* 1 where [x - half, x + half] holds a pixel centre of 0.5 ... size - 0.5. */
static int holds_centre(double x, double half, int size)
{
	double first = ceil(fmax(x - half, 0.5) - 0.5), last = floor(fmin(x + half, size - 0.5) - 0.5);

	return first <= last;
}

/* The 2D covariance J W Sigma W^T J^T + 0.3 I and its determinant. With M = J W R S (2x3) the determinant is
 * a sum of squares, det(M M^T) = sum of the squared 2x2 minors of M (Cauchy-Binet), plus 0.3 trace + 0.09; a
 * minor is s_j s_k times the third axis dot the cross product of the rows of J W. Nothing cancels, so needles
 * keep their width. */
static double covariance(const struct lens *lens, const double camera[3], const float scale[3],
	const float quat[4], double *xx, double *xy, double *yy)
{
	const struct camera *c = lens->camera;
	double tx = clamp(camera[0] / camera[2], lens->low[0], lens->high[0]), fx = c->fx / camera[2];
	double ty = clamp(camera[1] / camera[2], lens->low[1], lens->high[1]), fy = c->fy / camera[2];
	double rows[2][3], normal[3], axis[3][3], trace, det = 0;

	for (int i = 0; i < 3; i++) {
		rows[0][i] = fx * (c->world_to_camera[0][i] - tx * c->world_to_camera[2][i]);
		rows[1][i] = fy * (c->world_to_camera[1][i] - ty * c->world_to_camera[2][i]);
		normal[i] =
			fx * fy * (lens->normal[2][i] + tx * lens->normal[0][i] + ty * lens->normal[1][i]);
	}
	quat_axes(quat, axis);
	*xx = *xy = *yy = 0;
	for (int k = 0; k < 3; k++) {
		double mx = scale[k] * dot(rows[0], axis[k]), my = scale[k] * dot(rows[1], axis[k]);
		double minor = (double)scale[(k + 1) % 3] * scale[(k + 2) % 3] * dot(normal, axis[k]);
		*xx += mx * mx;
		*xy += mx * my;
		*yy += my * my;
		det += minor * minor;
	}
	trace = *xx + *yy;
	*xx += LOW_PASS;
	*yy += LOW_PASS;
	return det + LOW_PASS * trace + LOW_PASS * LOW_PASS;
}

double projected_width(const struct projected *p)
{
	return p->radius * sqrt(p->l21 * p->l21 + p->l22 * p->l22) / (p->l11 * p->l22);
}

double projected_height(const struct projected *p)
{
	return p->radius / p->l22;
}

/* 1 and *p where Gaussian i may touch a pixel. */
static int project_one(const struct lens *lens, const struct splats *s, size_t i, struct projected *p)
{
	static const double half_log2e = 0.72134752044448170368;
	const struct camera *c = lens->camera;
	const float *mean = s->means + 3 * i;
	double opacity = s->opacities[i], world[3] = {mean[0], mean[1], mean[2]}, camera[3], xx, xy, yy;

	if (!(255 * opacity >= 1))
		return 0;
	camera_transform(c, world, camera);
	if (!(camera[2] > NEAR_PLANE))
		return 0;
	double det = covariance(lens, camera, s->scales + 3 * i, s->quats + 4 * i, &xx, &xy, &yy);
	double log_opacity = log2(opacity);
	/* 2^(log2 o - radius^2) = 1/255, with room for the float kernels' rounding: each pixel decides by
	 * itself */
	double radius = sqrt(log_opacity + 7.9943534368588579 + 1e-4);
	*p = (struct projected){
		.x = c->fx * (camera[0] / camera[2]) + c->cx,
		.y = c->fy * (camera[1] / camera[2]) + c->cy,
		.l11 = sqrt(half_log2e * (yy / det)),
		.l22 = sqrt(half_log2e / yy),
		.radius = radius,
		.depth = camera[2],
		.log_opacity = (float)log_opacity,
		.index = (int32_t)i,
	};
	p->l21 = -p->l11 * (xy / yy);
	if (!isfinite(p->x) || !isfinite(p->y) || !isfinite(det) || !isfinite(p->l21))
		return 0;
	return holds_centre(p->x, projected_width(p), c->width) &&
	       holds_centre(p->y, projected_height(p), c->height);
}

struct item {
	uint32_t key, place;
};

static uint64_t depth_bits(double depth)
{
	uint64_t bits; /* of a positive double: they rise with it */

	memcpy(&bits, &depth, sizeof bits);
	return bits;
}

/* For qsort: items within a run of equal keys, by depth, then by index. */
struct exact {
	double depth;
	uint32_t place;
};

static int by_depth(const void *a, const void *b)
{
	const struct exact *x = a, *y = b;

	if (x->depth != y->depth)
		return x->depth < y->depth ? -1 : 1;
	return (x->place > y->place) - (x->place < y->place);
}

/* The keys hold the leading bits of the depths only: puts runs of equal keys in order by the whole depth. */
static int settle_runs(struct item *items, size_t n, const struct projected *p, struct err *e)
{
	for (size_t i = 0, end; i < n; i = end) {
		int is_sorted = 1;
		for (end = i + 1; end < n && items[end].key == items[i].key; end++)
			is_sorted &= p[items[end - 1].place].depth <= p[items[end].place].depth;
		if (is_sorted)
			continue;
		struct exact *run = mem_alloc(end - i, sizeof *run, "depth order", e);
		if (!run)
			return -1;
		for (size_t k = i; k < end; k++)
			run[k - i] = (struct exact){p[items[k].place].depth, items[k].place};
		qsort(run, end - i, sizeof *run, by_depth);
		for (size_t k = i; k < end; k++)
			items[k].place = run[k - i].place;
		free(run);
	}
	return 0;
}

/* Stable radix sort by key; `spare` holds n items too. Returns the one that has the result. */
static struct item *radix_sort(struct item *items, struct item *spare, size_t n)
{
	for (int pass = 0; pass < RADIX_PASSES; pass++) {
		size_t start[1 << RADIX_BITS] = {0}, sum = 0;
		int shift = pass * RADIX_BITS, mask = (1 << RADIX_BITS) - 1;
		for (size_t i = 0; i < n; i++)
			start[items[i].key >> shift & mask]++;
		for (int d = 0; d <= mask; d++) {
			size_t here = start[d];
			start[d] = sum;
			sum += here;
		}
		for (size_t i = 0; i < n; i++)
			spare[start[items[i].key >> shift & mask]++] = items[i];
		struct item *swap = items;
		items = spare;
		spare = swap;
	}
	return items;
}

/* *out gets the n entries of p, which stand by index, front to back. */
static int sort_by_depth(const struct projected *p, size_t n, struct projected **out, struct err *e)
{
	struct item *items = mem_alloc(n, 2 * sizeof *items, "depth order", e);
	struct projected *sorted = mem_alloc(n, sizeof *sorted, "projected Gaussians", e);
	uint64_t low = UINT64_MAX, high = 0;
	int shift = 0, bad = -1;

	if (!items || !sorted)
		goto done;
	for (size_t i = 0; i < n; i++) {
		uint64_t bits = depth_bits(p[i].depth);
		low = bits < low ? bits : low;
		high = bits > high ? bits : high;
	}
	while (n && (high - low) >> shift >> KEY_BITS)
		shift++;
	for (size_t i = 0; i < n; i++)
		items[i] = (struct item){(uint32_t)((depth_bits(p[i].depth) - low) >> shift), (uint32_t)i};
	struct item *order = radix_sort(items, items + n, n);
	if (shift && settle_runs(order, n, p, e))
		goto done;
#pragma omp parallel for schedule(static)
	for (size_t i = 0; i < n; i++)
		sorted[i] = p[order[i].place];
	*out = sorted;
	sorted = NULL;
	bad = 0;
done:
	free(items);
	free(sorted);
	return bad;
}

int project_splats(
	const struct splats *s, const struct camera *c, struct projected **out, size_t *count, struct err *e)
{
	size_t blocks = s->n / BLOCK + (s->n % BLOCK != 0), n = 0;
	struct lens lens;

	if (s->n > INT32_MAX)
		return err_set(e, ERR_FORMAT, "%zu Gaussians are more than the %d that can be indexed", s->n,
			INT32_MAX);
	struct projected *all = mem_alloc(s->n, sizeof *all, "projected Gaussians", e);
	size_t *found = mem_zalloc(blocks, sizeof *found, "projected Gaussians", e);
	if (!all || !found) {
		free(all);
		free(found);
		return -1;
	}
	lens_make(&lens, c);
#pragma omp parallel for schedule(dynamic)
	for (size_t b = 0; b < blocks; b++) {
		size_t end = (b + 1) * BLOCK < s->n ? (b + 1) * BLOCK : s->n;
		for (size_t i = b * BLOCK; i < end; i++)
			found[b] += (size_t)project_one(&lens, s, i, &all[b * BLOCK + found[b]]);
	}
	for (size_t b = 0; b < blocks; b++) {
		memmove(all + n, all + b * BLOCK, found[b] * sizeof *all);
		n += found[b];
	}
	*count = n;
	int bad = sort_by_depth(all, n, out, e);
	free(all);
	free(found);
	return bad;
}
