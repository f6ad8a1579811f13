#include "synth/synth_scene.h"

#include "base/mem.h"
#include "synth/presets.h"
#include "synth/cameras.h"

#include <stdlib.h>

int synth_scene_make(struct synth_scene *s, const struct synth_options *o, struct err *e)
{
	*s = (struct synth_scene){.preset = o->preset, .object_count = o->objects};
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
	free(s->objects);
	free(s->owner);
	splats_free(&s->splats);
	cameras_free(&s->cameras);
	*s = (struct synth_scene){0};
}
