/* bench_pick SCENE WEIGHTS REGIONS TRUTH: how well a click means the thing that was meant, by simulated
 * clicks in each true mask: at its deepest point, then twice at the deepest point of what is wrong, with and
 * without a look at larger and smaller regions after each; and by the box around it. The best of larger and
 * smaller regions is chosen by the mask in the clicked view. Each answer is scored in all labelled views that
 * have weights: mIoU, and the shares of clicks with 0.5 and 0.75.
 */
#include "base/mem.h"
#include "formats/records/masks.h"
#include "formats/scene/proposed.h"
#include "formats/scene/weights.h"
#include "propose/region_pick.h"
#include "splat/weights_pack.h"

#include <math.h>
#include <stdio.h>

enum { CLICKS = 3, LARGEST = 12, MOST_TRUTH = 1000 };

struct labelled {
	size_t view;
	int height, width;
	int32_t *nodes;
	uint8_t *mask;
};

static struct regions_file regions;
static struct scene scene;
static struct masks truth;
static struct labelled of[MOST_TRUTH];
static uint8_t *is_in;
static float *area_shown;

static void stop(const struct err *e)
{
	fprintf(stderr, "bench_pick: %s\n", e->message);
	exit(1);
}

static double iou(const struct labelled *l)
{
	size_t both = 0, either = 0;

	for (int p = 0; p < l->height * l->width; p++) {
		const int on = l->nodes[p] >= 0 && is_in[l->nodes[p]];
		both += (size_t)(on && l->mask[p]);
		either += (size_t)(on || l->mask[p]);
	}
	return either ? (double)both / (double)either : 0;
}

/* Over the views of the thing of truth k. */
static double iou_all(size_t k)
{
	double sum = 0;
	int n = 0;

	for (size_t m = 0; m < truth.n; m++)
		if (of[m].nodes && !strcmp(mask_object(&truth.items[m]), mask_object(&truth.items[k]))) {
			sum += iou(&of[m]);
			n++;
		}
	return sum / n;
}

/* The deepest pixel of those where what is there and what should be are so, by city blocks; *area their
 * number. */
static int deepest(const struct labelled *l, int is_true, int is_there, int *area)
{
	const int w = l->width, h = l->height;
	int *depth = calloc((size_t)(w * h), sizeof *depth), best = 0;

	*area = 0;
	for (int pass = 0; pass < 2; pass++)
		for (int i = 0; i < w * h; i++) {
			const int p = pass ? w * h - 1 - i : i, step = pass ? 1 : -1, x = p % w, y = p / w;
			const int on = l->mask[p] == is_true &&
				       (is_there < 0 || (l->nodes[p] >= 0 && is_in[l->nodes[p]]) == is_there);
			const int is_edge = pass ? x == w - 1 || y == h - 1 : !x || !y;
			const int a = is_edge ? 0 : depth[p + step], b = is_edge ? 0 : depth[p + step * w];
			const int now = on ? 1 + (a < b ? a : b) : 0;
			depth[p] = pass && depth[p] < now ? depth[p] : now;
			*area += pass && on;
			best = pass && depth[p] > depth[best] ? p : best;
		}
	free(depth);
	return best;
}

/* The clicks' best size, by the clicked view; is_in is left so. */
static void choose_size(const struct region_click *clicks, size_t n, const struct labelled *l)
{
	double most = -1;
	int best = 0;

	for (int larger = -LARGEST; larger <= LARGEST; larger++) {
		region_pick(&regions.tree, regions.score, area_shown, clicks, n, larger, is_in);
		const double now = iou(l);
		if (now > most || (now == most && abs(larger) < abs(best))) {
			most = now;
			best = larger;
		}
	}
	region_pick(&regions.tree, regions.score, area_shown, clicks, n, best, is_in);
}

static void read_truth(const char *weights, const char *path)
{
	struct err e;
	static struct weights_room room;

	if (masks_read(&truth, path, &e) || truth.n > MOST_TRUTH)
		stop(&e);
	for (size_t k = 0; k < truth.n; k++) {
		size_t v = 0;
		struct weights w = {0};
		while (v < scene.cameras.n && strcmp(scene.cameras.views[v].name, truth.items[k].view) != 0)
			v++;
		if (v == scene.cameras.n || weights_open_in(&w, &room, WEIGHTS_ROWS, weights, &scene, v, &e))
			continue;
		struct labelled *l = &of[k];
		const struct view_weights rows = weights_view(&w);
		*l = (struct labelled){v, w.height, w.width, NULL, malloc(rows.pixels)};
		for (size_t m = 0; m < k; m++)
			l->nodes = of[m].nodes && of[m].view == v ? of[m].nodes : l->nodes;
		if (!l->nodes) {
			l->nodes = malloc(rows.pixels * sizeof *l->nodes);
			if (region_tree_pixels(&regions.tree, &rows, l->nodes, &e))
				stop(&e);
		}
		if (rle_decode_at(&truth.items[k].rle, l->height, l->width, l->mask, &e))
			stop(&e);
		weights_close(&w);
	}
}

struct tally {
	const char *name;
	double sum;
	int n, half, most;
};

static void count(struct tally *t, double x)
{
	t->sum += x;
	t->n++;
	t->half += x >= 0.5;
	t->most += x >= 0.75;
}

/* One click and three, the size of each chosen by the clicked view or left as it is. */
static void click_all(size_t k, int has_size, struct tally *tallies)
{
	const struct labelled *l = &of[k];
	struct region_click clicks[CLICKS];
	int area, more;

	region_tree_areas(&regions.tree, l->nodes, (size_t)l->height * (size_t)l->width, area_shown);
	for (size_t n = 0; n < CLICKS; n++) {
		int at = deepest(l, 1, n ? 0 : -1, &area);
		const int wrong = n ? deepest(l, 0, 1, &more) : 0;
		const int is_outside = n && more > area;
		at = is_outside ? wrong : at;
		clicks[n] = (struct region_click){l->nodes[at], is_outside};
		if (has_size)
			choose_size(clicks, n + 1, l);
		else
			region_pick(&regions.tree, regions.score, area_shown, clicks, n + 1, 0, is_in);
		if (!n || n + 1 == CLICKS)
			count(&tallies[n ? 2 : 0], iou_all(k));
	}
}

static void box(size_t k, struct tally *tally)
{
	const struct labelled *l = &of[k];
	double b[4] = {1e9, 1e9, 0, 0};
	struct err e;
	struct region_shown *shown = calloc((size_t)regions.tree.n, sizeof *shown);

	for (int p = 0; p < l->height * l->width; p++)
		if (l->mask[p]) {
			b[0] = fmin(b[0], p % l->width);
			b[1] = fmin(b[1], p / l->width);
			b[2] = fmax(b[2], p % l->width + 1);
			b[3] = fmax(b[3], p / l->width + 1);
		}
	if (region_tree_measure(&regions.tree, l->nodes, l->height, l->width, shown, &e))
		stop(&e);
	const int32_t node = region_pick_box(&regions.tree, shown, b);
	memset(is_in, 0, (size_t)regions.tree.n);
	for (int32_t i = node; node >= 0 && i < regions.tree.end[node]; i++)
		is_in[i] = 1;
	count(tally, iou_all(k));
	free(shown);
}

int main(int argc, char **argv)
{
	struct tally t[] = {{.name = "one click"}, {.name = "one click, best size"}, {.name = "three clicks"},
		{.name = "three clicks, best size"}, {.name = "a box"}};
	struct err e;

	if (argc != 5)
		return 2;
	if (scene_read(&scene, argv[1], &e) || regions_file_read(&regions, argv[3], &e))
		stop(&e);
	is_in = calloc((size_t)regions.tree.n, 1);
	area_shown = calloc((size_t)regions.tree.n, sizeof *area_shown);
	read_truth(argv[2], argv[4]);
	for (size_t k = 0; k < truth.n; k++)
		if (of[k].nodes && rle_area(&truth.items[k].rle)) {
			click_all(k, 0, t);
			click_all(k, 1, t + 1);
			box(k, &t[4]);
		}
	for (int k = 0; k < 5; k++)
		printf("%-24s mIoU %.1f  P@50 %.1f  P@75 %.1f  of %d\n", t[k].name, 100 * t[k].sum / t[k].n,
			100.0 * t[k].half / t[k].n, 100.0 * t[k].most / t[k].n, t[k].n);
	return 0;
}
