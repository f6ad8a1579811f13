/* .splat: Gaussians as web viewers take them, 32 bytes each. formats/splat.md. */
#ifndef FORMATS_SPLAT_H
#define FORMATS_SPLAT_H

#include "base/err.h"
#include "splat/splats.h"

/* Writes the Gaussians, those that cover the most first. "-" is stdout. */
int splat_write(const struct splats *s, const char *path, struct err *e);

#endif
