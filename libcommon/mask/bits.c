#include "mask/bits.h"

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
		n += (size_t)__builtin_popcountll(x & y);
	}
	for (; at < bytes; at++)
		n += (size_t)__builtin_popcount(a[at] & b[at]);
	return n;
}

void bits_place(const uint8_t *bits, size_t n, float *image)
{
	for (size_t byte = 0; byte < bits_bytes(n); byte++)
		for (unsigned left = bits[byte]; left; left &= left - 1)
			image[byte * 8 + (size_t)__builtin_ctz(left)] = 1;
}
