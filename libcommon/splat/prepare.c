#include "base/mem.h"
#include "base/threads.h"
#include "splat/kernels.h"
#include "splat/render.h"
#include "splat/view.h"

#include <omp.h>

static size_t count_blocks(size_t gaussians)
{
	return gaussians / TILE_BLOCK + (gaussians % TILE_BLOCK != 0);
}

static void free_spans(struct render_view *v)
{
	for (size_t b = 0; b < v->block_room; b++)
		free(v->spans[b].items);
	free(v->spans);
	v->spans = NULL;
	v->block_room = 0;
}

/* Room for so many Gaussians. */
static int make_room(struct render_view *v, size_t gaussians, struct err *e)
{
	const size_t blocks = count_blocks(gaussians);

	if (v->projected && gaussians <= v->gaussian_room)
		return 0;
	mem_free_all(v->projected, v->order, v->covers, v->found);
	free_spans(v);
	v->gaussian_room = gaussians;
	v->projected = mem_alloc(gaussians, sizeof *v->projected, "projected Gaussians", e);
	v->order = mem_alloc(gaussians, 2 * sizeof *v->order, "depth order", e);
	v->covers = mem_alloc(gaussians, sizeof *v->covers, "tile lists", e);
	v->found = mem_alloc(blocks, sizeof *v->found, "depth order", e);
	v->spans = mem_zalloc(blocks, sizeof *v->spans, "tile spans", e);
	v->block_room = v->spans ? blocks : 0;
	if (v->projected && v->order && v->covers && v->found && v->spans)
		return 0;
	v->gaussian_room = 0; /* so that what is missing is asked for again */
	return -1;
}

/* Projects a block's Gaussians; those that are visible get their place in `projected`, their tiles, and,
 * from the block's place in `items` on, their key. */
static int project_block(struct render_view *v, const struct splats *s, const struct project_lens *lens,
	size_t block, struct order_item *items, uint32_t *tally, struct err *e)
{
	const struct kernels *kernels = kernels_of(v->level);
	const size_t begin = block * TILE_BLOCK, end = begin + TILE_BLOCK < s->n ? begin + TILE_BLOCK : s->n;
	struct project_batch b __attribute__((aligned(64))) = {0};
	size_t found = 0, number[PROJECT_LANES];

	v->spans[block].n = 0;
	for (size_t i = begin; i < end;) {
		int lanes = 0;
		/* lanes left over compute what is not looked at */
		for (; i < end && lanes < PROJECT_LANES; i++)
			if ((v->wanted.is_all || wanted_reach(&v->wanted, &v->grid, s, lens, i)) &&
				project_take(&b, s, i, lanes))
				number[lanes++] = i;
		kernels->project(lens, &b, lanes);
		for (int l = 0; l < lanes; l++) {
			if (!b.seen[l] || !wanted_lane(&v->wanted, &v->grid, &b, l))
				continue;
			v->projected[number[l]] = (struct projected){b.x[l], b.y[l], b.l11[l], b.l21[l],
				b.l22[l], b.z[l], {(float)b.l11[l], (float)b.l21[l], (float)b.l22[l]},
				(float)b.log_opacity[l]};
			if (tile_cover(&v->grid, &b, l, &v->covers[number[l]], &v->spans[block], tally, e))
				return -1;
			items[begin + found++] = (struct order_item){order_key(b.z[l]), (uint32_t)number[l]};
		}
	}
	v->found[block] = found;
	return 0;
}

/* All blocks; items (N) gets the keys of the visible ones, block by block. */
static int project_all(struct render_view *v, const struct splats *s, const struct project_lens *lens,
	struct order_item *items, int threads, struct err *e)
{
	const size_t blocks = count_blocks(s->n), tallies = tile_tallies(&v->grid);
	int failed = 0;

	memset(v->tallies, 0, (size_t)threads * tallies * sizeof *v->tallies);
#pragma omp parallel for schedule(dynamic) num_threads(threads) reduction(| : failed)
	for (size_t b = 0; b < blocks; b++) {
		struct err mine;
		if (!failed && project_block(v, s, lens, b, items,
				       v->tallies + (size_t)omp_get_thread_num() * tallies, &mine)) {
			failed = 1;
#pragma omp critical
			*e = mine;
		}
	}
	return failed ? -1 : 0;
}

/* Puts the blocks' items side by side. */
static void gather_items(struct render_view *v, const struct order_item *from, struct order_item *to)
{
	v->visible = 0;
	for (size_t b = 0; b < count_blocks(v->gaussians); b++) {
		memcpy(to + v->visible, from + b * TILE_BLOCK, v->found[b] * sizeof *to);
		v->visible += v->found[b];
	}
}

size_t render_bytes(size_t gaussians)
{
	return gaussians * (sizeof(struct projected) + 2 * sizeof(struct order_item) + sizeof(uint32_t));
}

int render_again_where(struct render_view *v, const struct splats *s, const struct camera *c,
	const uint8_t *is_wanted, struct err *e)
{
	const int threads = threads_available();
	struct project_lens lens;
	size_t tallies;

	if (s->n > INT32_MAX)
		return err_set(e, ERR_FORMAT, "%zu Gaussians are more than the %d that can be indexed", s->n,
			INT32_MAX);
	v->grid = tile_grid(c->width, c->height);
	v->gaussians = s->n;
	v->visible = 0;
	if (mem_size(tile_tallies(&v->grid), (size_t)threads, &tallies))
		return err_set(e, ERR_SYSTEM, "tile lists: %d threads are too many", threads);
	if (make_room(v, s->n, e) ||
		mem_room((void **)&v->tallies, &v->tally_room, tallies, sizeof *v->tallies, "tile lists", e))
		return -1;
	struct order_item *items = v->order, *spare = v->order + s->n;
	project_lens_make(&lens, c, s->near);
	if (wanted_find(&v->wanted, &v->grid, s, &lens, kernels_of(v->level), is_wanted, e) ||
		project_all(v, s, &lens, spare, threads, e))
		return -1;
	gather_items(v, spare, items);
	v->sorted = order_sort(items, spare, v->visible, v->projected, e);
	if (!v->sorted)
		return -1;
	return tile_bin(
		&v->tiles, &v->grid, v->sorted, v->visible, v->covers, v->spans, v->tallies, threads, e);
}

int render_again(struct render_view *v, const struct splats *s, const struct camera *c, struct err *e)
{
	return render_again_where(v, s, c, NULL, e);
}

struct render_view *render_prepare_where(
	const struct splats *s, const struct camera *c, const uint8_t *is_wanted, struct err *e)
{
	struct render_view *v = mem_zalloc(1, sizeof *v, "view", e);

	if (!v)
		return NULL;
	v->level = cpu_level();
	if (!render_again_where(v, s, c, is_wanted, e))
		return v;
	render_free(v);
	return NULL;
}

struct render_view *render_prepare(const struct splats *s, const struct camera *c, struct err *e)
{
	return render_prepare_where(s, c, NULL, e);
}

void render_release(struct render_view **v)
{
	render_free(*v);
}

void render_free(struct render_view *v)
{
	if (!v)
		return;
	tile_free(&v->tiles);
	wanted_free(&v->wanted);
	mem_free_all(v->projected, v->order, v->covers, v->found);
	free_spans(v);
	mem_free_all(v->tallies, v);
}
