/* Masks at eight pixels a byte: pixel p (row-major) is bit p % 8, the lowest first, of byte p / 8. What is
 * left of the last byte is 0, so that equal masks have equal bytes. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Bytes for n pixels. */
size_t bits_bytes(size_t n);

/* mask (n) of 0 or 1. */
void bits_pack(const uint8_t *mask, size_t n, uint8_t *bits);

/* Pixels [from,to) of the bits: mask (to-from) gets 0 or 1. */
void bits_expand(const uint8_t *bits, size_t from, size_t to, uint8_t *mask);

/* How many bits two of that many bytes have in common. */
size_t bits_common(const uint8_t *a, const uint8_t *b, size_t bytes);

/* The same by tiles of 8 by 8 pixels: bit i of word t is the pixel in column i mod 8 and row i / 8 of tile t,
 * and tiles are numbered row by row. Bits beyond the picture's edge are 0. */
enum { BITS_TILE = 8 };
size_t bits_tiles(int height, int width);

/* mask (height,width) of 0 or 1; tiles (bits_tiles). */
void bits_pack_tiles(const uint8_t *mask, int height, int width, uint64_t *tiles);

/* image (height,width) += 1 where there is a bit. */
void bits_add_tiles(const uint64_t *tiles, int height, int width, float *image);
