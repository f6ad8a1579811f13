/* Which way is up in a scene that nobody has levelled. */
#pragma once

#include "geom/camera.h"

/* The unit vector that the cameras' level axes are most nearly at right angles to: people hold a camera level
 * however much it looks down, so that its x axis says more of the vertical than its y axis does. Where the
 * cameras all look the same way, so that a whole plane is at right angles, the one nearest to the mean of the
 * cameras' own ups; without cameras, z. */
void cameras_up(const struct cameras *c, double up[3]);
