/* A picture at another, mostly smaller, size. */
#pragma once

#include "base/err.h"

#include <stdint.h>

/* (rows,columns,3) of rgb (height,width,3): each pixel the mean over its area. free() it; NULL with *e. */
uint8_t *shrink_picture(const uint8_t *rgb, int height, int width, int rows, int columns, struct err *e);
