/* Writing .sog: numbers as pixels of lossless WebP images, in a plain zip (formats/splats/sog.md). */
#include "base/compare.h"
#include "base/mem.h"
#include "formats/arrays/archive.h"
#include "formats/images/webp.h"
#include "formats/splats/sog.h"
#include "splat/palette.h"

#include <math.h>

/* Images are as wide as high, about, in blocks of so many pixels. */
enum { BLOCK = 4, PALETTE_ROW = 64, PALETTE_MOST = 65536, PALETTE_STEP = 1024 };
enum { SIDE = WEBP_SIDE_MOST / BLOCK * BLOCK, GAUSSIANS_MOST = SIDE * SIDE };

struct writing {
	const struct splats *s;
	const double *offset;
	const char *name;
	size_t *order; /* (n) which Gaussian each pixel is */
	int width, height;
	unsigned char *rgba; /* (height, width, 4) the image at hand */
	double low[3], high[3];
	double scales[PALETTE_CODES], colours[PALETTE_CODES], sh[PALETTE_CODES];
	size_t palette;
	struct zip_write zip;
};

static double log_of(const struct splats *s, const double offset[3], size_t i, int k)
{
	const double x = (double)s->means[3 * i + (size_t)k] + offset[k];

	return copysign(log1p(fabs(x)), x);
}

void sog_bounds(double low[3], double high[3], const struct splats *s, const double offset[3])
{
	for (size_t i = 0; i < s->n; i++)
		for (int k = 0; k < 3; k++) {
			const double v = log_of(s, offset, i, k);
			low[k] = i ? fmin(low[k], v) : v;
			high[k] = i ? fmax(high[k], v) : v;
		}
}

static unsigned mean_code(const struct writing *w, size_t i, int k)
{
	const double length = w->high[k] - w->low[k];

	return length > 0 ? (unsigned)lrint(65535 * (log_of(w->s, w->offset, i, k) - w->low[k]) / length) : 0;
}

/* Gaussians along a curve that fills space (Morton's), so that neighbours in the image are alike. */
static int find_order(struct writing *w, struct err *e)
{
	const size_t n = w->s->n;
	SCOPED struct ranked *places = mem_alloc(n, sizeof *places, w->name, e);

	w->order = mem_alloc(n, sizeof *w->order, w->name, e);
	if (!places || !w->order)
		return -1;
	for (size_t i = 0; i < n; i++) {
		uint64_t code = 0; /* of 48 bits, which a double has */
		for (int bit = 15; bit >= 0; bit--)
			for (int k = 0; k < 3; k++)
				code = code << 1 | (mean_code(w, i, k) >> bit & 1);
		places[i] = (struct ranked){(double)code, i};
	}
	qsort(places, n, sizeof *places, ranked_rising);
	for (size_t i = 0; i < n; i++)
		w->order[i] = places[i].at;
	return 0;
}

/* Pixels are opaque until they are filled. */
static int start_image(struct writing *w, int width, int height, struct err *e)
{
	const size_t pixels = (size_t)width * (size_t)height;

	free(w->rgba);
	w->width = width;
	w->height = height;
	w->rgba = mem_zalloc(pixels, 4, w->name, e);
	for (size_t i = 0; w->rgba && i < pixels; i++)
		w->rgba[4 * i + 3] = 255;
	return w->rgba ? 0 : -1;
}

static int end_image(struct writing *w, const char *file, struct err *e)
{
	unsigned char *bytes;
	size_t length;

	if (webp_encode(&bytes, &length, w->rgba, w->width, w->height, w->name, e))
		return -1;
	const int bad = zip_write_file(&w->zip, file, bytes, length, e);
	webp_release(bytes);
	return bad;
}

/* An image of all Gaussians: put fills each one's pixel. */
static int write_image(struct writing *w, const char *file,
	void (*put)(const struct writing *w, size_t i, unsigned char *pixel), struct err *e)
{
	int width = BLOCK * (int)ceil(sqrt((double)w->s->n) / BLOCK);
	width = width ? width : BLOCK;
	const size_t rows = (w->s->n + (size_t)width - 1) / (size_t)width;

	if (start_image(w, width, rows ? BLOCK * (int)((rows + BLOCK - 1) / BLOCK) : BLOCK, e))
		return -1;
	for (size_t i = 0; i < w->s->n; i++)
		put(w, w->order[i], w->rgba + 4 * i);
	return end_image(w, file, e);
}

static void put_mean_low(const struct writing *w, size_t i, unsigned char *pixel)
{
	for (int k = 0; k < 3; k++)
		pixel[k] = (unsigned char)(mean_code(w, i, k) & 255);
}

static void put_mean_high(const struct writing *w, size_t i, unsigned char *pixel)
{
	for (int k = 0; k < 3; k++)
		pixel[k] = (unsigned char)(mean_code(w, i, k) >> 8);
}

static void put_quat(const struct writing *w, size_t i, unsigned char *pixel)
{
	const float *q = w->s->quats + 4 * i;
	double length = 0;
	int largest = 0;

	for (int k = 0; k < 4; k++) {
		length += (double)q[k] * q[k];
		largest = fabsf(q[k]) > fabsf(q[largest]) ? k : largest;
	}
	length = q[largest] < 0 ? -sqrt(length) : sqrt(length);
	pixel[3] = (unsigned char)(252 + largest);
	for (int k = 0; k < 4; k++)
		if (k != largest)
			*pixel++ = (unsigned char)lrint(255 * (q[k] / length * sqrt(2) + 1) / 2);
}

static double log_scale(const struct splats *s, size_t i, int k)
{
	return log(fmax((double)s->scales[3 * i + (size_t)k], 0x1p-149));
}

static void put_scale(const struct writing *w, size_t i, unsigned char *pixel)
{
	for (int k = 0; k < 3; k++)
		pixel[k] = (unsigned char)palette_code(w->scales, log_scale(w->s, i, k));
}

static const float *sh_of(const struct writing *w, size_t i)
{
	return w->s->sh + 3 * (size_t)w->s->sh_coefficients * i;
}

static void put_colour(const struct writing *w, size_t i, unsigned char *pixel)
{
	for (int k = 0; k < 3; k++)
		pixel[k] = (unsigned char)palette_code(w->colours, (double)sh_of(w, i)[k]);
	pixel[3] = (unsigned char)lrint(255 * (double)w->s->opacities[i]);
}

/* Codebooks of scales and colours. */
static int make_codebooks(struct writing *w, struct err *e)
{
	const size_t n = w->s->n;
	SCOPED float *values = mem_alloc(n, 3 * sizeof *values, w->name, e);
	int bad = !values;

	for (size_t i = 0; i < 3 * n && !bad; i++)
		values[i] = (float)log_scale(w->s, i / 3, (int)(i % 3));
	bad = bad || palette_codebook(w->scales, values, 3 * n, e);
	for (size_t i = 0; i < 3 * n && !bad; i++)
		values[i] = sh_of(w, i / 3)[i % 3];
	return bad || palette_codebook(w->colours, values, 3 * n, e);
}

static int write_labels(struct writing *w, const uint16_t *labels, struct err *e)
{
	const int width = w->width, height = w->height;

	if (start_image(w, width, height, e))
		return -1;
	for (size_t i = 0; i < w->s->n; i++) {
		w->rgba[4 * i] = (unsigned char)(labels[w->order[i]] & 255);
		w->rgba[4 * i + 1] = (unsigned char)(labels[w->order[i]] >> 8);
	}
	return end_image(w, "shN_labels.webp", e);
}

static int write_centres(struct writing *w, const float *centres, struct err *e)
{
	const size_t per = (size_t)w->s->sh_coefficients - 1;

	if (palette_codebook(w->sh, centres, 3 * per * w->palette, e) ||
		start_image(
			w, PALETTE_ROW * (int)per, (int)((w->palette + PALETTE_ROW - 1) / PALETTE_ROW), e))
		return -1;
	for (size_t k = 0; k < per * w->palette; k++)
		for (int c = 0; c < 3; c++)
			w->rgba[4 * k + (size_t)c] =
				(unsigned char)palette_code(w->sh, (double)centres[3 * k + (size_t)c]);
	return end_image(w, "shN_centroids.webp", e);
}

/* As many entries as there are steps of Gaussians, in powers of two. */
static size_t palette_size(size_t n)
{
	size_t most = PALETTE_STEP;

	while (most < PALETTE_MOST && 2 * most <= n)
		most *= 2;
	return most < n ? most : n;
}

static int write_harmonics(struct writing *w, struct err *e)
{
	const size_t n = w->s->n, width = 3 * ((size_t)w->s->sh_coefficients - 1), most = palette_size(n);
	SCOPED float *rows = mem_alloc(n, width * sizeof *rows, w->name, e),
		     *centres = rows ? mem_alloc(most, width * sizeof *centres, w->name, e) : NULL;
	SCOPED uint16_t *labels = centres ? mem_alloc(n, sizeof *labels, w->name, e) : NULL;
	int bad = !labels;

	for (size_t i = 0; i < n && !bad; i++)
		memcpy(rows + i * width, sh_of(w, i) + 3, width * sizeof *rows);
	return bad || palette_rows(centres, &w->palette, labels, rows, n, width, most, e) ||
	       write_labels(w, labels, e) || write_centres(w, centres, e);
}

static void print_numbers(FILE *out, const char *key, const double *x, int n)
{
	fprintf(out, "\"%s\":[", key);
	for (int k = 0; k < n; k++)
		fprintf(out, "%s%.17g", k ? "," : "", x[k]);
	fputs("],", out);
}

static void print_meta(FILE *out, const struct writing *w)
{
	fprintf(out, "{\"version\":2,\"asset\":{\"generator\":\"refersplat\"},\"count\":%zu,\"means\":{",
		w->s->n);
	print_numbers(out, "mins", w->low, 3);
	print_numbers(out, "maxs", w->high, 3);
	fputs("\"files\":[\"means_l.webp\",\"means_u.webp\"]},\"scales\":{", out);
	print_numbers(out, "codebook", w->scales, PALETTE_CODES);
	fputs("\"files\":[\"scales.webp\"]},\"quats\":{\"files\":[\"quats.webp\"]},\"sh0\":{", out);
	print_numbers(out, "codebook", w->colours, PALETTE_CODES);
	fputs("\"files\":[\"sh0.webp\"]}", out);
	if (w->palette) {
		fprintf(out, ",\"shN\":{\"count\":%zu,\"bands\":%d,", w->palette,
			w->s->sh_coefficients == 4   ? 1
			: w->s->sh_coefficients == 9 ? 2
						     : 3);
		print_numbers(out, "codebook", w->sh, PALETTE_CODES);
		fputs("\"files\":[\"shN_centroids.webp\",\"shN_labels.webp\"]}", out);
	}
	fputs("}", out);
}

static int write_meta(struct writing *w, struct err *e)
{
	SCOPED char *text = NULL;
	size_t length;
	FILE *out = open_memstream(&text, &length);

	if (out)
		print_meta(out, w);
	text = mem_text_end(out, &text, 0, w->name, e);
	return text ? zip_write_file(&w->zip, "meta.json", text, length, e) : -1;
}

static int write_all(struct writing *w, struct err *e)
{
	sog_bounds(w->low, w->high, w->s, w->offset);
	return -(find_order(w, e) || make_codebooks(w, e) ||
		 write_image(w, "means_l.webp", put_mean_low, e) ||
		 write_image(w, "means_u.webp", put_mean_high, e) ||
		 write_image(w, "scales.webp", put_scale, e) || write_image(w, "quats.webp", put_quat, e) ||
		 write_image(w, "sh0.webp", put_colour, e) ||
		 (w->s->n && w->s->sh_coefficients > 1 && write_harmonics(w, e)) || write_meta(w, e) ||
		 zip_write_end(&w->zip, e));
}

int sog_write(const struct splats *s, const double offset[3], const char *path, struct err *e)
{
	struct writing w = {.s = s, .offset = offset, .name = file_name(path)};
	struct file_out out;

	if (s->n > (size_t)GAUSSIANS_MOST)
		return err_file(e, w.name, "%zu Gaussians do not fit the images of a .sog", s->n);
	if (file_out_open(&out, path, e))
		return -1;
	zip_write_start(&w.zip, out.stream, w.name);
	const int bad = write_all(&w, e);
	mem_free_all(w.order, w.rgba);
	return file_out_end(&out, bad, e);
}
