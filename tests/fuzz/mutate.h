/* Breaks an input a little, in one of several ways. */
#ifndef MUTATE_H
#define MUTATE_H

#include "base/rng.h"

#include <stddef.h>

/* data (room) holds len bytes; returns the new length. */
size_t mutate(struct rng *r, unsigned char *data, size_t len, size_t room);

#endif
