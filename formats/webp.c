#include "formats/webp.h"

#include <stdint.h>
#include <webp/decode.h>

enum { LOSSLESS = 2 };

int webp_decode(struct webp *to, const char *data, size_t len, size_t pixels, const char *name,
	const char *file, struct err *e)
{
	const uint8_t *bytes = (const uint8_t *)data;
	WebPBitstreamFeatures seen;

	if (WebPGetFeatures(bytes, len, &seen) != VP8_STATUS_OK || seen.has_animation)
		return err_set(e, ERR_FORMAT, "%s: file '%.80s' is not a WebP image", name, file);
	if (seen.format != LOSSLESS)
		return err_set(e, ERR_FORMAT, "%s: image '%.80s' is not lossless, so its values are wrong",
			name, file);
	if ((size_t)seen.width * (size_t)seen.height > pixels)
		return err_set(e, ERR_FORMAT, "%s: image '%.80s' has %dx%d pixels, more than %zu", name, file,
			seen.width, seen.height, pixels);
	to->rgba = WebPDecodeRGBA(bytes, len, &to->width, &to->height);
	return to->rgba ? 0 : err_set(e, ERR_FORMAT, "%s: image '%.80s' is damaged", name, file);
}

void webp_free(struct webp *w)
{
	WebPFree(w->rgba);
	*w = (struct webp){0};
}
