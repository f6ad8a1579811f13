#include "unit.h"

#include "base/rng.h"
#include "mask/bits.h"

enum { N = 300 };

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
		float image[N + 1] = {0};
		size_t both = 0;
		for (size_t p = 0; p < n; p++) {
			other[p] = (uint8_t)rng_below(&r, 2);
			both += other[p] && mask[p];
		}
		bits_pack(mask, n, bits);
		bits_pack(other, n, twin);
		wrong += bits_common(bits, twin, bits_bytes(n)) != both;
		bits_place(twin, n, image);
		for (size_t p = 0; p <= N; p++)
			over += image[p] != (float)(p < n && other[p]);
	}
	CHECK(!wrong, "%d counts of common bits are wrong", wrong);
	CHECK(!over, "%d pixels are wrong", over);
	return unit_end();
}
