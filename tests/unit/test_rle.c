#include "coco_golden.h"
#include "mask_help.h"
#include "unit.h"

#include <math.h>

static int golden_pixel(int height, int width, const int f[4], int y, int x)
{
	if (f[3])
		return (f[0] * y * y + f[1] * x + f[2] * x * y) % f[3] < f[3] / 2;
	long side = 2 * (height < width ? height : width) * f[0] / 100;
	long dy = 2 * y + 1 - height, dx = 2 * x + 1 - width;
	return dy * dy + dx * dx < side * side;
}

/* Both ways between pixels and the strings of the Python peer. */
static void test_golden(void)
{
	struct err e = {0};

	for (size_t i = 0; i < sizeof coco_golden / sizeof *coco_golden; i++) {
		int h = coco_golden[i].height, w = coco_golden[i].width;
		uint8_t *m = malloc((size_t)h * (size_t)w), *back = malloc((size_t)h * (size_t)w);
		for (int k = 0; k < h * w; k++)
			m[k] = golden_pixel(h, w, coco_golden[i].formula, k / w, k % w) ? 255 : 0;
		struct rle r = mask_rle(m, h, w), parsed;
		char *text = rle_to_string(&r, &e);
		CHECK(text && !strcmp(text, coco_golden[i].text), "case %zu: %s", i, text);
		if (CHECK(!rle_from_string(&parsed, coco_golden[i].text, h, w, &e), "case %zu: %s", i,
			    e.message)) {
			int differ = 0;
			rle_decode(&parsed, back);
			for (int k = 0; k < h * w; k++)
				differ += back[k] != (m[k] != 0);
			CHECK(!differ, "case %zu: %d pixels differ", i, differ);
			rle_free(&parsed);
		}
		rle_free(&r);
		free(text);
		free(m);
		free(back);
	}
}

static void test_random(void)
{
	struct rng rng;
	struct err e = {0};

	rng_seed(&rng, 7, 1);
	for (int round = 0; round < 600; round++) {
		int h = 1 + (int)rng_below(&rng, 40), w = 1 + (int)rng_below(&rng, 40), kind = round % 5;
		size_t pixels = (size_t)h * (size_t)w, area_a = 0, both = 0, either = 0;
		uint8_t *a = mask_random(&rng, h, w, kind),
			*b = mask_random(&rng, h, w, (int)rng_below(&rng, 5));
		uint8_t *back = malloc(pixels);
		struct rle x = mask_rle(a, h, w), y = mask_rle(b, h, w), parsed = {0};
		for (size_t i = 0; i < pixels; i++) {
			area_a += a[i];
			both += a[i] && b[i];
			either += a[i] || b[i];
		}
		char *text = rle_to_string(&x, &e);
		CHECK(!rle_from_string(&parsed, text, h, w, &e), "round %d: %s", round, e.message);
		CHECK(parsed.n == x.n && !memcmp(parsed.runs, x.runs, x.n * sizeof *x.runs), "round %d",
			round);
		rle_decode(&parsed, back);
		CHECK(!memcmp(back, a, pixels), "round %d: %dx%d kind %d", round, w, h, kind);
		CHECK(rle_area(&x) == area_a, "round %d", round);
		CHECK(rle_intersection(&x, &y) == both && rle_intersection(&y, &x) == both, "round %d",
			round);
		CHECK(rle_iou(&x, &y) == (either ? (double)both / (double)either : 1), "round %d", round);
		rle_free(&parsed);
		int wrong = rle_without(&parsed, &x, &y, &e);
		rle_decode(&parsed, back);
		for (size_t i = 0; i < pixels; i++)
			wrong += back[i] != (a[i] && !b[i]);
		CHECK(!wrong, "round %d: %d pixels of a without b", round, wrong);
		rle_free(&x);
		rle_free(&y);
		rle_free(&parsed);
		free(text);
		free(a);
		free(b);
		free(back);
	}
}

/* Share of foreground in one new pixel, by sampling the definition in float64. */
static double naive_share(const uint8_t *m, int H, int W, int h, int w, int i, int j)
{
	double sum = 0;

	for (int y = 0; y < H; y++)
		for (int x = 0; x < W; x++) {
			double top = fmax((double)y / H, (double)i / h),
			       bottom = fmin((y + 1.0) / H, (i + 1.0) / h);
			double left = fmax((double)x / W, (double)j / w),
			       right = fmin((x + 1.0) / W, (j + 1.0) / w);
			if (m[y * W + x] && bottom > top && right > left)
				sum += (bottom - top) * (right - left);
		}
	return sum * h * w;
}

static void test_resize(void)
{
	struct rng rng;
	struct err e = {0};

	rng_seed(&rng, 8, 1);
	for (int round = 0; round < 150; round++) {
		int H = 1 + (int)rng_below(&rng, 24), W = 1 + (int)rng_below(&rng, 24);
		int h = 1 + (int)rng_below(&rng, 30), w = 1 + (int)rng_below(&rng, 30), wrong = 0, total = 0;
		if (round % 10 == 0) {
			h = H;
			w = W;
		}
		uint8_t *m = mask_random(&rng, H, W, round % 5), *out = malloc((size_t)h * (size_t)w);
		struct rle from = mask_rle(m, H, W), to = {0};
		CHECK(!rle_resize(&to, &from, h, w, &e), "round %d: %s", round, e.message);
		rle_decode(&to, out);
		for (int i = 0; i < h; i++)
			for (int j = 0; j < w; j++) {
				double share = naive_share(m, H, W, h, w, i, j);
				/* exact halves round either way in float64; test_halves has those */
				if (fabs(share - 0.5) > 1e-9)
					wrong += out[i * w + j] != (share > 0.5);
			}
		for (size_t i = 0; i < to.n; i++)
			total += (int)to.runs[i];
		CHECK(!wrong && total == h * w, "round %d: %dx%d to %dx%d: %d wrong", round, W, H, w, h,
			wrong);
		rle_free(&from);
		rle_free(&to);
		free(m);
		free(out);
	}
}

/* Exactly one half is foreground; a hair less is not. */
static void test_halves(void)
{
	struct err e = {0};
	const uint8_t half[4] = {1, 0, 0, 1}, third[6] = {1, 0, 0, 0, 1, 0};
	struct rle from = mask_rle(half, 2, 2), to;

	CHECK(!rle_resize(&to, &from, 1, 1, &e) && rle_area(&to) == 1, "two of four");
	rle_free(&to);
	rle_free(&from);
	from = mask_rle(third, 2, 3);
	CHECK(!rle_resize(&to, &from, 1, 1, &e) && rle_area(&to) == 0, "two of six");
	rle_free(&to);
	/* 3 columns to 2, the middle one shared: 1 + 1/2 of 3 on the left is one half, 1/2 of 3 on the right
	 * is not */
	CHECK(!rle_resize(&to, &from, 1, 2, &e) && rle_area(&to) == 1 && to.runs[0] == 0, "a half, a sixth");
	rle_free(&to);
	rle_free(&from);
}

/* Brought to one size after another, and back: each time from the mask itself. */
static void test_fit(void)
{
	static const int sizes[][2] = {{20, 30}, {7, 11}, {7, 11}, {41, 13}, {20, 30}, {20, 31}};
	struct rng rng;
	struct err e = {0};

	rng_seed(&rng, 8, 1);
	for (int round = 0; round < 20; round++) {
		uint8_t *pixels = mask_random(&rng, 20, 30, round % 5), got[64 * 64], expected[64 * 64];
		struct rle r = mask_rle(pixels, 20, 30);
		struct rle_fitted f = {.own = &r};
		for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
			const int h = sizes[k][0], w = sizes[k][1];
			const size_t count = (size_t)h * (size_t)w;
			struct rle resized;
			CHECK(!rle_resize(&resized, &r, h, w, &e) && !rle_fit(&f, &resized, &e), "%s",
				e.message);
			CHECK(rle_same_size(f.now, &resized) && f.area == rle_area(&resized) &&
					(f.now == &r) == rle_same_size(&r, &resized),
				"round %d, %dx%d", round, w, h);
			rle_decode(&resized, expected);
			rle_decode(f.now, got);
			CHECK(!memcmp(got, expected, count), "round %d: fitted to %dx%d", round, w, h);
			CHECK(!rle_decode_at(&r, h, w, got, &e) && !memcmp(got, expected, count),
				"round %d: decoded at %dx%d", round, w, h);
			rle_free(&resized);
		}
		rle_fitted_free(&f);
		rle_free(&r);
		free(pixels);
	}
	CHECK(rle_decode_at(&(struct rle){1, 1, 1, (uint32_t[]){1}}, 0, 3, NULL, &e) && e.code == ERR_FORMAT,
		"no size");
}

static void expect_string_error(const char *text, int h, int w, const char *message)
{
	struct rle r;
	struct err e = {0};

	CHECK(rle_from_string(&r, text, h, w, &e) && e.code == ERR_FORMAT && !strcmp(e.message, message),
		"'%s': %s, expected %s", text, e.message, message);
	rle_free(&r);
}

static void test_errors(void)
{
	struct rle r;
	struct err e = {0};
	const uint32_t runs[2] = {3, 2};

	expect_string_error("", 2, 3, "the runs sum to 0, but 3x2 has 6 pixels");
	expect_string_error("32", 2, 3, "the runs sum to 5, but 3x2 has 6 pixels");
	expect_string_error("33~", 2, 3, "offset 2: byte 0x7e is not of a compressed run");
	expect_string_error("3 3", 2, 3, "offset 1: byte 0x20 is not of a compressed run");
	expect_string_error("3\xc3\xa9", 2, 3, "offset 1: byte 0xc3 is not of a compressed run");
	expect_string_error("3P", 2, 3, "offset 2: ends inside a number");
	expect_string_error("O", 2, 3, "offset 0: run 0 is -1, not within 0 to 6");
	expect_string_error("7", 2, 3, "offset 0: run 0 is 7, not within 0 to 6");
	expect_string_error("111N", 2, 3, "offset 3: run 3 is -1, not within 0 to 6");
	expect_string_error("3PPPPPPP0", 2, 3, "offset 1: a number of more than 7 characters");
	expect_string_error("6", 0, 3, "size 3x0 (width x height) is not within 1 to 65536");
	expect_string_error("6", 65537, 3, "size 3x65537 (width x height) is not within 1 to 65536");
	expect_string_error(
		"6", 65536, 65536, "size 65536x65536 (width x height) has more than 4294967295 pixels");
	CHECK(rle_from_runs(&r, runs, 2, 2, 3, &e) && strstr(e.message, "the runs sum to 5"), "%s",
		e.message);
	rle_free(&r);
}

/* The largest there is, in runs alone; and runs of length 0, which others may write. */
static void test_extremes(void)
{
	struct err e = {0};
	const uint32_t full[2] = {0, 65536u * 65535u}, odd[7] = {1, 0, 1, 2, 0, 1, 1};
	const uint8_t rows[6] = {0, 1, 1, 0, 1, 0}, other[6] = {0, 1, 0, 1, 1, 0};
	uint8_t pixels[6];
	struct rle r, small, same;

	CHECK(!rle_from_runs(&r, full, 2, 65536, 65535, &e), "%s", e.message);
	CHECK(rle_area(&r) == 4294901760u && rle_intersection(&r, &r) == 4294901760u, "full");
	CHECK(!rle_resize(&small, &r, 3, 4, &e) && rle_area(&small) == 12, "full stays full");
	rle_free(&small);
	char *text = rle_to_string(&r, &e);
	CHECK(text && !rle_from_string(&small, text, 65536, 65535, &e) && small.runs[1] == full[1], "%s",
		e.message);
	free(text);
	rle_free(&small);
	rle_free(&r);

	/* positions 0 | - | 1 | 2 3 | - | 4 | 5: foreground is 2 to 4 by columns of two, as rows 0 1 0 / 0 1
	 * ... */
	CHECK(!rle_from_runs(&r, odd, 7, 2, 3, &e), "%s", e.message);
	rle_decode(&r, pixels);
	CHECK(!memcmp(pixels, rows, 6), "zero runs");
	same = mask_rle(rows, 2, 3);
	CHECK(rle_area(&r) == 3 && rle_intersection(&r, &same) == 3 && rle_iou(&same, &r) == 1, "zero runs");
	rle_free(&same);
	same = mask_rle(other, 2, 3);
	CHECK(rle_intersection(&r, &same) == 2, "zero runs against another mask");
	rle_free(&same);
	CHECK(!rle_resize(&small, &r, 4, 6, &e) && rle_area(&small) == 12, "zero runs, doubled");
	rle_free(&small);
	rle_free(&r);
}

/* A side of a picture made smaller: rounded, cut or raised. */
static int side(int full, double scale, int how)
{
	const double x = full * scale, made = how == 0 ? floor(x + 0.5) : how == 1 ? floor(x) : ceil(x);

	return made < 1 ? 1 : (int)made;
}

/* What a photograph becomes at two scales has one shape; crops, other formats and turned pictures have not.
 */
static void test_shapes(void)
{
	static const int others[][4] = {{160, 120, 120, 160}, {53, 40, 120, 160}, {101, 100, 100, 101},
		{120, 120, 120, 160}, {118, 160, 120, 160}, {1088, 1920, 1080, 1920}, {484, 640, 968, 1296},
		{90, 160, 120, 160}};
	struct rng rng;
	struct err e = {0};
	int refused = 0;

	rng_seed(&rng, 8, 1);
	for (int round = 0; round < 100000; round++) {
		const int h = 40 + (int)rng_below(&rng, 4000), w = 40 + (int)rng_below(&rng, 4000),
			  how = round % 3;
		const double a = 0.02 + rng_uniform(&rng), b = 0.02 + rng_uniform(&rng);
		refused += !rle_has_shape(side(h, a, how), side(w, a, how), h, w) ||
			   !rle_has_shape(h, w, side(h, a, how), side(w, a, how)) ||
			   !rle_has_shape(side(h, a, how), side(w, a, how), side(h, b, how), side(w, b, how));
	}
	CHECK(!refused, "%d resized pictures", refused);
	CHECK(rle_has_shape(480, 640, 968, 1296) && rle_has_shape(968, 1296, 480, 640),
		"resized by two factors");
	for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
		const int *o = others[i];
		CHECK(rle_check_shape("a mask", o[0], o[1], "the view", o[2], o[3], &e) &&
				e.code == ERR_FORMAT && !strstr(e.message, "EXIF") == (i > 2),
			"%dx%d of %dx%d: %s", o[1], o[0], o[3], o[2], e.message);
	}
}

int main(void)
{
	test_shapes();
	test_golden();
	test_random();
	test_fit();
	test_resize();
	test_halves();
	test_errors();
	test_extremes();
	return unit_end();
}
