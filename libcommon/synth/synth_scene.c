#include "synth/synth_scene.h"

#include "base/mem.h"
#include "synth/cameras.h"

int synth_scene_make(struct synth_scene *s, const struct synth_options *o, struct err *e)
{
	*s = (struct synth_scene){.preset = o->preset, .is_moving = o->times > 0, .object_count = o->objects};
	s->objects = mem_zalloc((size_t)o->objects, sizeof *s->objects, "objects", e);
	s->owner = mem_alloc(o->gaussians, sizeof *s->owner, "owners", e);
	if (!s->objects || !s->owner || splats_alloc(&s->splats, o->gaussians, SYNTH_SH_COEFFICIENTS, e))
		goto fail;
	synth_arrange(s->objects, o->objects, &s->table, o->preset, o->seed);
	if (!synth_cameras_make(&s->cameras, o, &s->table, e) &&
		!synth_cameras_check(&s->cameras, s->objects, o->objects, e) &&
		!synth_cameras_hide(&s->cameras, o, s->objects, &s->table, e) &&
		!synth_gaussians_make(s, o->seed, e))
		return 0;
fail:
	synth_scene_free(s);
	return -1;
}

void synth_scene_free(struct synth_scene *s)
{
	splats_free(&s->splats);
	cameras_free(&s->cameras);
	mem_free_all(s->objects, s->owner);
	*s = (struct synth_scene){0};
}

enum { CHANNELS = 8 };

int synth_truth_visible(const struct synth_scene *s, const struct render_view *view, size_t pixels,
	uint8_t *masks, struct err *e)
{
	/* A few objects a pass bounds the memory at any number of objects. */
	size_t n = s->splats.n;
	SCOPED float *own = mem_alloc(n, CHANNELS * sizeof *own, "object indicators", e);
	SCOPED float *share = mem_alloc(pixels, CHANNELS * sizeof *share, "object shares", e);

	if (!own || !share)
		return -1;
	for (int first = 0; first < s->object_count; first += CHANNELS) {
		int channels = s->object_count - first < CHANNELS ? s->object_count - first : CHANNELS;
		for (int c = 0; c < channels; c++)
			for (size_t i = 0; i < n; i++)
				own[(size_t)c * n + i] = s->owner[i] == first + c;
		if (render_values(view, own, channels, share, NULL, e))
			return -1;
		uint8_t *to = masks + (size_t)first * pixels;
		for (size_t p = 0; p < (size_t)channels * pixels; p++)
			to[p] = share[p] > 0.5f;
	}
	return 0;
}

/* One object's own Gaussians, alone. ones: as many as it has. */
static int see_alone(const struct synth_scene *s, int object, const struct camera *c, const float *ones,
	uint8_t *mask, struct err *e)
{
	size_t pixels = (size_t)c->width * (size_t)c->height, from = s->first[object];
	const struct splats *all = &s->splats;
	struct splats own = {.n = s->first[object + 1] - from,
		.sh_coefficients = all->sh_coefficients,
		.near = all->near,
		.means = all->means + 3 * from,
		.scales = all->scales + 3 * from,
		.quats = all->quats + 4 * from,
		.opacities = all->opacities + from,
		.sh = all->sh + 3 * (size_t)all->sh_coefficients * from};
	SCOPED float *share = mem_alloc(pixels, sizeof *share, "object shares", e);
	SCOPED_BY(render_release) struct render_view *view = share ? render_prepare(&own, c, e) : NULL;
	int bad = !view || render_values(view, ones, 1, share, NULL, e) ? -1 : 0;

	for (size_t p = 0; p < pixels && !bad; p++)
		mask[p] = share[p] > 0.5f;
	return bad;
}

int synth_truth_whole(const struct synth_scene *s, const struct camera *c, uint8_t *masks, struct err *e)
{
	size_t pixels = (size_t)c->width * (size_t)c->height;
	SCOPED float *ones = mem_alloc(s->splats.n, sizeof *ones, "object indicators", e);
	int failed = 0;

	if (!ones)
		return -1;
	for (size_t i = 0; i < s->splats.n; i++)
		ones[i] = 1;
		/* An object is little work: one each for the threads, not one for all of them. */
#pragma omp parallel for schedule(dynamic) reduction(| : failed)
	for (int i = 0; i < s->object_count; i++) {
		struct err own = {0};
		if (see_alone(s, i, c, ones, masks + (size_t)i * pixels, &own)) {
			failed |= 1;
#pragma omp critical
			*e = own;
		}
	}
	return failed ? -1 : 0;
}
