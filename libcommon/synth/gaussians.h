/* A scene's Gaussians, alike in kind to those of a trained one: needles and flakes, many of them faint, a few
 * large, some astray. formats/scene/synth.md has the figures. */
#ifndef SYNTH_GAUSSIANS_H
#define SYNTH_GAUSSIANS_H

#include "base/err.h"
#include "synth/synth_scene.h"

/* Fills s->splats (allocated), owner and first. What there is to be seen depends on the seed alone, how fine
 * it is on the number of Gaussians. Returns 0, or -1 with *e set. */
int synth_gaussians_make(struct synth_scene *s, uint64_t seed, struct err *e);

#endif
