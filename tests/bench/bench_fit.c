/* The speed of a step of gs-train, as JSON Lines.
 *
 *	bench_fit [-n GAUSSIANS,...] [-s WxH,...] [-r REPEATS] [SPLATS CAMERAS]
 *
 * SPLATS is a scene in any form, and CAMERAS a COLMAP model or camera file, of which the first view is taken;
 *without them scenes of -n Gaussians (default 20000,100000,500000) are made as gs-synth makes them. For each
 *scene and size (default 400x266,986x728) a line with the processors' time in ms, the least of the repeats,
 *of each part of a step: projection and order, colours, blending, the image's loss, blending backwards, the
 *rest backwards, Adam, and noise. "lanes" are the places of blocks that Gaussians are evaluated at, and
 *"blend_share" and "back_share" are their arithmetic as a share of what the processor can do in that time. */
#include "base/mem.h"
#include "fit/fit.h"
#include "fit/grow.h"
#include "fit/project_back.h"
#include "formats/splats/anysplats.h"
#include "formats/cameras/camerafile.h"
#include "nn/adam.h"
#include "peak.h"
#include "splat/blend_kernel.h"
#include "splat/place.h"
#include "splat/view.h"
#include "synth/synth_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A multiply or an add is one, both together two: blend_part() and its three channels, and back_part(). */
enum { BLEND_FLOPS = 29, BACK_FLOPS = 64 };

enum { PREPARE, COLORS, BLEND, LOSS, BACK, PROJECT, ADAM, NOISE, PARTS };
static const char *const names[PARTS] = {
	"prepare", "colors", "blend", "loss", "back", "project_back", "adam", "noise"};

static _Noreturn void fail(const char *message)
{
	fprintf(stderr, "bench_fit: %s\n", message);
	exit(4);
}

static void *need(size_t n, size_t size)
{
	struct err e;
	void *p = mem_zalloc(n, size, "benchmark", &e);

	if (!p)
		fail(e.message);
	return p;
}

/* ms since the last call */
static double lap(void)
{
	static double last;
	struct timespec t;

	clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
	const double now = 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec, passed = now - last;
	last = now;
	return passed;
}

/* Places of blocks that one pass over the view evaluates. */
static double count_lanes(const struct render_view *v)
{
	const size_t tiles = (size_t)v->grid.columns * (size_t)v->grid.rows;
	size_t visits = 0;

	for (size_t tile = 0; tile < tiles; tile++) {
		const struct place at = place_of_tile(&v->grid, tile);
		const uint32_t *list = v->tiles.entries + v->tiles.start[tile];
		const size_t n = v->tiles.start[tile + 1] - v->tiles.start[tile];
		struct blend_tile t __attribute__((aligned(64)));
		struct blend_chunk chunk;
		blend_start(&t, at.x, at.y, at.columns, at.rows, 0);
		for (size_t k = 0; k < n && t.live; k += BLEND_CHUNK) {
			blend_chunk_make(&chunk, &t, v->projected, list + k, blend_chunk_size(n - k));
			for (uint32_t live = t.live; live; live &= live - 1) {
				const int block = __builtin_ctz(live);
				const uint64_t column = blend_column(&chunk, block);
				visits += (size_t)__builtin_popcountll(column);
				if (column)
					blend_block_counts(&t, &chunk, column, block);
			}
		}
	}
	return (double)visits * BLEND_LANES;
}

static void print_line(
	size_t n, const struct render_view *v, const struct camera *c, const double times[PARTS])
{
	const double lanes = count_lanes(v), flops = 2 * measure_peak();
	double sum = 0;

	printf("{\"bench\":\"fit\",\"gaussians\":%zu,\"visible\":%zu,\"width\":%d,\"height\":%d,\"pairs\":%zu",
		n, v->visible, c->width, c->height,
		v->tiles.start[(size_t)v->grid.columns * (size_t)v->grid.rows]);
	for (int k = 0; k < PARTS; k++) {
		printf(",\"%s_ms\":%.2f", names[k], times[k]);
		sum += times[k];
	}
	printf(",\"step_ms\":%.2f,\"lanes\":%.0f,\"blend_share\":%.3f,\"back_share\":%.3f}\n", sum, lanes,
		BLEND_FLOPS * lanes / flops / (1e-3 * times[BLEND]),
		BACK_FLOPS * lanes / flops / (1e-3 * times[BACK]));
	fflush(stdout);
}

static void measure(const struct splats *s, const struct camera *c, int repeats)
{
	const size_t pixels = (size_t)c->width * (size_t)c->height;
	float *image = need(6 * pixels, sizeof *image), *colors = need(s->n, 3 * sizeof *colors),
	      *sums = need(s->n, BACK_SUMS * sizeof *sums);
	uint8_t *photograph = need(pixels, 3), *seen = need(s->n, 1);
	struct fit_gaussians g;
	struct photo_loss_room loss_room = {0};
	struct back_room back_room = {0};
	struct photo_loss loss;
	double least[PARTS];
	struct err e;

	if (fit_gaussians_alloc(&g, s->n, 3, &e))
		fail(e.message);
	fit_gaussians_take(&g, s);
	fit_gaussians_activate(&g);
	struct render_view *v = render_prepare(&g.splats, c, &e);
	for (int r = 0; v && r < repeats; r++) {
		double times[PARTS];
		lap();
		int bad = render_again(v, &g.splats, c, &e);
		times[PREPARE] = lap();
		fit_seen(v, seen);
		fit_colors(&g, seen, c, 3, colors);
		times[COLORS] = lap();
		render_packed(v, colors, 3, image, NULL);
		times[BLEND] = lap();
		bad = bad || photo_loss(&loss, image, photograph, c->height, c->width, image + 3 * pixels,
				     &loss_room, &e);
		times[LOSS] = lap();
		bad = bad || back_view(v, colors, image, image + 3 * pixels, sums, &back_room, &e);
		times[BACK] = lap();
		fit_project_back(&g, v, seen, c, 3, colors, sums);
		times[PROJECT] = lap();
		for (int p = 0; p < FIT_PARTS; p++)
			adam_step(g.at[FIT_VALUE][p], g.at[FIT_GRADIENT][p], g.at[FIT_MOMENT1][p],
				g.at[FIT_MOMENT2][p], g.n * fit_width[p], 1e-9, 0.9, 0.999, 1e-15, r + 1);
		times[ADAM] = lap();
		grow_noise(&g, 1e-12, FIT_SIZE, 1, r);
		times[NOISE] = lap();
		if (bad)
			fail(e.message);
		for (int k = 0; k < PARTS; k++)
			least[k] = r && least[k] < times[k] ? least[k] : times[k];
	}
	if (!v)
		fail(e.message);
	print_line(s->n, v, c, least);
	render_free(v);
	back_free(&back_room);
	photo_loss_free(&loss_room);
	fit_gaussians_free(&g);
	free(image);
	free(colors);
	free(sums);
	free(photograph);
	free(seen);
}

static void measure_sizes(const struct splats *s, const struct camera *view, const char *sizes, int repeats)
{
	for (const char *at = sizes; at; at = strchr(at, ',')) {
		int width, height;
		at += *at == ',';
		if (sscanf(at, "%dx%d", &width, &height) != 2 || width < 1 || height < 1)
			fail("-s: not WIDTHxHEIGHT,...");
		const struct camera c = camera_resize(view, width, height);
		measure(s, &c, repeats);
	}
}

static void measure_file(const char *splats, const char *cameras, const char *sizes, int repeats)
{
	struct splats s;
	struct cameras c;
	double offset[3];
	struct err e;

	if (anysplats_read(&s, offset, NULL, splats, &e) || camerafile_read(&c, cameras, &e))
		fail(e.message);
	cameras_shift(&c, offset);
	measure_sizes(&s, &c.views[0], sizes, repeats);
	splats_free(&s);
	cameras_free(&c);
}

static void measure_made(const char *gaussians, const char *sizes, int repeats)
{
	for (const char *at = gaussians; at; at = strchr(at, ',')) {
		struct synth_options o = {.preset = synth_preset(0),
			.objects = 8,
			.views = SYNTH_MIN_VIEWS,
			.width = 986,
			.height = 728};
		struct synth_scene scene;
		struct err e;
		int attempt = 0;
		at += *at == ',';
		o.gaussians = strtoul(at, NULL, 10);
		do
			o.seed = synth_preset_seed(0, 1, attempt);
		while (synth_scene_make(&scene, &o, &e) && ++attempt < 20);
		if (attempt == 20)
			fail(e.message);
		measure_sizes(&scene.splats, &scene.cameras.views[0], sizes, repeats);
		synth_scene_free(&scene);
	}
}

int main(int argc, char **argv)
{
	const char *gaussians = "20000,100000,500000", *sizes = "400x266,986x728";
	int repeats = 7;

	for (int c; (c = getopt(argc, argv, "n:s:r:")) != -1;)
		if (c == 'n')
			gaussians = optarg;
		else if (c == 's')
			sizes = optarg;
		else if (c == 'r')
			repeats = atoi(optarg);
		else
			return 2;
	if (argc == optind + 2)
		measure_file(argv[optind], argv[optind + 1], sizes, repeats);
	else
		measure_made(gaussians, sizes, repeats);
	return 0;
}
