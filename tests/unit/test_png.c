/* PNG and JPEG: what we write comes back, other people's kinds are read, broken ones are refused. */
#include "base/rng.h"
#include "formats/images/jpeg.h"
#include "formats/images/png.h"
#include "unit.h"

#include <png.h>
#include <jpeglib.h>
#include <zlib.h>
#include <unistd.h>

static char path[] = "/tmp/test_png.XXXXXX";

static size_t slurp(char *bytes, size_t room)
{
	FILE *in = fopen(path, "rb");
	size_t len = fread(bytes, 1, room, in);

	fclose(in);
	return len;
}

static void put(const char *bytes, size_t len)
{
	FILE *out = fopen(path, "wb");

	fwrite(bytes, 1, len, out);
	fclose(out);
}

/* The colour of put_png's greys and RGB that is transparent, or NULL. */
static png_color_16 *clear_colour;

/* A 3x2 PNG of any kind. rows: 2 rows of raw samples. */
static void put_png(int depth, int colour, int interlace, const uint8_t *rows, size_t row_bytes)
{
	static const png_color palette[4] = {{0, 0, 0}, {0, 0, 1}, {9, 0, 0}, {0, 0, 0}};
	png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
	png_infop info = png_create_info_struct(png);
	png_bytep both[2] = {(png_bytep)(size_t)rows, (png_bytep)(size_t)(rows + row_bytes)};
	FILE *out = fopen(path, "wb");

	png_init_io(png, out);
	png_set_IHDR(png, info, 3, 2, depth, colour, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
		PNG_FILTER_TYPE_DEFAULT);
	if (colour == PNG_COLOR_TYPE_PALETTE) {
		png_set_PLTE(png, info, palette, 4);
		png_set_tRNS(png, info, (png_byte[]){0, 128, 255, 7}, 4, NULL);
	}
	if (clear_colour)
		png_set_tRNS(png, info, NULL, 0, clear_colour);
	png_write_info(png, info);
	png_write_image(png, both);
	png_write_end(png, info);
	png_destroy_write_struct(&png, &info);
	fclose(out);
}

static void expect_mask(const char *what, const char *expected)
{
	uint8_t *m;
	int h = 0, w = 0;
	char got[7] = "";
	struct err e = {0};

	if (!CHECK(!png_read_mask(path, &m, &h, &w, &e), "%s: %s", what, e.message))
		return;
	for (int i = 0; i < 6 && h == 2 && w == 3; i++)
		got[i] = (char)('0' + m[i]);
	CHECK(!strcmp(got, expected), "%s: %s, expected %s", what, got, expected);
	free(m);
}

static void expect_labels(const char *what, const int32_t expected[6])
{
	int32_t *labels;
	int h = 0, w = 0;
	struct err e = {0};

	if (!CHECK(!png_read_labels(path, &labels, &h, &w, &e), "%s: %s", what, e.message))
		return;
	CHECK(h == 2 && w == 3 && !memcmp(labels, expected, 6 * sizeof *labels), "%s: %dx%d, %d %d %d", what,
		w, h, labels[0], labels[1], labels[5]);
	free(labels);
}

static void expect_paint(const char *what, const uint32_t expected[6])
{
	uint32_t *paint;
	int h, w;
	struct err e = {0};

	if (!CHECK(!png_read_paint(path, &paint, &h, &w, &e), "%s: %s", what, e.message))
		return;
	CHECK(h == 2 && w == 3 && !memcmp(paint, expected, 6 * sizeof *paint), "%s: %x %x %x %x %x %x", what,
		paint[0], paint[1], paint[2], paint[3], paint[4], paint[5]);
	free(paint);
}

/* What is painted, with numbers of 16 bits, and what is transparent in any way. */
static void test_paint(void)
{
	enum { N = PNG_PAINT_NUMBER, NONE = PNG_PAINT_NONE };
	const uint8_t numbers[12] = {0, 1, 1, 44, 0, 0, 0, 255, 255, 255, 0, 2};
	const uint8_t doubled[12] = {1, 1, 255, 255, 0, 0, 7, 7, 0, 0, 0, 0}, bits[2] = {0xa0, 0x40};
	const uint8_t rgb[18] = {1, 2, 3, 255, 255, 255, 0, 0, 0, 1, 2, 3, 1, 2, 4, 255, 255, 255};
	const uint8_t pale[24] = {
		9, 0, 0, 99, 9, 0, 0, 3, 1, 1, 1, 0, 0, 7, 0, 100, 5, 5, 5, 49, 0, 0, 0, 51};
	uint8_t deep[48] = {0};
	png_color_16 white = {.red = 255, .green = 255, .blue = 255, .gray = 1};

	put_png(16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, numbers, 6);
	expect_paint("16 bits are numbers",
		(const uint32_t[]){0x010101, N | 300, 0, 0xffffff, N | 65535, 0x020202});
	put_png(16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, doubled, 6);
	expect_paint("8 bits twice", (const uint32_t[]){0x010101, 0xffffff, 0, 0x070707, 0, 0});
	put_png(8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, rgb, 9);
	expect_paint("colours", (const uint32_t[]){0x010203, 0xffffff, 0, 0x010203, 0x010204, 0xffffff});
	clear_colour = &white;
	put_png(8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, rgb, 9);
	expect_paint("a clear colour", (const uint32_t[]){0x010203, NONE, 0, 0x010203, 0x010204, NONE});
	expect_mask("a clear colour", "100110");
	put_png(1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, bits, 1);
	expect_paint("a clear bit", (const uint32_t[]){NONE, 0, NONE, 0, NONE, 0});
	expect_labels("a clear bit", (const int32_t[]){-1, 0, -1, 0, -1, 0});
	clear_colour = NULL;
	put_png(1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, bits, 1);
	expect_paint("bits are black and white", (const uint32_t[]){0xffffff, 0, 0xffffff, 0, 0xffffff, 0});
	put_png(8, PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, pale, 12);
	expect_paint(
		"pale paint and a soft rubber", (const uint32_t[]){0x090000, NONE, NONE, 0x000700, NONE, 0});
	expect_mask("pale paint and a soft rubber", "100100");
	put_png(2, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE, (const uint8_t *)"\x18\xc4", 1);
	expect_paint("a palette", (const uint32_t[]){NONE, 1, 0x090000, NONE, NONE, 1});
	for (int i = 0; i < 6; i++)
		deep[8 * i] = deep[8 * i + 1] = deep[8 * i + 6] = 255; /* red; a high byte of alpha */
	deep[1] = 254;
	deep[46] = 0;
	put_png(16, PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, deep, 24);
	expect_paint("16 bit colour", (const uint32_t[]){NONE, 0xff0000, 0xff0000, 0xff0000, 0xff0000, NONE});
	expect_mask("16 bit colour", "111110");
}

static void expect_rgb(const char *what, const uint8_t expected[18])
{
	uint8_t *rgb;
	int h, w;
	struct err e = {0};

	if (!CHECK(!image_read_rgb(path, &rgb, &h, &w, &e), "%s: %s", what, e.message))
		return;
	CHECK(h == 2 && w == 3 && !memcmp(rgb, expected, 18), "%s", what);
	free(rgb);
}

static void test_kinds(void)
{
	const uint8_t bits[2] = {0xa0, 0x40}, index[2] = {0x18, 0xc4}, grey[6] = {0, 1, 255, 0, 0, 7};
	const uint8_t grey_alpha[12] = {0, 255, 1, 0, 0, 9, 0, 0, 2, 255, 0, 255};
	const uint8_t rgba[24] = {
		0, 0, 0, 255, 0, 0, 1, 0, 5, 0, 0, 9, 0, 0, 0, 0, 0, 7, 0, 255, 0, 0, 0, 255};
	const uint8_t deep[12] = {0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 255, 255};
	const uint8_t deep_rgb[36] = {[5] = 1, [12] = 3};

	put_png(1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, bits, 1);
	expect_mask("1 bit", "101010");
	expect_rgb("1 bit", (uint8_t[18]){255, 255, 255, 0, 0, 0, 255, 255, 255, 0, 0, 0, 255, 255, 255});
	put_png(2, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE, index, 1);
	expect_mask("palette with transparency: by colour", "011001");
	expect_rgb("palette", (uint8_t[18]){0, 0, 0, 0, 0, 1, 9, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1});
	put_png(8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, grey, 3);
	expect_mask("grey", "011001");
	put_png(8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_ADAM7, grey, 3);
	expect_mask("interlaced", "011001");
	expect_rgb("interlaced", (uint8_t[18]){0, 0, 0, 1, 1, 1, 255, 255, 255, 0, 0, 0, 0, 0, 0, 7, 7, 7});
	put_png(8, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_INTERLACE_NONE, grey_alpha, 6);
	expect_mask("what is transparent is none", "000010");
	put_png(8, PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, rgba, 12);
	expect_mask("any colour", "000010");
	expect_rgb("what is transparent lies on black", (uint8_t[18]){[13] = 7});
	put_png(16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, deep, 6);
	expect_mask("16 bit: 1 of 65535 is foreground", "011001");
	expect_rgb("16 bit", (uint8_t[18]){0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 255, 255, 255});
	put_png(16, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, deep_rgb, 18);
	expect_mask("16 bit colour", "101000");
}

static void test_write(void)
{
	const uint8_t grey[6] = {0, 255, 0, 3, 0, 0},
		      colour[18] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0, 0, 255, 254, 253, 9, 8, 7};
	const uint16_t deep[6] = {0, 1, 256, 0x1234, 65535, 0};
	uint8_t back[12];
	struct err e = {0};

	CHECK(!png_write(path, grey, 2, 3, 1, &e), "%s", e.message);
	expect_mask("grey", "010100");
	CHECK(!png_write(path, colour, 2, 3, 3, &e), "%s", e.message);
	expect_rgb("colour", colour);
	CHECK(!png_write16(path, deep, 2, 3, &e), "%s", e.message);
	FILE *in = fopen(path, "rb");
	png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
	png_infop info = png_create_info_struct(png);
	png_init_io(png, in);
	png_read_info(png, info);
	CHECK(png_get_bit_depth(png, info) == 16 && png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY,
		"16 bit grey");
	png_read_image(png, (png_bytep[2]){back, back + 6});
	png_destroy_read_struct(&png, &info, NULL);
	fclose(in);
	for (int i = 0; i < 6; i++)
		CHECK(back[2 * i] * 256 + back[2 * i + 1] == deep[i], "value %d", i);
	CHECK(png_write("/nowhere/at/all.png", grey, 2, 3, 1, &e) && e.code == ERR_SYSTEM &&
			!strcmp(e.message, "/nowhere/at/all.png: No such file or directory"),
		"%s", e.message);
}

/* A PNG cut anywhere is refused; one with changed bytes is refused or read. The sanitisers watch. */
static void test_broken_png(void)
{
	uint8_t pixels[20 * 30], *m;
	char bytes[4096];
	struct rng rng;
	struct err e = {0};
	int h, w, refused = 0;

	rng_seed(&rng, 2, 1);
	for (size_t i = 0; i < sizeof pixels; i++)
		pixels[i] = (uint8_t)rng_below(&rng, 5);
	png_write(path, pixels, 20, 30, 1, &e);
	size_t len = slurp(bytes, sizeof bytes);
	for (size_t cut = 0; cut < len; cut++) {
		put(bytes, cut);
		e = (struct err){0};
		CHECK(png_read_mask(path, &m, &h, &w, &e) && e.code == ERR_FORMAT &&
				strstr(e.message, ": PNG: the file ends too early"),
			"cut at %zu: %s", cut, e.message);
	}
	for (int round = 0; round < 3000; round++) {
		char changed[sizeof bytes];
		memcpy(changed, bytes, len);
		changed[rng_below(&rng, (uint32_t)len)] ^= (char)(1 + rng_below(&rng, 255));
		put(changed, len);
		if (png_read_mask(path, &m, &h, &w, &e)) {
			refused++;
			if (e.code != ERR_FORMAT || !strstr(e.message, ": PNG: "))
				CHECK(0, "%s", e.message);
		} else {
			free(m);
		}
	}
	CHECK(refused > 2000, "%d refused", refused);
	/* a size that a PNG may state and we do not read */
	const char huge[] =
		"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\0\0\0\0\x7a\x62\x21\xbe";
	put(huge, sizeof huge - 1);
	CHECK(image_read_rgb(path, &m, &h, &w, &e) && e.code == ERR_FORMAT, "%s", e.message);
}

static size_t put_jpeg(J_COLOR_SPACE space, int components)
{
	struct jpeg_compress_struct jpeg;
	struct jpeg_error_mgr manager;
	FILE *out = fopen(path, "wb");
	uint8_t row[64 * 4];

	jpeg.err = jpeg_std_error(&manager);
	jpeg_create_compress(&jpeg);
	jpeg_stdio_dest(&jpeg, out);
	jpeg.image_width = 64;
	jpeg.image_height = 48;
	jpeg.input_components = components;
	jpeg.in_color_space = space;
	jpeg_set_defaults(&jpeg);
	jpeg_set_quality(&jpeg, 95, TRUE);
	jpeg_start_compress(&jpeg, TRUE);
	for (int y = 0; y < 48; y++) {
		for (int i = 0; i < 64 * components; i++)
			row[i] = (uint8_t)(i % components == 0 ? 4 * y : 100);
		jpeg_write_scanlines(&jpeg, (JSAMPROW[1]){row}, 1);
	}
	jpeg_finish_compress(&jpeg);
	jpeg_destroy_compress(&jpeg);
	long len = ftell(out);
	fclose(out);
	return (size_t)len;
}

static void test_jpeg(void)
{
	uint8_t *rgb;
	int h, w, refused = 0;
	char bytes[8192];
	struct rng rng;
	struct err e = {0};

	put_jpeg(JCS_GRAYSCALE, 1);
	CHECK(!image_read_rgb(path, &rgb, &h, &w, &e) && h == 48 && w == 64, "%s", e.message);
	CHECK(abs(rgb[3 * 64 * 20] - 80) < 4 && rgb[3 * 64 * 20] == rgb[3 * 64 * 20 + 2], "grey: %d",
		rgb[3 * 64 * 20]);
	free(rgb);
	put_jpeg(JCS_CMYK, 4);
	CHECK(image_read_rgb(path, &rgb, &h, &w, &e) &&
			strstr(e.message,
				": JPEG: CMYK colours are not supported ('mogrify -colorspace sRGB' converts them)"),
		"%s", e.message);
	put_jpeg(JCS_RGB, 3);
	size_t len = slurp(bytes, sizeof bytes);
	CHECK(!image_read_rgb(path, &rgb, &h, &w, &e) && h == 48 && w == 64, "%s", e.message);
	CHECK(abs(rgb[3 * 64 * 20] - 80) < 6 && abs(rgb[3 * 64 * 20 + 1] - 100) < 6, "colour: %d",
		rgb[3 * 64 * 20]);
	free(rgb);
	for (size_t cut = 1; cut < len; cut++) {
		put(bytes, cut);
		e = (struct err){0};
		CHECK(image_read_rgb(path, &rgb, &h, &w, &e) && e.code == ERR_FORMAT &&
				strstr(e.message, ": JPEG: "),
			"cut at %zu: %s", cut, e.message);
	}
	rng_seed(&rng, 9, 1);
	for (int round = 0; round < 2000; round++) {
		char changed[sizeof bytes];
		memcpy(changed, bytes, len);
		changed[2 + rng_below(&rng, (uint32_t)len - 2)] ^= (char)(1 + rng_below(&rng, 255));
		put(changed, len);
		if (image_read_rgb(path, &rgb, &h, &w, &e))
			refused++;
		else
			free(rgb);
	}
	CHECK(refused > 50, "%d refused", refused);
	put("GIF89a", 6);
	CHECK(image_read_rgb(path, &rgb, &h, &w, &e) &&
			strstr(e.message, ": neither PNG nor JPEG: begins with byte 0x47"),
		"%s", e.message);
	CHECK(png_read_mask(path, &rgb, &h, &w, &e) && e.code == ERR_FORMAT && strstr(e.message, ": PNG: "),
		"%s", e.message);
	put("", 0);
	CHECK(image_read_rgb(path, &rgb, &h, &w, &e) && strstr(e.message, ": an empty file, not an image"),
		"%s", e.message);
}

/* The file in `bytes` must be refused for its 30000 x 30000 pixels. */
static void expect_too_large(const char *kind, const char *bytes, size_t len)
{
	char expected[128];
	uint8_t *pixels;
	int h, w;
	struct err e = {0};

	snprintf(expected, sizeof expected, "%s: %s: 30000x30000 pixels, more than %d altogether", path, kind,
		PICTURE_PIXELS_MAX);
	put(bytes, len);
	CHECK(image_read_rgb(path, &pixels, &h, &w, &e) && e.code == ERR_FORMAT &&
			!strcmp(e.message, expected),
		"%s", e.message);
	if (!strcmp(kind, "PNG"))
		CHECK(png_read_mask(path, &pixels, &h, &w, &e) && !strcmp(e.message, expected), "%s",
			e.message);
}

static void put_be(char *to, uint32_t x, int bytes)
{
	for (int i = bytes; i-- > 0; x >>= 8)
		to[i] = (char)(x & 255);
}

/* A picture that says it is large takes no memory, however short its file is. */
/* What is written reads back as nearly the same colours, and a picture that is too large is an error. */
static void test_write_jpeg(void)
{
	enum { H = 21, W = 34 };
	static uint8_t rgb[3 * H * W];
	uint8_t *bytes, *back;
	size_t n;
	int h, w, off = 0;
	struct err e = {0};

	for (int p = 0; p < H * W; p++) {
		rgb[3 * p] = (uint8_t)(10 * (p / W));
		rgb[3 * p + 1] = (uint8_t)(6 * (p % W));
		rgb[3 * p + 2] = 120;
	}
	CHECK(!jpeg_encode("p", rgb, H, W, 95, &bytes, &n, &e), "%s", e.message);
	put((char *)bytes, n);
	CHECK(!image_read_rgb(path, &back, &h, &w, &e) && h == H && w == W, "%s", e.message);
	for (int i = 0; i < 3 * H * W; i++)
		off = abs(back[i] - rgb[i]) > off ? abs(back[i] - rgb[i]) : off;
	CHECK(off < 16, "a colour is off by %d", off);
	free(back);
	free(bytes);
	CHECK(jpeg_encode("p", rgb, 1, 70000, 95, &bytes, &n, &e) && strstr(e.message, "p: JPEG: "), "%s",
		e.message);
}

static void test_size(void)
{
	static const uint8_t rows[2 * 9];
	char bytes[4096];
	struct err e = {0};

	put_png(8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, rows, 9);
	size_t len = slurp(bytes, sizeof bytes);
	put_be(bytes + 16, 30000, 4);
	put_be(bytes + 20, 30000, 4);
	put_be(bytes + 29, (uint32_t)crc32(0, (const Bytef *)bytes + 12, 17), 4);
	expect_too_large("PNG", bytes, len);
	put_jpeg(JCS_GRAYSCALE, 1);
	len = slurp(bytes, sizeof bytes);
	for (size_t i = 0; i + 9 < len; i++)
		if (!memcmp(bytes + i, "\xff\xc0", 2)) {
			put_be(bytes + i + 5, 30000, 2);
			put_be(bytes + i + 7, 30000, 2);
			break;
		}
	expect_too_large("JPEG", bytes, len);
	CHECK(!picture_check_size("x", "PNG", 65536, 4096, &e) &&
			picture_check_size("x", "PNG", 65536, 4097, &e) &&
			picture_check_size("x", "PNG", 1, SIZE_MAX, &e),
		"the limit");
}

static void test_labels(void)
{
	struct err e = {0};
	int32_t *labels;
	int h, w;

	put_png(8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, (const uint8_t *)"\0\1\2\375\376\377", 3);
	expect_labels("8 bits", (const int32_t[]){0, 1, 2, 253, 254, 255});
	put_png(16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_ADAM7, (const uint8_t *)"\0\0\0\1\1\0\377\377\0\7\1\1",
		6);
	expect_labels("16 bits", (const int32_t[]){0, 1, 256, 65535, 7, 257});
	put_png(2, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, (const uint8_t *)"\x18\xe4", 1);
	expect_labels("2 bits", (const int32_t[]){0, 1, 2, 3, 2, 1});
	put_png(8, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE, (const uint8_t *)"\0\1\2\3\2\1", 3);
	expect_labels("a palette", (const int32_t[]){-1, 1, 2, 3, 2, 1});
	put_png(2, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE, (const uint8_t *)"\x18\xe4", 1);
	expect_labels("a palette of 2 bits", (const int32_t[]){-1, 1, 2, 3, 2, 1});
	put_png(8, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_INTERLACE_NONE,
		(const uint8_t *)"\5\0\6\1\7\2\10\377\11\0\12\0", 6);
	expect_labels("alpha", (const int32_t[]){-1, -1, -1, 8, -1, -1});
	put_png(8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, (const uint8_t *)"123456789123456789", 9);
	CHECK(png_read_labels(path, &labels, &h, &w, &e) && e.code == ERR_FORMAT &&
			strstr(e.message, ": PNG: has colours, not numbers of labels"),
		"%s", e.message);
}

/* Two halves, and a column between them of a value: whether that was mixed of the two. */
static void test_edges(void)
{
	enum { SIDE = 40, NONE = PNG_PAINT_NONE, MANY = PNG_PAINT_NUMBER };
	static const struct {
		uint32_t left, between, right;
		int is_number, is_mixed;
	} cases[] = {{0, 5, 10, 1, 1}, {10, 5, 0, 1, 1}, {0, 12, 10, 1, 0}, {0, 10, 10, 1, 0},
		{0, 0x0096, 0x012c, 1, 1}, {0, 0x0096, 0x012c, 0, 0}, {0x800000, 0x404000, 0x008000, 0, 1},
		{0x800000, 0x404001, 0x008000, 0, 0}, {1, 150 | MANY, 300 | MANY, 0, 1}, {0, NONE, 3, 0, 0},
		{(uint32_t)-1, 5, 10, 1, 0}};
	uint8_t counts[SIDE * SIDE] = {0};
	uint32_t values[SIDE * SIDE];
	struct err e = {0};

	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		for (size_t p = 0; p < SIDE * SIDE; p++)
			values[p] = p % SIDE < 20    ? cases[i].left
				    : p % SIDE == 20 ? cases[i].between
						     : cases[i].right;
		const int bad = png_check_edges("x", values, NULL, SIDE, SIDE, cases[i].is_number, &e);
		CHECK(!bad == !cases[i].is_mixed, "%x between %x and %x: %d", cases[i].between, cases[i].left,
			cases[i].right, bad);
		CHECK(!png_check_edges("x", values, counts, SIDE, SIDE, cases[i].is_number, &e),
			"values without a meaning");
	}
	CHECK(!strcmp(e.message,
		      "x: at 33% of its edges are values between those on either side, some of them other labels: it was a JPEG, or scaled with mixing: scale labels to the nearest pixel, and save them as PNG"),
		"%s", e.message);
}

int main(void)
{
	int fd = mkstemp(path);

	if (fd < 0)
		return 1;
	close(fd);
	test_kinds();
	test_edges();
	test_write();
	test_broken_png();
	test_jpeg();
	test_write_jpeg();
	test_size();
	test_labels();
	test_paint();
	unlink(path);
	return unit_end();
}
