#include "mask/bits.h"

#include "base/ones.h"

#include <string.h>

size_t bits_bytes(size_t n)
{
	return n / 8 + (n % 8 != 0);
}

void bits_pack(const uint8_t *mask, size_t n, uint8_t *bits)
{
	size_t p = 0;

	/* Byte i of a little-endian word, 0 or 1, times 2^(56-7i) is bit i of the highest byte, and no two of
	 * the 64 products meet elsewhere, so that nothing carries into it. */
	for (; p + 8 <= n; p += 8) {
		uint64_t eight;
		memcpy(&eight, mask + p, 8);
		bits[p / 8] = (uint8_t)(eight * 0x0102040810204080 >> 56);
	}
	if (p < n)
		bits[p / 8] = 0;
	for (; p < n; p++)
		bits[p / 8] |= (uint8_t)(mask[p] << p % 8);
}

void bits_expand(const uint8_t *bits, size_t from, size_t to, uint8_t *mask)
{
	for (size_t p = from; p < to; p++)
		mask[p - from] = bits[p / 8] >> p % 8 & 1;
}

size_t bits_common(const uint8_t *a, const uint8_t *b, size_t bytes)
{
	size_t n = 0, at = 0;

	for (; at + 8 <= bytes; at += 8) {
		uint64_t x, y;
		memcpy(&x, a + at, 8);
		memcpy(&y, b + at, 8);
		n += ones(x & y);
	}
	for (; at < bytes; at++)
		n += (size_t)__builtin_popcount(a[at] & b[at]);
	return n;
}

static size_t tiles_along(int pixels)
{
	return ((size_t)pixels + BITS_TILE - 1) / BITS_TILE;
}

size_t bits_tiles(int height, int width)
{
	return tiles_along(height) * tiles_along(width);
}

void bits_pack_tiles(const uint8_t *mask, int height, int width, uint64_t *tiles)
{
	const size_t across = tiles_along(width);

	memset(tiles, 0, bits_tiles(height, width) * sizeof *tiles);
	for (int y = 0; y < height; y++) {
		uint64_t *row = tiles + (size_t)(y / BITS_TILE) * across;
		for (size_t t = 0; t < across; t++) {
			const size_t left = (size_t)width - t * BITS_TILE;
			uint8_t eight = 0;
			bits_pack(mask + (size_t)y * (size_t)width + t * BITS_TILE,
				left < BITS_TILE ? left : BITS_TILE, &eight);
			row[t] |= (uint64_t)eight << y % BITS_TILE * BITS_TILE;
		}
	}
}

void bits_add_tiles(const uint64_t *tiles, int height, int width, float *image)
{
	const size_t across = tiles_along(width);

	for (size_t t = 0; t < bits_tiles(height, width); t++) {
		float *corner = image + t / across * BITS_TILE * (size_t)width + t % across * BITS_TILE;
		for (uint64_t left = tiles[t]; left; left &= left - 1) {
			const size_t i = (size_t)__builtin_ctzll(left);
			corner[i / BITS_TILE * (size_t)width + i % BITS_TILE]++;
		}
	}
}
