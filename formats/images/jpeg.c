#include "formats/images/jpeg.h"

#include "base/mem.h"
#include "formats/images/png.h"

#include <setjmp.h>

#include <jpeglib.h>
#include <jerror.h>

/* Huffman codes take at least a bit for each block of 64 samples, of which one of the colours has a quarter
 * of the pixels or more: a byte for 2048. Twice that is refused; arithmetic coding knows no such limit. */
enum { PIXELS_A_BYTE = 4096 };

/* libjpeg's error manager, the place to jump to, and what was allocated by then. */
struct jpeg_job {
	struct jpeg_error_mgr manager; /* first: libjpeg hands back a pointer to it */
	jmp_buf jump;
	const char *name;
	struct err *e;
	struct jpeg_decompress_struct jpeg;
	uint8_t *rgb;
	struct jpeg_compress_struct writer;
	unsigned char *bytes; /* libjpeg's, by malloc */
	unsigned long count;
};

static _Noreturn void on_error(j_common_ptr jpeg)
{
	struct jpeg_job *job = (struct jpeg_job *)jpeg->err;
	char text[JMSG_LENGTH_MAX];

	job->manager.format_message(jpeg, text);
	enum err_code code = job->manager.msg_code == JERR_OUT_OF_MEMORY ? ERR_SYSTEM : ERR_FORMAT;
	err_set(job->e, code, "%s: JPEG: %s", job->name, text);
	longjmp(job->jump, 1);
}

/* libjpeg pads a truncated photo with grey and carries on. For us half a photo is an error. Other warnings
 * (extraneous bytes, odd markers) are common in the files of real cameras. */
static void on_message(j_common_ptr jpeg, int level)
{
	if (level < 0 && jpeg->err->msg_code == JWRN_JPEG_EOF)
		on_error(jpeg);
}

static int decode(struct jpeg_job *job, FILE *in)
{
	struct jpeg_decompress_struct *jpeg = &job->jpeg;

	if (setjmp(job->jump))
		return -1;
	jpeg_create_decompress(jpeg);
	jpeg_stdio_src(jpeg, in);
	jpeg_read_header(jpeg, TRUE);
	if (picture_check_size(job->name, "JPEG", jpeg->image_width, jpeg->image_height, job->e))
		return -1;
	const uint64_t pixels = (uint64_t)jpeg->image_width * jpeg->image_height;
	if (!jpeg->arith_code && picture_check_bytes(job->name, "JPEG", jpeg->image_width, jpeg->image_height,
					 pixels / PIXELS_A_BYTE, in, job->e))
		return -1;
	if (jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK)
		return err_file(job->e, job->name,
			"JPEG: CMYK colours are not supported ('mogrify -colorspace sRGB' converts them)");
	jpeg->out_color_space = JCS_RGB;
	jpeg->dct_method = JDCT_ISLOW;
	jpeg_start_decompress(jpeg);
	size_t stride = (size_t)jpeg->output_width * 3;
	job->rgb = mem_alloc(jpeg->output_height, stride, job->name, job->e);
	if (!job->rgb)
		return -1;
	while (jpeg->output_scanline < jpeg->output_height) {
		JSAMPROW row = job->rgb + jpeg->output_scanline * stride;
		jpeg_read_scanlines(jpeg, &row, 1);
	}
	jpeg_finish_decompress(jpeg);
	return 0;
}

int jpeg_read_rgb(const char *name, FILE *in, uint8_t **rgb, int *height, int *width, struct err *e)
{
	struct jpeg_job job = {.name = name, .e = e};

	job.jpeg.err = jpeg_std_error(&job.manager);
	job.manager.error_exit = on_error;
	job.manager.emit_message = on_message;
	int bad = decode(&job, in);
	*height = (int)job.jpeg.output_height;
	*width = (int)job.jpeg.output_width;
	jpeg_destroy_decompress(&job.jpeg);
	if (bad)
		free(job.rgb);
	else
		*rgb = job.rgb;
	return bad;
}

static int encode(struct jpeg_job *job, const uint8_t *rgb, int height, int width, int quality)
{
	struct jpeg_compress_struct *jpeg = &job->writer;

	if (setjmp(job->jump))
		return -1;
	jpeg_create_compress(jpeg);
	jpeg_mem_dest(jpeg, &job->bytes, &job->count);
	jpeg->image_width = (JDIMENSION)width;
	jpeg->image_height = (JDIMENSION)height;
	jpeg->input_components = 3;
	jpeg->in_color_space = JCS_RGB;
	jpeg_set_defaults(jpeg);
	jpeg_set_quality(jpeg, quality, TRUE);
	jpeg->dct_method = JDCT_ISLOW;
	jpeg->optimize_coding = TRUE;
	jpeg_start_compress(jpeg, TRUE);
	while (jpeg->next_scanline < jpeg->image_height) {
		JSAMPROW row = (JSAMPROW)(rgb + 3 * (size_t)width * jpeg->next_scanline);
		jpeg_write_scanlines(jpeg, &row, 1);
	}
	jpeg_finish_compress(jpeg);
	return 0;
}

int jpeg_encode(const char *name, const uint8_t *rgb, int height, int width, int quality, uint8_t **bytes,
	size_t *count, struct err *e)
{
	struct jpeg_job job = {.name = name, .e = e};

	job.writer.err = jpeg_std_error(&job.manager);
	job.manager.error_exit = on_error;
	job.manager.emit_message = on_message;
	int bad = encode(&job, rgb, height, width, quality);
	jpeg_destroy_compress(&job.writer);
	if (bad)
		free(job.bytes);
	*bytes = bad ? NULL : job.bytes;
	*count = (size_t)job.count;
	return bad;
}
