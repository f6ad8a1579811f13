#include "formats/images/png_private.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/images/jpeg.h"

#include <setjmp.h>
#include <sys/stat.h>

enum {
	DEFLATE_RATIO = 1032, /* what a byte of deflate can become at most */
	APART = 64 /* colours of a mask that differ by more, in 8 bits, are not one painted over all of it */
};

int picture_check_size(const char *path, const char *kind, size_t width, size_t height, struct err *e)
{
	if (width <= PICTURE_PIXELS_MAX / (height ? height : 1))
		return 0;
	return err_file(e, path, "%s: %zux%zu pixels, more than %d altogether", kind, width, height,
		PICTURE_PIXELS_MAX);
}

int picture_check_bytes(const char *path, const char *kind, size_t width, size_t height, uint64_t least,
	FILE *in, struct err *e)
{
	struct stat st;

	if (fstat(fileno(in), &st) || !S_ISREG(st.st_mode) || least <= (uint64_t)st.st_size)
		return 0;
	return err_file(e, path, "%s: %zux%zu pixels do not fit a file of %lld bytes", kind, width, height,
		(long long)st.st_size);
}

_Noreturn void png_job_error(png_structp png, png_const_charp message)
{
	struct png_job *job = png_get_error_ptr(png);

	/* an allocation of ours or a failed write has said more already */
	if (job->e->code == ERR_NONE)
		err_file(job->e, job->path, "PNG: %s", message);
	png_longjmp(png, 1);
}

void png_job_warning(png_structp png, png_const_charp message)
{
	(void)png;
	(void)message;
}

static void read_bytes(png_structp png, png_bytep data, size_t len)
{
	struct png_job *job = png_get_error_ptr(png);
	FILE *in = png_get_io_ptr(png);

	if (fread(data, 1, len, in) == len)
		return;
	if (ferror(in))
		err_errno(job->e, "%s", job->path);
	else
		err_file(job->e, job->path, "PNG: the file ends too early");
	png_error(png, "read");
}

/* Gives the size to who reads, and what was read back: 0, or -1 where that is nothing. */
static int finish(struct png_job *job, const void *made, int *height, int *width)
{
	*height = job->height;
	*width = job->width;
	mem_free_all(job->raw, job->rows);
	return made ? 0 : -1;
}

/* Of labels, whose palette and greys are not made colours, what is transparent. */
static void take_clear(struct png_job *job)
{
	png_bytep alpha = NULL;
	png_color_16p grey = NULL;
	int n = 0;

	memset(job->palette_alpha, 255, sizeof job->palette_alpha);
	job->grey_clear = -1;
	if (!png_get_tRNS(job->png, job->info, &alpha, &n, &grey))
		return;
	if (png_get_color_type(job->png, job->info) != PNG_COLOR_TYPE_PALETTE)
		job->grey_clear = grey->gray;
	else if (alpha)
		memcpy(job->palette_alpha, alpha, (size_t)n);
}

/* Everything that may jump: nothing here owns memory that `job` does not know of. */
static int decode(struct png_job *job, FILE *in)
{
	if (setjmp(png_jmpbuf(job->png)))
		return -1;
	png_set_read_fn(job->png, in, read_bytes);
	png_set_user_limits(job->png, PNG_SIDE_MAX, PNG_SIDE_MAX);
	png_read_info(job->png, job->info);
	const size_t width = png_get_image_width(job->png, job->info),
		     height = png_get_image_height(job->png, job->info);
	const uint64_t packed = (uint64_t)png_get_rowbytes(job->png, job->info) * height / DEFLATE_RATIO;
	if (picture_check_size(job->path, "PNG", width, height, job->e) ||
		picture_check_bytes(job->path, "PNG", width, height, packed, in, job->e))
		return -1;
	const int type = png_get_color_type(job->png, job->info);
	if (job->is_labels && type != PNG_COLOR_TYPE_PALETTE && type & PNG_COLOR_MASK_COLOR)
		return err_file(job->e, job->path, "PNG: has colours, not numbers of labels");
	take_clear(job);
	if (job->is_labels)
		png_set_packing(job->png);
	else
		png_set_expand(job->png);
	if (job->is_rgb) {
		png_set_background(job->png, &(png_color_16){0}, PNG_BACKGROUND_GAMMA_SCREEN, 0, 1);
		png_set_strip_16(job->png);
	}
	png_set_interlace_handling(job->png);
	png_read_update_info(job->png, job->info);
	job->height = (int)png_get_image_height(job->png, job->info);
	job->width = (int)png_get_image_width(job->png, job->info);
	job->channels = png_get_channels(job->png, job->info);
	job->depth = png_get_bit_depth(job->png, job->info);
	job->row_bytes = png_get_rowbytes(job->png, job->info);
	job->raw = mem_alloc((size_t)job->height, job->row_bytes, job->path, job->e);
	job->rows = mem_alloc((size_t)job->height, sizeof *job->rows, job->path, job->e);
	if (!job->raw || !job->rows)
		return -1;
	for (int y = 0; y < job->height; y++)
		job->rows[y] = job->raw + (size_t)y * job->row_bytes;
	png_read_image(job->png, job->rows);
	png_read_end(job->png, NULL);
	return 0;
}

/* The whole image as 8 or 16 bit (big-endian) samples of 1 or 3 channels, and one of alpha where there is
 * some. finish() it in any case. */
static int read_raw(struct png_job *job, FILE *in)
{
	job->e->code = ERR_NONE;
	job->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, job, png_job_error, png_job_warning);
	if (job->png)
		job->info = png_create_info_struct(job->png);
	int bad = job->info ? decode(job, in) : err_set(job->e, ERR_SYSTEM, "%s: out of memory", job->path);
	png_destroy_read_struct(&job->png, &job->info, NULL);
	return bad;
}

/* Sample k of a pixel. */
static unsigned sample(const struct png_job *job, size_t pixel, int k)
{
	const size_t at = pixel % (size_t)job->width * (size_t)job->channels + (size_t)k;
	const uint8_t *row = job->rows[pixel / (size_t)job->width];

	return job->depth == 16 ? (unsigned)row[2 * at] << 8 | row[2 * at + 1] : row[at];
}

static size_t pixels_of(const struct png_job *job)
{
	return (size_t)job->height * (size_t)job->width;
}

/* The least alpha of what is not transparent: half of the largest, since soft edges and what a soft rubber
 * leaves are less, and all that is painted may be pale. 0 without alpha. */
static unsigned least_alpha(const struct png_job *job)
{
	unsigned most = 0;

	if (job->channels % 2)
		return 0;
	for (size_t i = 0, n = pixels_of(job); i < n; i++) {
		const unsigned alpha = sample(job, i, job->channels - 1);
		most = alpha > most ? alpha : most;
	}
	return most / 2 + 1;
}

static int is_clear(const struct png_job *job, size_t pixel, unsigned least)
{
	return least && sample(job, pixel, job->channels - 1) < least;
}

/* Opens where no stream is given, reads with the job's settings, and makes room for a value of so many bytes
 * for each pixel: NULL with *e, then too finish() it. */
static void *read_pixels(struct png_job *job, const char *path, FILE *given, size_t bytes)
{
	SCOPED_BY(file_release) FILE *own = given ? NULL : file_open(path, job->e);
	FILE *in = given ? given : own;

	job->path = file_name(path);
	if (!in)
		return NULL;
	const int first = getc(in);
	ungetc(first, in);
	if (first == 0xff)
		err_file(job->e, job->path,
			"a JPEG, whose colours are not quite those that were painted: save it as PNG");
	else if (!read_raw(job, in))
		return mem_zalloc(pixels_of(job), bytes, job->path, job->e);
	return NULL;
}

/* The brightest of a pixel's colours, in 8 bits. */
static unsigned brightness(const struct png_job *job, size_t pixel)
{
	unsigned most = 0;

	for (int k = 0; k < (job->channels < 3 ? 1 : 3); k++) {
		const unsigned value = sample(job, pixel, k) >> (job->depth - 8);
		most = value > most ? value : most;
	}
	return most;
}

/* What is of a mask is at least so bright: 1, or, where several values near black and near the brightest, and
 * few between, show that it was a JPEG or scaled, half of the darkest of its bright colours. */
static unsigned least_bright(const struct png_job *job)
{
	enum { BINS = 16 };
	size_t counts[256] = {0}, bins[BINS] = {0}, above = 0;
	unsigned most = job->channels < 3 ? 255 : 64, dark = 0, bright = 0, gap = 1, first;

	for (size_t i = 0, n = pixels_of(job); i < n; i++)
		counts[brightness(job, i)]++;
	for (unsigned v = most; v < 256; v++)
		most = counts[v] ? v : most;
	for (unsigned v = 1; v <= most; v++) {
		bins[BINS * v / (most + 1)] += counts[v];
		dark += counts[v] && v <= most / BINS;
		bright += counts[v] && v > most - most / 8 && v < most;
	}
	for (unsigned k = 1; k < BINS / 2; k++)
		gap = bins[k] <= bins[gap] ? k : gap;
	for (unsigned k = gap + 1; k < BINS; k++)
		above += bins[k];
	for (first = gap + 1; first < BINS && 8 * bins[first] < above;)
		first++;
	return dark < 3 || !bright || 8 * bins[gap] > above || first == BINS
		       ? 1
		       : (2 * first + 1) * (most + 1) / BINS / 4 << (job->depth - 8);
}

int png_take_mask(const char *path, FILE *in, uint8_t **pixels, int *height, int *width, struct err *e)
{
	struct png_job job = {.e = e};
	uint8_t *mask = read_pixels(&job, path, in, 1);
	const size_t n = mask ? pixels_of(&job) : 0;
	size_t marked = 0, cleared = 0;
	int differ = 0;

	if (mask) {
		const int colours = job.channels - !(job.channels % 2);
		const unsigned least = least_alpha(&job), apart = (unsigned)APART << (job.depth - 8);
		const unsigned bright = least_bright(&job);
		for (size_t i = 0; i < n; i++) {
			const int clear = is_clear(&job, i, least);
			for (int k = 0; k < colours && !clear; k++) {
				const unsigned value = sample(&job, i, k), first = sample(&job, 0, k);
				mask[i] |= value >= bright;
				differ |= value > first + apart || first > value + apart;
			}
			cleared += (size_t)clear;
			marked += mask[i];
		}
		/* black on nothing: alpha is the mask */
		for (size_t i = 0; i < n && cleared && !marked; i++)
			mask[i] = !is_clear(&job, i, least);
	}
	finish(&job, mask, height, width);
	if (differ && marked == n) {
		err_file(e, job.path,
			"no pixel is black or transparent, so that all would be of the thing: paint black what is not");
		free(mask);
		mask = NULL;
	}
	*pixels = mask;
	return mask ? 0 : -1;
}

int png_read_mask(const char *path, uint8_t **pixels, int *height, int *width, struct err *e)
{
	return png_take_mask(path, NULL, pixels, height, width, e);
}

int png_read_labels(const char *path, int32_t **labels, int *height, int *width, struct err *e)
{
	struct png_job job = {.e = e, .is_labels = 1};
	int32_t *out = read_pixels(&job, path, NULL, sizeof *out);

	if (out) {
		const unsigned least = least_alpha(&job);
		for (size_t i = 0, n = pixels_of(&job); i < n; i++) {
			const unsigned label = sample(&job, i, 0);
			const int is_none = is_clear(&job, i, least) || (int)label == job.grey_clear ||
					    (label < 256 && !job.palette_alpha[label]);
			out[i] = is_none ? -1 : (int32_t)label;
		}
	}
	finish(&job, out, height, width);
	if (out && png_check_edges(job.path, (const uint32_t *)out, NULL, *height, *width, 1, e)) {
		free(out);
		out = NULL;
	}
	*labels = out;
	return out ? 0 : -1;
}

/* Whether samples of 16 bits are 8 bits said twice, as programs write a picture of 8 bits. */
static int is_doubled(const struct png_job *job, size_t pixel, int colours)
{
	int is = 1;

	for (int k = 0; k < colours; k++)
		is = is && sample(job, pixel, k) % 257 == 0;
	return is;
}

int png_read_paint(const char *path, uint32_t **paint, int *height, int *width, struct err *e)
{
	struct png_job job = {.e = e};
	uint32_t *out = read_pixels(&job, path, NULL, sizeof *out);

	if (out) {
		const int is_wide = job.depth == 16, colours = job.channels < 3 ? 1 : 3;
		const unsigned least = least_alpha(&job), shift = is_wide ? 8 : 0;
		const size_t n = pixels_of(&job);
		int is_number = 0;
		for (size_t i = 0; i < n && is_wide && colours == 1; i++)
			is_number = is_number || !is_doubled(&job, i, 1);
		for (size_t i = 0; i < n; i++) {
			const unsigned first = sample(&job, i, 0);
			if (is_clear(&job, i, least) || (is_wide && colours == 3 && !is_doubled(&job, i, 3)))
				out[i] = PNG_PAINT_NONE;
			else if (colours == 1)
				out[i] = png_paint_number(is_number ? first : first >> shift);
			else
				out[i] = (uint32_t)(first >> shift << 16 | sample(&job, i, 1) >> shift << 8 |
						    sample(&job, i, 2) >> shift);
		}
	}
	*paint = out;
	return finish(&job, out, height, width);
}

uint32_t png_paint_number(uint32_t number)
{
	return number > 255 ? PNG_PAINT_NUMBER | number : number * 0x010101;
}

static int read_png_rgb(const char *path, FILE *in, uint8_t **rgb, int *height, int *width, struct err *e)
{
	struct png_job job = {.path = path, .e = e, .is_rgb = 1};
	uint8_t *out = NULL;

	if (!read_raw(&job, in))
		out = mem_alloc((size_t)job.height * (size_t)job.width, 3, path, e);
	if (out) {
		size_t step = (size_t)job.channels, next = step == 3;
		uint8_t *q = out;
		for (size_t y = 0; y < (size_t)job.height; y++)
			for (size_t x = 0; x < (size_t)job.width; x++, q += 3)
				for (size_t k = 0; k < 3; k++)
					q[k] = job.rows[y][x * step + k * next];
		*rgb = out;
	}
	return finish(&job, out, height, width);
}

int image_read_rgb(const char *path, uint8_t **rgb, int *height, int *width, struct err *e)
{
	const char *name = file_name(path);
	SCOPED_BY(file_release) FILE *in = file_open(path, e);

	if (!in)
		return -1;
	/* one byte tells the two apart, and one byte can be put back on a pipe */
	int first = getc(in);
	if (first != EOF)
		ungetc(first, in);
	if (first == 0x89)
		return read_png_rgb(name, in, rgb, height, width, e);
	if (first == 0xff)
		return jpeg_read_rgb(name, in, rgb, height, width, e);
	if (first != EOF)
		return err_file(e, name,
			"neither PNG nor JPEG: begins with byte 0x%02x: 'mogrify -format png' makes a PNG of most pictures",
			(unsigned)first);
	return ferror(in) ? err_errno(e, "%s", name) : err_file(e, name, "an empty file, not an image");
}
