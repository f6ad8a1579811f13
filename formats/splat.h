/* .splat: Gaussians as web viewers take them, 32 bytes each. formats/splat.md. */
#ifndef FORMATS_SPLAT_H
#define FORMATS_SPLAT_H

#include "base/err.h"
#include "splat/splats.h"

#include <stddef.h>

enum { SPLAT_BYTES = 32 };

/* One Gaussian as the file has it. */
void splat_pack(unsigned char bytes[SPLAT_BYTES], const struct splats *s, size_t i);

/* Writes the Gaussians, those that cover the most first. "-" is stdout. */
int splat_write(const struct splats *s, const char *path, struct err *e);

#endif
