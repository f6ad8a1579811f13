#include "synth/truth.h"

#include "base/mem.h"

#include <stdlib.h>

enum { CHANNELS = 8 };

int synth_truth_visible(const struct synth_scene *s, const struct render_view *view, size_t pixels,
	uint8_t *masks, struct err *e)
{
	/* A few objects a pass bounds the memory at any number of objects. */
	size_t n = s->splats.n;
	float *own = mem_alloc(n, CHANNELS * sizeof *own, "object indicators", e);
	float *share = mem_alloc(pixels, CHANNELS * sizeof *share, "object shares", e);
	int bad = -1;

	if (!own || !share)
		goto done;
	for (int first = 0; first < s->object_count; first += CHANNELS) {
		int channels = s->object_count - first < CHANNELS ? s->object_count - first : CHANNELS;
		for (int c = 0; c < channels; c++)
			for (size_t i = 0; i < n; i++)
				own[(size_t)c * n + i] = s->owner[i] == first + c;
		if (render_values(view, own, channels, share, NULL, e))
			goto done;
		uint8_t *to = masks + (size_t)first * pixels;
		for (size_t p = 0; p < (size_t)channels * pixels; p++)
			to[p] = share[p] > 0.5f;
	}
	bad = 0;
done:
	free(own);
	free(share);
	return bad;
}

int synth_truth_whole(const struct synth_scene *s, const struct camera *c, uint8_t *masks, struct err *e)
{
	size_t pixels = (size_t)c->width * (size_t)c->height, most = 0;
	struct render_view *view = NULL;
	int bad = 0;

	for (int i = 0; i < s->object_count; i++)
		most = s->first[i + 1] - s->first[i] > most ? s->first[i + 1] - s->first[i] : most;
	float *ones = mem_alloc(most, sizeof *ones, "object indicators", e);
	float *share = mem_alloc(pixels, sizeof *share, "object shares", e);
	bad = !ones || !share;
	for (size_t i = 0; i < most && !bad; i++)
		ones[i] = 1;
	for (int i = 0; i < s->object_count && !bad; i++) {
		size_t from = s->first[i];
		struct splats own = {.n = s->first[i + 1] - from,
			.sh_coefficients = s->splats.sh_coefficients,
			.means = s->splats.means + 3 * from,
			.scales = s->splats.scales + 3 * from,
			.quats = s->splats.quats + 4 * from,
			.opacities = s->splats.opacities + from,
			.sh = s->splats.sh + 3 * (size_t)s->splats.sh_coefficients * from};
		if (view)
			bad = render_again(view, &own, c, e);
		else
			bad = !(view = render_prepare(&own, c, e));
		bad = bad || render_values(view, ones, 1, share, NULL, e);
		for (size_t p = 0; p < pixels && !bad; p++)
			masks[(size_t)i * pixels + p] = share[p] > 0.5f;
	}
	if (view)
		render_free(view);
	free(ones);
	free(share);
	return bad ? -1 : 0;
}
