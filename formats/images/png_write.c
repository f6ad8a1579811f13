/* Writing of PNG. */
#include "formats/images/png_private.h"

#include "base/file.h"

#include <setjmp.h>
#include <string.h>

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
	png_set_user_limits(job->png, PNG_SIDE_MAX, PNG_SIDE_MAX);
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

	if (job->height < 1 || job->width < 1 || job->height > PNG_SIDE_MAX || job->width > PNG_SIDE_MAX)
		return err_set(
			job->e, ERR_SYSTEM, "%s: a PNG cannot be %dx%d", job->path, job->width, job->height);
	if (file_out_open(&out, path, job->e))
		return -1;
	job->e->code = ERR_NONE;
	job->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, job, png_job_error, png_job_warning);
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
