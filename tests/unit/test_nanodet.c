/* The network beside TensorFlow.js's own run of its graph, with made-up weights on a made-up picture; what
 * goes in and what comes out. */
#include "unit.h"

#include "base/mem.h"
#include "nn/nanodet.h"

#include <omp.h>

static uint32_t state;

static float next(void)
{
	state = state * 1664525u + 1013904223u;
	return (float)((double)(state >> 8) / 16777216 * 2 - 1);
}

/* Weights that leave numbers as large as they are. */
static void make_up(struct nanodet *n)
{
	state = 1;
	for (int i = 0; i < NANODET_CONVS; i++) {
		const struct conv *c = &n->convs[i];
		const size_t terms = c->side * c->side * c->in;
		const float scale = (float)sqrt(3.0 / (double)terms);
		for (size_t k = 0; k < terms * c->out; k++)
			c->weight[k] = next() * scale;
		for (size_t k = 0; k < c->out; k++)
			c->bias[k] = next() * 0.125f;
	}
}

static void draw(float *in)
{
	for (int y = 0; y < NANODET_SIDE; y++)
		for (int x = 0; x < NANODET_SIDE; x++)
			for (int c = 0; c < 3; c++)
				*in++ = (float)((x * (c + 3) + y * (7 - c) + ((x >> 4) ^ (y >> 5)) * 29) %
						256) /
						64 -
					2;
}

enum { LOOKED_AT = 4 };
static const int columns[LOOKED_AT] = {0, 79, 80, 123};

/* Cells at the beginning, the middle and the end of each level: what tfjs 4.22 makes of them, classes before
 * their logistic function. */
static const struct {
	int cell;
	double values[LOOKED_AT];
} golden[] = {
	{0, {-0.07141536, -0.2331358, -0.1645591, -0.08171713}},
	{1355, {0.05538687, -0.4125390, -0.4824705, 0.08143087}},
	{2703, {0.1534689, -0.02743929, -0.2281781, -0.1094802}},
	{2704, {-0.2481128, -0.04938020, 0.08956560, 0.09805346}},
	{3045, {-0.8438197, -0.07166244, 0.1643129, 0.2436466}},
	{3379, {-0.4935722, -0.0006626845, 0.1732834, 0.5653763}},
	{3380, {-0.05530073, -0.3447039, -0.3771229, 0.6543543}},
	{3467, {0.2013872, -0.2154345, -0.2400470, 0.9878861}},
	{3548, {0.1649879, 0.1691748, 0.1407697, 0.5902447}},
};

static void follows_tfjs(void)
{
	struct err e;
	struct nanodet n;
	const size_t numbers = (size_t)NANODET_CELLS * NANODET_OUT;
	float *in = mem_alloc(NANODET_SIDE * NANODET_SIDE * 3, sizeof *in, "", &e),
	      *out = mem_alloc(numbers, sizeof *out, "", &e),
	      *first = mem_alloc(numbers, sizeof *out, "", &e);
	double worst = 0;

	if (!CHECK(!nanodet_alloc(&n, &e) && in && out && first, "%s", e.message))
		return;
	float *scratch = mem_alloc(nanodet_scratch(&n), sizeof *scratch, "", &e);
	make_up(&n);
	draw(in);
	omp_set_num_threads(1);
	nanodet_forward(&n, first, in, scratch);
	omp_set_num_threads(2);
	nanodet_forward(&n, out, in, scratch);
	CHECK(!memcmp((void *)first, (void *)out, numbers * sizeof *out), "1 and 2 threads");
	for (size_t i = 0; i < sizeof golden / sizeof *golden; i++)
		for (int k = 0; k < LOOKED_AT; k++)
			worst = fmax(worst, fabs((double)out[golden[i].cell * NANODET_OUT + columns[k]] -
						    golden[i].values[k]));
	CHECK(worst < 1e-5, "%g", worst);
	nanodet_free(&n);
	mem_free_all(in, out, first, scratch);
}

/* The tent of nanodet_picture, in double. */
static double seen(const uint8_t *rgb, int width, const struct nanodet_window *w, int y, int x, int c)
{
	const double down = (double)w->height / NANODET_SIDE, right = (double)w->width / NANODET_SIDE;
	double sum = 0, all = 0;

	for (int i = 0; i < w->height; i++)
		for (int j = 0; j < w->width; j++) {
			const double part = fmax(0, 1 - fabs(i + 0.5 - (y + 0.5) * down) / fmax(1, down)) *
					    fmax(0, 1 - fabs(j + 0.5 - (x + 0.5) * right) / fmax(1, right));
			all += part;
			sum += part * rgb[3 * ((w->top + i) * width + w->left + j) + c];
		}
	return sum / all;
}

static void pictures(void)
{
	static const struct nanodet_window windows[] = {
		{0, 0, 1000, 24}, {3, 5, 11, 7}, {990, 23, 10, 1}, {500, 0, 416, 24}};
	static const double mean[3] = {103.53, 116.28, 123.675}, deviation[3] = {57.375, 57.12, 58.395};
	static uint8_t rgb[24 * 1000 * 3];
	static float in[NANODET_SIDE * NANODET_SIDE * 3];
	struct err e;

	for (size_t i = 0; i < sizeof rgb; i++)
		rgb[i] = (uint8_t)(i * i % 251);
	for (size_t i = 0; i < sizeof windows / sizeof *windows; i++) {
		double worst = 0;
		CHECK(!nanodet_picture(in, rgb, 1000, &windows[i], &e), "%s", e.message);
		for (int p = 0; p < NANODET_SIDE * NANODET_SIDE; p += 3001)
			for (int c = 0; c < 3; c++)
				worst = fmax(worst, fabs((double)in[3 * p + c] * deviation[c] + mean[c] -
							    seen(rgb, 1000, &windows[i], p / NANODET_SIDE,
								    p % NANODET_SIDE, 2 - c)));
		CHECK(worst < 1e-3, "window %zu: %g", i, worst);
	}
}

/* One cell of each level that is sure of one bin a side. */
static void boxes(void)
{
	static float out[NANODET_CELLS * NANODET_OUT];
	const struct nanodet_window w = {100, 50, 832, 416};
	static const int cells[] = {2 * 52 + 10, 52 * 52 + 26 * 25 + 25, 52 * 52 + 26 * 26};
	static const float wanted[][4] = {/* strides of 16 and 8, 32 and 16, 64 and 32 */
		{252, 54, 316, 102}, {884, 426, 932, 466}, {100, 50, 324, 194}};
	struct nanodet_boxes found = {0};
	struct err e;

	for (int i = 0; i < NANODET_CELLS * NANODET_OUT; i++)
		out[i] = -100;
	for (int i = 0; i < 3; i++) {
		float *cell = out + cells[i] * NANODET_OUT;
		cell[41 + i] = (float)(2 - i);
		for (int k = 0; k < 4; k++)
			cell[NANODET_CLASSES + k * NANODET_BINS + k + 1] = 100;
	}
	out[cells[0] * NANODET_OUT + 39] = -1;
	out[(cells[0] + 52) * NANODET_OUT + 41] = 1; /* a little below, less sure */
	memcpy(out + (cells[0] + 52) * NANODET_OUT + NANODET_CLASSES,
		out + cells[0] * NANODET_OUT + NANODET_CLASSES, 4 * NANODET_BINS * sizeof *out);
	CHECK(!nanodet_add(&found, out, &w, 0.3f, &e) && found.n == 4, "%zu", found.n);
	CHECK(!nanodet_add(&found, out, &w, 0.1f, &e) && found.n == 9, "%zu", found.n);
	nanodet_thin(&found, 0.6);
	CHECK(found.n == 4 && found.items[3].label == 39, "%zu", found.n);
	for (size_t i = 0; i < 3; i++) {
		const struct nanodet_box *b = &found.items[i];
		CHECK(b->label == 41 + (int)i && fabs((double)b->score - 1 / (1 + exp((double)i - 2))) < 1e-6,
			"%zu: %d %g", i, b->label, (double)b->score);
		for (int k = 0; k < 4; k++)
			CHECK(fabs((double)b->side[k] - (double)wanted[i][k]) < 0.01, "%zu, side %d: %g", i,
				k, (double)b->side[k]);
	}
	CHECK(!strcmp(nanodet_classes[0], "person") && !strcmp(nanodet_classes[41], "cup") &&
			!strcmp(nanodet_classes[79], "toothbrush"),
		"COCO's names");
	free(found.items);
	found = (struct nanodet_boxes){0};
	nanodet_thin(&found, 0.6);
	CHECK(!found.n, "none");
}

int main(void)
{
	follows_tfjs();
	pictures();
	boxes();
	return unit_end();
}
