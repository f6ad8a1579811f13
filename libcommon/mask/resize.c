#include "mask/rle.h"

#include "base/mem.h"

/* A mask's foreground as position ranges [begin,end), with the first range that reaches into each column. */
struct ranges {
	size_t n;
	uint32_t (*items)[2];
	size_t *first; /* (width) */
};

static void ranges_free(struct ranges *g)
{
	mem_free_all(g->items, g->first);
}

static int ranges_make(struct ranges *g, const struct rle *r, struct err *e)
{
	uint32_t at = 0;

	*g = (struct ranges){0};
	g->items = mem_alloc(r->n / 2, sizeof *g->items, "mask", e);
	g->first = mem_alloc((size_t)r->width, sizeof *g->first, "mask", e);
	if (!g->items || !g->first)
		return -1;
	for (size_t i = 0; i < r->n; i++) {
		if (i % 2) {
			g->items[g->n][0] = at;
			g->items[g->n++][1] = at + r->runs[i];
		}
		at += r->runs[i];
	}
	size_t k = 0;
	for (int c = 0; c < r->width; c++) {
		while (k < g->n && g->items[k][1] <= (uint64_t)c * (uint64_t)r->height)
			k++;
		g->first[c] = k;
	}
	return 0;
}

static uint64_t least(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

static uint64_t most(uint64_t a, uint64_t b)
{
	return a > b ? a : b;
}

/* Adds `weight` times the foreground of source column c (of height H) to the h new pixels of a column, in
 * units of 1/h of a source pixel: source row y covers [y*h,(y+1)*h), new row i covers [i*H,(i+1)*H). */
static void add_column(
	uint64_t *sums, uint64_t h, const struct ranges *g, uint64_t column, uint64_t H, uint64_t weight)
{
	uint64_t top = column * H;

	for (size_t k = g->first[column]; k < g->n && g->items[k][0] < top + H; k++) {
		uint64_t begin = (most(g->items[k][0], top) - top) * h;
		uint64_t end = (least(g->items[k][1], top + H) - top) * h;
		for (uint64_t i = begin / H; i * H < end; i++)
			sums[i] += weight * (least((i + 1) * H, end) - most(i * H, begin));
	}
}

/* Data sets have pictures whose sides were resized by factors that differ by 0.4%: 1296x968 and 640x480. No
 * pixel is more than half of this share of a side from its place even where one was cut instead. */
enum { STRETCHED = 200 };

int rle_has_shape(int64_t h, int64_t w, int64_t height, int64_t width)
{
	const int64_t off = llabs(h * width - w * height), small = h + w, large = height + width;

	return (off <= (small > large ? small : large) || off * STRETCHED <= h * width) &&
	       (h != width || w != height || h == w);
}

int rle_check_shape(const char *what, int64_t h, int64_t w, const char *name, int64_t height, int64_t width,
	struct err *e)
{
	if (rle_has_shape(h, w, height, width))
		return 0;
	return err_set(e, ERR_FORMAT, "%s of %lldx%lld, but %s is %lldx%lld (width x height)%s", what,
		(long long)w, (long long)h, name, (long long)width, (long long)height,
		rle_has_shape(w, h, height, width) ? ": is the photograph turned by EXIF?"
						   : ": the shapes differ, and nothing is stretched");
}

/* New columns are made one after another, which is the order of the runs: no image is ever held. */
int rle_resize(struct rle *to, const struct rle *from, int height, int width, struct err *e)
{
	uint64_t H = (uint64_t)from->height, W = (uint64_t)from->width, h = (uint64_t)height,
		 w = (uint64_t)width;
	SCOPED_BY(ranges_free) struct ranges g = {0};
	SCOPED void *runs = NULL;
	size_t n = 0, capacity = 0;
	uint32_t length = 0;
	int state = 0;

	*to = (struct rle){0};
	if (rle_check_size(height, width, e))
		return -1;
	if (height == from->height && width == from->width)
		return rle_from_runs(to, from->runs, from->n, height, width, e);
	if (ranges_make(&g, from, e))
		return -1;
	SCOPED uint64_t *sums = mem_alloc((size_t)h, sizeof *sums, "mask", e);
	if (!sums)
		return -1;
	for (uint64_t j = 0; j < w; j++) {
		memset(sums, 0, (size_t)h * sizeof *sums);
		for (uint64_t c = j * W / w; c * w < (j + 1) * W; c++)
			add_column(sums, h, &g, c, H, least((c + 1) * w, (j + 1) * W) - most(c * w, j * W));
		if (mem_grow(&runs, &capacity, n + (size_t)h + 1, sizeof(uint32_t), "mask", e))
			return -1;
		for (uint64_t i = 0; i < h; i++) {
			/* a whole new pixel is H*W units */
			int is_set = 2 * sums[i] >= H * W;
			if (is_set != state) {
				((uint32_t *)runs)[n++] = length;
				length = 0;
				state = is_set;
			}
			length++;
		}
	}
	((uint32_t *)runs)[n++] = length;
	return rle_from_runs(to, runs, n, height, width, e);
}
