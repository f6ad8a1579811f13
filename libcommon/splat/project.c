#include "splat/project.h"

#include "base/mem.h"
#include "splat/kernels.h"

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

static void lens_make(struct project_lens *lens, const struct camera *c)
{
	double half_x = 0.5 * c->width / c->fx, half_y = 0.5 * c->height / c->fy;

	memcpy(lens->world_to_camera, c->world_to_camera, sizeof lens->world_to_camera);
	lens->fx = c->fx;
	lens->fy = c->fy;
	lens->cx = c->cx;
	lens->cy = c->cy;
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

/* 1 where [x - half, x + half] holds a pixel centre of 0.5 ... size - 0.5. */
static int holds_centre(double x, double half, int size)
{
	double low = x - half - 0.5, high = x + half - 0.5;

	if (!(high >= 0 && low <= size - 1))
		return 0;
	low = low > 0 ? low : 0;
	high = high < size - 1 ? high : size - 1;
	int first = (int)low;
	return first + (first < low) <= (int)high;
}

/* 1 and *p where lane l of the batch, Gaussian i, may touch a pixel. */
static int make_projected(const struct camera *c, const struct project_batch *b, int l, double opacity,
	size_t i, struct projected *p)
{
	static const double half_log2e = 0.72134752044448170368;
	double xx = b->xx[l], xy = b->xy[l], yy = b->yy[l], det = b->det[l];

	if (!(b->z[l] > NEAR_PLANE) || !isfinite(b->x[l]) || !isfinite(b->y[l]) || !isfinite(det))
		return 0;
	double log_opacity = log2(opacity);
	/* 2^(log2 o - radius^2) = 1/255, with room for the float kernels' rounding: each pixel decides by
	 * itself */
	double reach = log_opacity + 7.9943534368588579 + 1e-4, per_variance = reach / half_log2e;
	*p = (struct projected){
		.x = b->x[l],
		.y = b->y[l],
		.l11 = sqrt(half_log2e * (yy / det)),
		.l22 = sqrt(half_log2e / yy),
		.radius = sqrt(reach),
		.half_width = (float)((1 + 1e-6) * sqrt(per_variance * xx)),
		.half_height = (float)((1 + 1e-6) * sqrt(per_variance * yy)),
		.log_opacity = (float)log_opacity,
		.index = (int32_t)i,
	};
	p->l21 = -p->l11 * (xy / yy);
	return holds_centre(p->x, p->half_width, c->width) && holds_centre(p->y, p->half_height, c->height);
}

/* Projects Gaussians begin to end - 1; returns how many are visible, which stand in *p and *depth from the
 * first on. */
static size_t project_block(const struct kernels *kernels, const struct project_lens *lens,
	const struct splats *s, const struct camera *c, size_t begin, size_t end, struct projected *p,
	double *depth)
{
	struct project_batch b = {0};
	size_t found = 0, number[PROJECT_LANES];

	for (size_t i = begin; i < end;) {
		int lanes = 0;
		/* a lane for each that is not too faint; lanes left over compute what is not looked at */
		for (; i < end && lanes < PROJECT_LANES; i++) {
			if (!(255 * (double)s->opacities[i] >= 1))
				continue;
			for (size_t k = 0; k < 3; k++) {
				b.mean[k][lanes] = s->means[3 * i + k];
				b.scale[k][lanes] = s->scales[3 * i + k];
			}
			for (size_t k = 0; k < 4; k++)
				b.quat[k][lanes] = s->quats[4 * i + k];
			number[lanes++] = i;
		}
		kernels->project(lens, &b);
		for (int l = 0; l < lanes; l++)
			if (make_projected(c, &b, l, s->opacities[number[l]], number[l], &p[found]))
				depth[found++] = b.z[l];
	}
	return found;
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
static int settle_runs(struct item *items, size_t n, const double *depth, struct err *e)
{
	for (size_t i = 0, end; i < n; i = end) {
		int is_sorted = 1;
		for (end = i + 1; end < n && items[end].key == items[i].key; end++)
			is_sorted &= depth[items[end - 1].place] <= depth[items[end].place];
		if (is_sorted)
			continue;
		struct exact *run = mem_alloc(end - i, sizeof *run, "depth order", e);
		if (!run)
			return -1;
		for (size_t k = i; k < end; k++)
			run[k - i] = (struct exact){depth[items[k].place], items[k].place};
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

/* What the blocks found: block b's entries stand at b * BLOCK. */
struct visible {
	size_t blocks, n;
	size_t *found; /* (blocks) */
	struct projected *projected;
	double *depth;
};

/* Keys of all depths: their distance from the least one, less the bits that do not fit. Returns 1 where any
 * were lost. */
static int make_keys(const struct visible *v, struct item *items)
{
	uint64_t low = UINT64_MAX, high = 0;
	size_t n = 0;
	int shift = 0;

	for (size_t b = 0; b < v->blocks; b++)
		for (size_t i = b * BLOCK; i < b * BLOCK + v->found[b]; i++) {
			uint64_t bits = depth_bits(v->depth[i]);
			low = bits < low ? bits : low;
			high = bits > high ? bits : high;
		}
	while (v->n && (high - low) >> shift >> KEY_BITS)
		shift++;
	for (size_t b = 0; b < v->blocks; b++)
		for (size_t i = b * BLOCK; i < b * BLOCK + v->found[b]; i++)
			items[n++] = (struct item){
				(uint32_t)((depth_bits(v->depth[i]) - low) >> shift), (uint32_t)i};
	return shift > 0;
}

/* *out gets the visible ones front to back. */
static int sort_by_depth(const struct visible *v, struct projected **out, struct err *e)
{
	struct item *items = mem_alloc(v->n, 2 * sizeof *items, "depth order", e);
	struct projected *sorted = mem_alloc(v->n, sizeof *sorted, "projected Gaussians", e);
	int bad = !items || !sorted;

	if (!bad) {
		int is_coarse = make_keys(v, items);
		struct item *order = radix_sort(items, items + v->n, v->n);
		bad = is_coarse && settle_runs(order, v->n, v->depth, e);
#pragma omp parallel for schedule(static)
		for (size_t i = 0; i < v->n; i++)
			sorted[i] = v->projected[order[i].place];
	}
	free(items);
	if (bad)
		free(sorted);
	else
		*out = sorted;
	return bad ? -1 : 0;
}

int project_splats(const struct splats *s, const struct camera *c, enum cpu_level level,
	struct projected **out, size_t *count, struct err *e)
{
	const struct kernels *kernels = kernels_of(level);
	struct visible v = {.blocks = s->n / BLOCK + (s->n % BLOCK != 0)};
	struct project_lens lens;
	int bad = -1;

	if (s->n > INT32_MAX)
		return err_set(e, ERR_FORMAT, "%zu Gaussians are more than the %d that can be indexed", s->n,
			INT32_MAX);
	v.projected = mem_alloc(s->n, sizeof *v.projected, "projected Gaussians", e);
	v.depth = mem_alloc(s->n, sizeof *v.depth, "projected Gaussians", e);
	v.found = mem_alloc(v.blocks, sizeof *v.found, "projected Gaussians", e);
	if (v.projected && v.depth && v.found) {
		lens_make(&lens, c);
#pragma omp parallel for schedule(dynamic)
		for (size_t b = 0; b < v.blocks; b++) {
			size_t begin = b * BLOCK, end = begin + BLOCK < s->n ? begin + BLOCK : s->n;
			v.found[b] = project_block(
				kernels, &lens, s, c, begin, end, v.projected + begin, v.depth + begin);
		}
		for (size_t b = 0; b < v.blocks; b++)
			v.n += v.found[b];
		*count = v.n;
		bad = sort_by_depth(&v, out, e);
	}
	free(v.projected);
	free(v.depth);
	free(v.found);
	return bad;
}
