/* All windows are filtered in two passes, along rows and then along columns; so is, backwards, what the
 * gradient takes from each pixel's SSIM to the pixels of its window. Sums are made row by row and added in
 * order. */
#include "fit/photo_loss.h"

#include "base/mem.h"
#include "base/threads.h"

#include <math.h>
#include <omp.h>

enum { REACH = 5, TAPS = 2 * REACH + 1 };
#define SHARE_SSIM 0.2f
#define SSIM_C1 1e-4f /* 0.01^2 */
#define SSIM_C2 9e-4f /* 0.03^2 */

/* e^(-x^2 / 4.5), with sum 1 over both sides: the second is the first mirrored */
static const float window[REACH + 1] = {
	0.00102838f, 0.00759876f, 0.03600078f, 0.10936069f, 0.21300554f, 0.26601172f};

#if defined(__x86_64__) && defined(__GLIBC__)
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

/* out[i] = sum_t window[t] in[i + t - REACH], where in has REACH zeros on each side. */
CLONES static void filter_row(const float *restrict in, float *restrict out, int n)
{
	for (int i = 0; i < n; i++) {
		float sum = window[REACH] * in[i];
		for (int t = 0; t < REACH; t++)
			sum += window[t] * (in[i + t - REACH] + in[i + REACH - t]);
		out[i] = sum;
	}
}

/* The same over rows: row y of a plane whose rows are `width` long; `none` is a row of zeros. */
CLONES static void filter_column(const float *restrict plane, const float *restrict none, float *restrict out,
	int y, int height, int width)
{
	const float *rows[TAPS];

	for (int t = 0, from = y - REACH; t < TAPS; t++, from++)
		rows[t] = from < 0 || from >= height ? none : plane + (size_t)from * (size_t)width;
	for (int x = 0; x < width; x++) {
		float sum = window[REACH] * rows[REACH][x];
		for (int t = 0; t < REACH; t++)
			sum += window[t] * (rows[t][x] + rows[TAPS - 1 - t][x]);
		out[x] = sum;
	}
}

/* SSIM of a row of pixels from the filtered means x and y, xx, yy and xy; returns its sum. In place of xx, yy
 * and xy come its slopes in the filtered x, xx and xy. */
CLONES static double ssim_row(float *restrict x, const float *restrict y, float *restrict xx,
	float *restrict yy, float *restrict xy, float *restrict score, int n)
{
	double sum = 0;

	for (int i = 0; i < n; i++) {
		const float mx = x[i], my = y[i], a1 = 2 * mx * my + SSIM_C1,
			    b1 = mx * mx + my * my + SSIM_C1;
		const float a2 = 2 * (xy[i] - mx * my) + SSIM_C2;
		const float b2 = (xx[i] - mx * mx) + (yy[i] - my * my) + SSIM_C2;
		const float per = 1 / (b1 * b2), s = a1 * a2 * per;
		score[i] = s;
		xx[i] = 2 * per * (my * (a2 - a1) - mx * s * (b2 - b1));
		yy[i] = -s / b2;
		xy[i] = 2 * a1 * per;
	}
	for (int i = 0; i < n; i++)
		sum += score[i];
	return sum;
}

/* One channel of an image and its photograph. */
struct channel {
	int height, width;
	const float *x;
	float *y;	    /* both (P) */
	float *filtered[5]; /* (P) along rows, and then, from slope 0 to 2, slopes that are filtered */
	float *slopes[3];   /* (P) */
	const float *none;  /* (width) zeros */
	double *rows;	    /* (3,height) sums of a row */
};

/* A row with zeros around it, times another or not. */
static void pad(float *to, const float *a, const float *b, int n)
{
	memset(to, 0, REACH * sizeof *to);
	memset(to + REACH + n, 0, REACH * sizeof *to);
	for (int i = 0; i < n; i++)
		to[REACH + i] = b ? a[i] * b[i] : a[i];
}

static void filter_rows(const struct channel *c, int y, float *row)
{
	const size_t at = (size_t)y * (size_t)c->width;
	const float *a = c->x + at, *b = c->y + at;
	const float *const pairs[5][2] = {{a, NULL}, {b, NULL}, {a, a}, {b, b}, {a, b}};

	for (int k = 0; k < 5; k++) {
		pad(row, pairs[k][0], pairs[k][1], c->width);
		filter_row(row + REACH, c->filtered[k] + at, c->width);
	}
}

static void score_row(const struct channel *c, int y, float *row)
{
	const int n = c->width;
	float *of[5];

	for (int k = 0; k < 5; k++) {
		of[k] = row + (size_t)k * (size_t)n;
		filter_column(c->filtered[k], c->none, of[k], y, c->height, n);
	}
	c->rows[y] = ssim_row(of[0], of[1], of[2], of[3], of[4], row + 5 * (size_t)n, n);
	for (int k = 0; k < 3; k++)
		memcpy(c->slopes[k] + (size_t)y * (size_t)n, of[2 + k], (size_t)n * sizeof(float));
}

static void filter_slopes(const struct channel *c, int y, float *row)
{
	for (int k = 0; k < 3; k++) {
		const size_t at = (size_t)y * (size_t)c->width;
		pad(row, c->slopes[k] + at, NULL, c->width);
		filter_row(row + REACH, c->filtered[k] + at, c->width);
	}
}

/* d(mean SSIM)/dx of a row, times -share, and the slope of L1. */
static void gradient_row(const struct channel *c, int y, float *row, float *gradient)
{
	const size_t n = (size_t)c->width, at = (size_t)y * n;
	const float per = 1 / (3 * (float)n * (float)c->height);

	for (int k = 0; k < 3; k++)
		filter_column(c->filtered[k], c->none, row + (size_t)k * n, y, c->height, c->width);
	for (size_t i = 0; i < n; i++) {
		const float a = c->x[at + i], b = c->y[at + i];
		const float ssim = row[i] + 2 * a * row[n + i] + b * row[2 * n + i];
		gradient[at + i] = per * ((1 - SHARE_SSIM) * (float)((a > b) - (a < b)) - SHARE_SSIM * ssim);
	}
}

static void differences(const struct channel *c, int y)
{
	const size_t n = (size_t)c->width, at = (size_t)y * n;
	double l1 = 0, squares = 0;

	for (size_t i = at; i < at + n; i++) {
		const float a = c->x[i], d = (a < 0 ? 0 : a > 1 ? 1 : a) - c->y[i];
		l1 += fabsf(a - c->y[i]);
		squares += (double)d * d;
	}
	c->rows[c->height + y] = l1;
	c->rows[2 * c->height + y] = squares;
}

/* One channel's sums are added to *l; rows share the work; `scratch` has 6 rows and some for each thread. */
static void channel_loss(
	const struct channel *c, float *scratch, size_t scratch_row, float *gradient, struct photo_loss *l)
{
#pragma omp parallel for schedule(static)
	for (int y = 0; y < c->height; y++) {
		filter_rows(c, y, scratch + (size_t)omp_get_thread_num() * scratch_row);
		differences(c, y);
	}
#pragma omp parallel for schedule(static)
	for (int y = 0; y < c->height; y++)
		score_row(c, y, scratch + (size_t)omp_get_thread_num() * scratch_row);
	if (gradient) {
#pragma omp parallel for schedule(static)
		for (int y = 0; y < c->height; y++)
			filter_slopes(c, y, scratch + (size_t)omp_get_thread_num() * scratch_row);
#pragma omp parallel for schedule(static)
		for (int y = 0; y < c->height; y++)
			gradient_row(c, y, scratch + (size_t)omp_get_thread_num() * scratch_row, gradient);
	}
	for (int y = 0; y < c->height; y++) {
		l->ssim += c->rows[y];
		l->l1 += c->rows[c->height + y];
		l->squares += c->rows[2 * c->height + y];
	}
}

void photo_loss_free(struct photo_loss_room *r)
{
	mem_free_all(r->planes, r->rows);
	*r = (struct photo_loss_room){0};
}

int photo_loss(struct photo_loss *l, const float *image, const uint8_t *photograph, int height, int width,
	float *gradient, struct photo_loss_room *room, struct err *e)
{
	const size_t pixels = (size_t)height * (size_t)width, row = 6 * (size_t)width + 2 * REACH + 16;

	*l = (struct photo_loss){0};
	if (mem_room((void **)&room->planes, &room->plane_room,
		    9 * pixels + (size_t)threads_available() * row + (size_t)width, sizeof *room->planes,
		    "image", e) ||
		mem_room((void **)&room->rows, &room->row_room, 3 * (size_t)height, sizeof *room->rows,
			"image", e))
		return -1;
	for (size_t k = 0; k < 3; k++) {
		struct channel c = {.height = height, .width = width, .y = room->planes, .rows = room->rows};
		c.x = image + k * pixels;
		c.none = memset(room->planes + 9 * pixels, 0, (size_t)width * sizeof *room->planes);
		for (size_t i = 0; i < 8; i++)
			*(i < 5 ? &c.filtered[i] : &c.slopes[i - 5]) = room->planes + (i + 1) * pixels;
#pragma omp parallel for schedule(static)
		for (size_t p = 0; p < pixels; p++)
			c.y[p] = (float)photograph[3 * p + k] * (1.0f / 255);
		channel_loss(&c, room->planes + 9 * pixels + width, row,
			gradient ? gradient + k * pixels : NULL, l);
	}
	const double n = 3 * (double)pixels;
	l->l1 /= n;
	l->ssim /= n;
	l->squares /= n;
	l->total = (1 - (double)SHARE_SSIM) * l->l1 + (double)SHARE_SSIM * (1 - l->ssim);
	return 0;
}
