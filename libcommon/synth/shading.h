/* What colour things have, and what the lamp makes of it. Colours are sRGB in [0,1]. */
#pragma once

#include "synth/noise.h"
#include "synth/synth_scene.h"

/* The colour before the lamp's light, but with the shadows of objects, of a spot of the surface of object
 * `owner`, or (-1) of the table or the room; p: the spot's place in the world. */
void synth_albedo(const struct synth_scene *s, const struct synth_noise *texture, int owner, int is_table,
	const struct synth_spot *spot, const double p[3], double rgb[3]);

/* How bright the lamp makes a surface. */
double synth_shade(const double normal[3]);

/* Spherical harmonics of degree 1 (4,3): `rgb` on average, brighter by up to `gloss` seen from where the lamp
 * is mirrored. */
void synth_harmonics(float *sh, const double rgb[3], const double normal[3], double gloss);
