#include "unit.h"

#include "base/rng.h"
#include "mask/bits.h"

enum { N = 300 };

static void test_tiles(const uint8_t *mask, int height, int width)
{
	uint64_t tiles[10];
	float image[17 * 17 + 1] = {0};
	const size_t n = bits_tiles(height, width), across = ((size_t)width + 7) / 8;
	size_t wrong = 0, set = 0;

	tiles[n] = 5;
	bits_pack_tiles(mask, height, width, tiles);
	for (int i = 0; i < 2; i++)
		bits_add_tiles(tiles, height, width, image);
	for (int y = 0; y < height; y++)
		for (int x = 0; x < width; x++) {
			const size_t p = (size_t)(y * width + x);
			wrong += (tiles[(size_t)(y / 8) * across + (size_t)(x / 8)] >> (y % 8 * 8 + x % 8) &
					 1) != mask[p];
			wrong += image[p] != (float)(2 * mask[p]);
			set += mask[p];
		}
	wrong += image[height * width] != 0 || tiles[n] != 5;
	for (size_t t = 0; t < n; t++)
		for (uint64_t left = tiles[t]; left; left &= left - 1)
			set--;
	CHECK(!wrong && !set, "%dx%d by tiles: %zu wrong, %zd bits too few", height, width, wrong, set);
}

/* Every length to N, and every part of a mask, against one bit at a time. */
int main(void)
{
	uint8_t mask[N], bits[N / 8 + 2], part[N + 1];
	struct rng r;
	int wrong = 0, over = 0;

	rng_seed(&r, 3, 1);
	for (int p = 0; p < N; p++)
		mask[p] = (uint8_t)rng_below(&r, 2);
	for (size_t n = 0; n <= N; n++) {
		memset(bits, 0xff, sizeof bits);
		bits_pack(mask, n, bits);
		for (size_t p = 0; p < n; p++)
			wrong += (bits[p / 8] >> p % 8 & 1) != mask[p];
		for (size_t p = n; p < 8 * bits_bytes(n); p++)
			over += bits[p / 8] >> p % 8 & 1;
		over += bits[bits_bytes(n)] != 0xff;
	}
	CHECK(!wrong, "%d bits are wrong", wrong);
	CHECK(!over, "%d bits after the last pixel, or bytes after the last", over);
	for (size_t from = 0; from <= N; from += 7)
		for (size_t to = from; to <= N; to++) {
			memset(part, 9, sizeof part);
			bits_expand(bits, from, to, part);
			wrong += memcmp(part, mask + from, to - from) || part[to - from] != 9;
		}
	CHECK(!wrong, "%d parts are wrong", wrong);
	for (size_t n = 0; n <= N; n++) {
		uint8_t other[N], twin[N / 8 + 1];
		size_t both = 0;
		for (size_t p = 0; p < n; p++) {
			other[p] = (uint8_t)rng_below(&r, 2);
			both += other[p] && mask[p];
		}
		bits_pack(mask, n, bits);
		bits_pack(other, n, twin);
		wrong += bits_common(bits, twin, bits_bytes(n)) != both;
	}
	CHECK(!wrong, "%d counts of common bits are wrong", wrong);
	for (int height = 1; height <= 17; height++)
		for (int width = 1; width <= 17; width++)
			test_tiles(mask, height, width);
	return unit_end();
}
