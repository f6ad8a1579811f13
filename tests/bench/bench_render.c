/* The speed of the rasteriser, as JSON Lines.
 *
 *	bench_render [-n GAUSSIANS,...] [-s WxH,...] [-r REPEATS] [-l PART] [SCENE VIEW]
 *
 * SCENE is a folder of gs-import and VIEW a view of it; without them scenes of -n Gaussians (default
 * 100000,500000) are made as gs-synth makes them. Sizes default to 493x364,986x728, and to the view's own.
 * For each scene, size, number of threads (1, 2, 4 ... and all) and of channels (1, 4, 16) a line:
 *
 *	{"bench":"render","mode":"within","gaussians":N,"width":W,"height":H,"threads":T,"channels":C,
 *	 "prepare_ms":...,"blend_ms":...,"frame_ms":...,"fps":...,"prepare_median_ms":...,
 *	 "blend_median_ms":...,"frame_median_ms":...,"cpu_ms":...,"pairs":...,"part":...}
 *
 * Mode "within": all threads share a frame. "beside" (more than one thread): each has frames of its own;
 * prepare_ms and blend_ms are then the threads' mean divided by their number, and frame_ms is the wall time
 * over the frames of all. fps = 1000 / frame_ms. Times are the least and the median of the repeats, in the
 * process's own time where one thread runs, so that a busy machine disturbs them little. cpu_ms is what all
 * processors together spend on a frame, at least: divided by the threads, what a free machine would take at
 * best. pairs counts Gaussians in tiles. Values are in memory as refer-render has them. With -l only those
 * tiles are rendered where a part of the Gaussians may show, as for an object of a lifted model: those
 *nearest to one of them. */
#include "base/mem.h"
#include "formats/scene/scene.h"
#include "splat/render.h"
#include "splat/view.h"
#include "synth/synth_scene.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { MOST_REPEATS = 1000, BESIDE_FRAMES = 3, MOST_CHANNELS = 16, MOST_ATTEMPTS = 20 };

struct options {
	const char *gaussians, *sizes;
	int repeats;
	double part;
};

/* One repeat's times in ms: prepare, blend, both, and the processors' for both. */
enum { PREPARE, BLEND, FRAME, CPU, TIMES };

struct job {
	const struct splats *splats;
	struct camera camera;
	int threads, channels, repeats;
	const float *values; /* (N,channels) */
	double part;
	const uint8_t *is_wanted; /* (N), or NULL */
	size_t pairs;
};

static _Noreturn void fail(const char *message)
{
	fprintf(stderr, "bench_render: %s\n", message);
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

static double now(clockid_t clock)
{
	struct timespec t;

	clock_gettime(clock, &t);
	return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

/* What a thread, or all of them, use from frame to frame. */
struct room {
	struct render_view *view;
	float *image;
};

static struct room make_room(const struct job *j)
{
	struct err e;
	struct room room = {render_prepare_where(j->splats, &j->camera, j->is_wanted, &e),
		need((size_t)j->camera.width * (size_t)j->camera.height,
			(size_t)j->channels * sizeof(float))};

	if (!room.view)
		fail(e.message);
	return room;
}

static void free_room(struct room *room)
{
	render_free(room->view);
	free(room->image);
}

static void render_frame(const struct job *j, struct room *room, clockid_t clock, double times[TIMES])
{
	struct err e;
	const double start = now(clock);

	if (render_again_where(room->view, j->splats, &j->camera, j->is_wanted, &e))
		fail(e.message);
	const double middle = now(clock);
	render_packed(room->view, j->values, j->channels, room->image, NULL);
	const double end = now(clock);
	times[PREPARE] += middle - start;
	times[BLEND] += end - middle;
	times[FRAME] += end - start;
}

static void measure_within(struct job *j, double (*times)[TIMES])
{
	const clockid_t clock = j->threads == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC;
	struct room room = make_room(j);
	double unused[TIMES] = {0};

	j->pairs = room.view->tiles.start[(size_t)room.view->grid.columns * (size_t)room.view->grid.rows];
	render_frame(j, &room, clock, unused);
	for (int i = 0; i < j->repeats; i++) {
		const double start = now(CLOCK_PROCESS_CPUTIME_ID);
		render_frame(j, &room, clock, times[i]);
		times[i][CPU] = now(CLOCK_PROCESS_CPUTIME_ID) - start;
	}
	free_room(&room);
}

static void measure_beside(const struct job *j, double (*times)[TIMES])
{
	struct room *rooms = need((size_t)j->threads, sizeof *rooms);
	double(*own)[TIMES] = need((size_t)j->threads, sizeof *own);

#pragma omp parallel num_threads(j->threads)
	{
		struct room *room = &rooms[omp_get_thread_num()];
		double *mine = own[omp_get_thread_num()];
		*room = make_room(j);
		render_frame(j, room, CLOCK_MONOTONIC, mine);
		for (int i = 0; i < j->repeats; i++) {
			memset(mine, 0, sizeof *own);
#pragma omp barrier
			const double start = now(CLOCK_MONOTONIC), cpu_start = now(CLOCK_PROCESS_CPUTIME_ID);
			for (int k = 0; k < BESIDE_FRAMES; k++)
				render_frame(j, room, CLOCK_MONOTONIC, mine);
#pragma omp barrier
#pragma omp single
			{
				const double frames = BESIDE_FRAMES * (double)j->threads;
				times[i][FRAME] = (now(CLOCK_MONOTONIC) - start) / frames;
				times[i][CPU] = (now(CLOCK_PROCESS_CPUTIME_ID) - cpu_start) / frames;
				for (int t = 0; t < j->threads; t++)
					for (int k = 0; k < FRAME; k++)
						times[i][k] += own[t][k] / frames / j->threads;
			}
		}
		free_room(room);
	}
	free(rooms);
	free(own);
}

static int by_value(const void *a, const void *b)
{
	double x = *(const double *)a, y = *(const double *)b;

	return (x > y) - (x < y);
}

static void print_line(const struct job *j, const char *mode, double (*times)[TIMES])
{
	double *sorted = need((size_t)j->repeats, sizeof *sorted), least[TIMES], median[TIMES];

	for (int k = 0; k < TIMES; k++) {
		for (int i = 0; i < j->repeats; i++)
			sorted[i] = times[i][k];
		qsort(sorted, (size_t)j->repeats, sizeof *sorted, by_value);
		least[k] = sorted[0];
		median[k] = sorted[j->repeats / 2];
	}
	free(sorted);
	printf("{\"bench\":\"render\",\"mode\":\"%s\",\"gaussians\":%zu,\"width\":%d,\"height\":%d,\"threads\":%d,"
	       "\"channels\":%d,\"prepare_ms\":%.3f,\"blend_ms\":%.3f,\"frame_ms\":%.3f,\"fps\":%.2f,"
	       "\"prepare_median_ms\":%.3f,\"blend_median_ms\":%.3f,\"frame_median_ms\":%.3f,\"cpu_ms\":%.3f,\"pairs\":%zu,\"part\":%g}\n",
		mode, j->splats->n, j->camera.width, j->camera.height, j->threads, j->channels,
		least[PREPARE], least[BLEND], least[FRAME], 1e3 / least[FRAME], median[PREPARE],
		median[BLEND], median[FRAME], least[CPU], j->pairs, j->part);
	fflush(stdout);
}

static void measure(struct job *j)
{
	const int most = omp_get_max_threads();
	double(*times)[TIMES];

	for (int threads = 1;; threads = threads * 2 < most ? threads * 2 : most) {
		omp_set_num_threads(threads);
		j->threads = threads;
		times = need((size_t)j->repeats, sizeof *times);
		measure_within(j, times);
		print_line(j, "within", times);
		memset(times, 0, (size_t)j->repeats * sizeof *times);
		if (threads > 1) {
			measure_beside(j, times);
			print_line(j, "beside", times);
		}
		free(times);
		if (threads == most)
			break;
	}
	omp_set_num_threads(most);
}

/* The part of the Gaussians that are nearest to the first of high opacity: to be freed, NULL for all. */
static uint8_t *nearest(const struct splats *s, double part)
{
	uint8_t *is_near = need(s->n, 1);
	double *squares = need(s->n, sizeof *squares), *sorted = need(s->n, sizeof *sorted);
	size_t first = 0;

	while (first + 1 < s->n && s->opacities[first] < 0.9F)
		first++;
	for (size_t i = 0; i < s->n; i++)
		for (size_t k = 0; k < 3; k++) {
			const double d = (double)s->means[3 * i + k] - (double)s->means[3 * first + k];
			squares[i] += d * d;
		}
	memcpy(sorted, squares, s->n * sizeof *sorted);
	qsort(sorted, s->n, sizeof *sorted, by_value);
	for (size_t i = 0; i < s->n; i++)
		is_near[i] = squares[i] <= sorted[(size_t)(part * (double)(s->n - 1))];
	free(squares);
	free(sorted);
	return is_near;
}

/* Sizes of the list, or the view's own. */
static void measure_sizes(const struct splats *s, const struct camera *view, const struct options *o)
{
	static const int channels[] = {1, 4, MOST_CHANNELS};
	float *values = need(s->n, MOST_CHANNELS * sizeof *values);
	uint8_t *is_wanted = o->part < 1 ? nearest(s, o->part) : NULL;
	const char *at = o->sizes;

	for (size_t i = 0; i < s->n * MOST_CHANNELS; i++)
		values[i] = (float)(i * 7 % 13) - 6;
	do {
		int width = view->width, height = view->height;
		if (at && (sscanf(at, "%dx%d", &width, &height) != 2 || width < 1 || height < 1 ||
				  width > 65536 || height > 65536))
			fail("-s: not WIDTHxHEIGHT,... with each from 1 to 65536");
		for (size_t k = 0; k < sizeof channels / sizeof *channels; k++) {
			struct job j = {.splats = s,
				.camera = camera_resize(view, width, height),
				.channels = channels[k],
				.repeats = o->repeats,
				.part = o->part,
				.is_wanted = is_wanted,
				.values = values};
			measure(&j);
		}
		at = at ? strchr(at, ',') : NULL;
	} while (at && *++at);
	free(values);
	free(is_wanted);
}

static void measure_scene(const char *dir, const char *name, const struct options *o)
{
	struct scene scene;
	struct err e;

	if (scene_read(&scene, dir, &e))
		fail(e.message);
	size_t v = 0;
	while (v < scene.cameras.n && strcmp(scene.cameras.views[v].name, name) != 0)
		v++;
	if (v == scene.cameras.n)
		fail("no such view");
	measure_sizes(&scene.splats, &scene.cameras.views[v], o);
	scene_free(&scene);
}

/* As gs-synth: the next layout where one cannot be. */
static void make_scene(struct synth_scene *scene, size_t gaussians)
{
	struct synth_options options = {.preset = synth_preset(0),
		.objects = 8,
		.views = SYNTH_MIN_VIEWS,
		.width = 986,
		.height = 728,
		.gaussians = gaussians};
	struct err e;
	int attempt = 0;

	do
		options.seed = synth_preset_seed(0, 1, attempt);
	while (synth_scene_make(scene, &options, &e) && ++attempt < MOST_ATTEMPTS);
	if (attempt == MOST_ATTEMPTS)
		fail(e.message);
}

static void measure_made(struct options *o)
{
	if (!o->sizes)
		o->sizes = "493x364,986x728";
	for (const char *at = o->gaussians; at; at = strchr(at, ',')) {
		at += *at == ',';
		const long n = strtol(at, NULL, 10);
		struct synth_scene scene;
		if (n < 1000 || n > 10000000)
			fail("-n: not numbers from 1000 to 10000000");
		make_scene(&scene, (size_t)n);
		measure_sizes(&scene.splats, &scene.cameras.views[0], o);
		synth_scene_free(&scene);
	}
}

int main(int argc, char **argv)
{
	struct options o = {.gaussians = "100000,500000", .repeats = 7, .part = 1};

	for (int c; (c = getopt(argc, argv, "n:s:r:l:")) != -1;)
		if (c == 'n')
			o.gaussians = optarg;
		else if (c == 's')
			o.sizes = optarg;
		else if (c == 'r')
			o.repeats = atoi(optarg);
		else if (c == 'l')
			o.part = atof(optarg);
		else
			optind = argc + 1;
	if ((argc != optind && argc != optind + 2) || o.repeats < 1 || o.repeats > MOST_REPEATS ||
		!(o.part >= 0 && o.part <= 1)) {
		fprintf(stderr,
			"usage: bench_render [-n GAUSSIANS,...] [-s WxH,...] [-r REPEATS] [-l PART] [SCENE VIEW]\n");
		return 2;
	}
	if (argc == optind)
		measure_made(&o);
	else
		measure_scene(argv[optind], argv[optind + 1], &o);
	return 0;
}
