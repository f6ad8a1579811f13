#include "formats/png.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/jpeg.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_SIDE = 65536, DEFLATE_RATIO = 1032 /* what a byte of deflate can become at most */ };

/* What libpng reports, and what must be released when it jumps out. */
struct png_job {
	const char *path;
	struct err *e;
	png_structp png;
	png_infop info;
	uint8_t *raw;
	png_bytep *rows;
	size_t row_bytes;
	int height, width, channels, depth;
	int is_8bit;   /* 16 bit samples are read as their high byte */
	int is_labels; /* a palette's numbers are kept, and colours are an error */
};

int picture_check_size(const char *path, const char *kind, size_t width, size_t height, struct err *e)
{
	if (width <= PICTURE_PIXELS_MAX / (height ? height : 1))
		return 0;
	return err_set(e, ERR_FORMAT, "%s: %s: %zux%zu pixels, more than %d altogether", path, kind, width,
		height, PICTURE_PIXELS_MAX);
}

int picture_check_bytes(const char *path, const char *kind, size_t width, size_t height, uint64_t least,
	FILE *in, struct err *e)
{
	struct stat st;

	if (fstat(fileno(in), &st) || !S_ISREG(st.st_mode) || least <= (uint64_t)st.st_size)
		return 0;
	return err_set(e, ERR_FORMAT, "%s: %s: %zux%zu pixels do not fit a file of %lld bytes", path, kind,
		width, height, (long long)st.st_size);
}

static _Noreturn void on_error(png_structp png, png_const_charp message)
{
	struct png_job *job = png_get_error_ptr(png);

	/* an allocation of ours or a failed write has said more already */
	if (job->e->code == ERR_NONE)
		err_set(job->e, ERR_FORMAT, "%s: PNG: %s", job->path, message);
	png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
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
		err_set(job->e, ERR_FORMAT, "%s: PNG: the file ends too early", job->path);
	png_error(png, "read");
}

static void write_bytes(png_structp png, png_bytep data, size_t len)
{
	struct png_job *job = png_get_error_ptr(png);

	if (fwrite(data, 1, len, png_get_io_ptr(png)) == len)
		return;
	err_errno(job->e, "%s", job->path);
	png_error(png, "write");
}

static void flush_bytes(png_structp png)
{
	(void)png; /* the file is flushed as a whole when it is committed */
}

static void release(struct png_job *job)
{
	free(job->raw);
	free(job->rows);
	job->raw = NULL;
	job->rows = NULL;
}

/* Everything that may jump: nothing here owns memory that `job` does not know of. */
static int decode(struct png_job *job, FILE *in)
{
	if (setjmp(png_jmpbuf(job->png)))
		return -1;
	png_set_read_fn(job->png, in, read_bytes);
	png_set_user_limits(job->png, MAX_SIDE, MAX_SIDE);
	png_read_info(job->png, job->info);
	const size_t width = png_get_image_width(job->png, job->info),
		     height = png_get_image_height(job->png, job->info);
	const uint64_t packed = (uint64_t)png_get_rowbytes(job->png, job->info) * height / DEFLATE_RATIO;
	if (picture_check_size(job->path, "PNG", width, height, job->e) ||
		picture_check_bytes(job->path, "PNG", width, height, packed, in, job->e))
		return -1;
	const int type = png_get_color_type(job->png, job->info);
	if (job->is_labels && type != PNG_COLOR_TYPE_PALETTE && type & PNG_COLOR_MASK_COLOR)
		return err_set(job->e, ERR_FORMAT, "%s: PNG: has colours, not numbers of labels", job->path);
	if (job->is_labels)
		png_set_packing(job->png);
	else if (type == PNG_COLOR_TYPE_PALETTE)
		png_set_palette_to_rgb(job->png);
	else if (png_get_bit_depth(job->png, job->info) < 8)
		png_set_expand_gray_1_2_4_to_8(job->png);
	png_set_strip_alpha(job->png);
	if (job->is_8bit)
		png_set_strip_16(job->png);
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

/* The whole image as 8 or 16 bit (big-endian) samples of 1 or 3 channels. release() it in any case. */
static int read_raw(struct png_job *job, FILE *in)
{
	job->e->code = ERR_NONE;
	job->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, job, on_error, on_warning);
	if (job->png)
		job->info = png_create_info_struct(job->png);
	int bad = job->info ? decode(job, in) : err_set(job->e, ERR_SYSTEM, "%s: out of memory", job->path);
	png_destroy_read_struct(&job->png, &job->info, NULL);
	return bad;
}

int png_read_mask(const char *path, uint8_t **pixels, int *height, int *width, struct err *e)
{
	struct png_job job = {.path = file_name(path), .e = e};
	FILE *in = file_open(path, e);
	uint8_t *mask = NULL;

	if (!in)
		return -1;
	int bad = read_raw(&job, in);
	file_close(in);
	if (!bad)
		mask = mem_alloc((size_t)job.height, (size_t)job.width, job.path, e);
	if (mask) {
		size_t used = (size_t)job.depth / 8 * (size_t)job.channels;
		for (size_t y = 0; y < (size_t)job.height; y++)
			for (size_t x = 0; x < (size_t)job.width; x++) {
				const uint8_t *p = job.rows[y] + x * used;
				uint8_t any = 0;
				for (size_t k = 0; k < used; k++)
					any |= p[k];
				mask[y * (size_t)job.width + x] = any != 0;
			}
		*pixels = mask;
		*height = job.height;
		*width = job.width;
	}
	release(&job);
	return mask ? 0 : -1;
}

int png_read_labels(const char *path, uint16_t **labels, int *height, int *width, struct err *e)
{
	struct png_job job = {.path = file_name(path), .e = e, .is_labels = 1};
	FILE *in = file_open(path, e);
	uint16_t *out = NULL;

	if (!in)
		return -1;
	if (!read_raw(&job, in))
		out = mem_alloc((size_t)job.height * (size_t)job.width, sizeof *out, job.path, e);
	file_close(in);
	for (size_t i = 0, n = (size_t)job.height * (size_t)job.width; out && i < n; i++) {
		const uint8_t *row = job.rows[i / (size_t)job.width];
		const size_t x = i % (size_t)job.width;
		out[i] = job.depth == 16 ? (uint16_t)(row[2 * x] << 8 | row[2 * x + 1]) : row[x];
	}
	*labels = out;
	*height = job.height;
	*width = job.width;
	release(&job);
	return out ? 0 : -1;
}

static int read_png_rgb(const char *path, FILE *in, uint8_t **rgb, int *height, int *width, struct err *e)
{
	struct png_job job = {.path = path, .e = e, .is_8bit = 1};
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
		*height = job.height;
		*width = job.width;
	}
	release(&job);
	return out ? 0 : -1;
}

int image_read_rgb(const char *path, uint8_t **rgb, int *height, int *width, struct err *e)
{
	const char *name = file_name(path);
	FILE *in = file_open(path, e);
	int bad;

	if (!in)
		return -1;
	/* one byte tells the two apart, and one byte can be put back on a pipe */
	int first = getc(in);
	if (first != EOF)
		ungetc(first, in);
	if (first == 0x89)
		bad = read_png_rgb(name, in, rgb, height, width, e);
	else if (first == 0xff)
		bad = jpeg_read_rgb(name, in, rgb, height, width, e);
	else if (first != EOF)
		bad = err_set(e, ERR_FORMAT, "%s: neither PNG nor JPEG: begins with byte 0x%02x", name,
			(unsigned)first);
	else
		bad = ferror(in) ? err_errno(e, "%s", name)
				 : err_set(e, ERR_FORMAT, "%s: an empty file, not an image", name);
	file_close(in);
	return bad;
}

/* Colour pictures are for a person to look at, and many are drawn: a fifth of the time for a third more
 * bytes. */
static void set_effort(const struct png_job *job)
{
	if (job->channels != 3)
		return;
	png_set_filter(job->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
	png_set_compression_level(job->png, 1);
}

static int encode(struct png_job *job, FILE *out)
{
	int colour = job->channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY;

	if (setjmp(png_jmpbuf(job->png)))
		return -1;
	png_set_write_fn(job->png, out, write_bytes, flush_bytes);
	png_set_user_limits(job->png, MAX_SIDE, MAX_SIDE);
	png_set_IHDR(job->png, job->info, (png_uint_32)job->width, (png_uint_32)job->height, job->depth,
		colour, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
	set_effort(job);
	png_write_info(job->png, job->info);
	const uint16_t one = 1;
	if (job->depth == 16 && *(const uint8_t *)&one)
		png_set_swap(job->png); /* PNG is big-endian */
	for (int y = 0; y < job->height; y++)
		png_write_row(job->png, job->raw + (size_t)y * job->row_bytes);
	png_write_end(job->png, job->info);
	return 0;
}

static const char *out_name(const char *path)
{
	return strcmp(path, "-") ? path : "stdout";
}

static int write_raw(struct png_job *job, const char *path)
{
	struct file_out out;

	if (job->height < 1 || job->width < 1 || job->height > MAX_SIDE || job->width > MAX_SIDE)
		return err_set(
			job->e, ERR_SYSTEM, "%s: a PNG cannot be %dx%d", job->path, job->width, job->height);
	if (file_out_open(&out, path, job->e))
		return -1;
	job->e->code = ERR_NONE;
	job->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, job, on_error, on_warning);
	if (job->png)
		job->info = png_create_info_struct(job->png);
	int bad = job->info ? encode(job, out.stream)
			    : err_set(job->e, ERR_SYSTEM, "%s: out of memory", job->path);
	png_destroy_write_struct(&job->png, &job->info);
	if (bad)
		file_out_abort(&out);
	else
		bad = file_out_commit(&out, job->e);
	return bad;
}

int png_write(const char *path, const uint8_t *pixels, int height, int width, int channels, struct err *e)
{
	struct png_job job = {.path = out_name(path),
		.e = e,
		.height = height,
		.width = width,
		.channels = channels,
		.depth = 8};

	job.row_bytes = (size_t)width * (size_t)channels;
	job.raw = (uint8_t *)(size_t)pixels;
	return write_raw(&job, path);
}

int png_write16(const char *path, const uint16_t *grey, int height, int width, struct err *e)
{
	struct png_job job = {
		.path = out_name(path), .e = e, .height = height, .width = width, .channels = 1, .depth = 16};

	job.row_bytes = (size_t)width * 2;
	job.raw = (uint8_t *)(size_t)grey;
	return write_raw(&job, path);
}
