#include "formats/images/webp.h"

#include <stdint.h>
#include <webp/decode.h>
#include <webp/encode.h>

enum { LOSSLESS = 2 };

int webp_decode(struct webp *to, const char *data, size_t len, size_t pixels, const char *name,
	const char *file, struct err *e)
{
	const uint8_t *bytes = (const uint8_t *)data;
	WebPBitstreamFeatures seen;

	if (WebPGetFeatures(bytes, len, &seen) != VP8_STATUS_OK || seen.has_animation)
		return err_file(e, name, "file '%.80s' is not a WebP image", file);
	if (seen.format != LOSSLESS)
		return err_file(e, name, "image '%.80s' is not lossless, so its values are wrong", file);
	if ((size_t)seen.width * (size_t)seen.height > pixels)
		return err_file(e, name, "image '%.80s' has %dx%d pixels, more than %zu", file, seen.width,
			seen.height, pixels);
	to->rgba = WebPDecodeRGBA(bytes, len, &to->width, &to->height);
	return to->rgba ? 0 : err_file(e, name, "image '%.80s' is damaged", file);
}

void webp_free(struct webp *w)
{
	WebPFree(w->rgba);
	*w = (struct webp){0};
}

/* How hard the encoder tries, 0 to 100; 100 takes four times as long for 2% less. */
static const float effort = 60;

int webp_encode(unsigned char **bytes, size_t *length, const unsigned char *rgba, int width, int height,
	const char *name, struct err *e)
{
	WebPMemoryWriter memory;
	WebPConfig config;
	WebPPicture picture;

	WebPMemoryWriterInit(&memory);
	int is_fine = WebPConfigInit(&config) && WebPPictureInit(&picture);
	if (is_fine) {
		config.lossless = config.exact = 1;
		config.quality = effort;
		picture.use_argb = 1;
		picture.width = width;
		picture.height = height;
		picture.writer = WebPMemoryWrite;
		picture.custom_ptr = &memory;
		is_fine = WebPPictureImportRGBA(&picture, rgba, 4 * width) && WebPEncode(&config, &picture);
		WebPPictureFree(&picture);
	}
	*bytes = memory.mem;
	*length = memory.size;
	if (is_fine)
		return 0;
	WebPMemoryWriterClear(&memory);
	*bytes = NULL;
	return err_set(e, ERR_SYSTEM, "%s: an image of %dx%d cannot be encoded", name, width, height);
}

void webp_release(unsigned char *bytes)
{
	WebPFree(bytes);
}
