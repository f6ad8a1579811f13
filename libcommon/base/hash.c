/* XXH64: four sums of 64 bits run side by side over blocks of 32 bytes and are then mixed into one; the bytes
 * that are left go into that one by eight, by four and singly. Words are little-endian, as our files are. */
#include "base/hash.h"

#include "base/half.h"

#include <string.h>

enum { LANES = 4, BLOCK = 8 * LANES };

#define PRIME1 UINT64_C(0x9e3779b185ebca87)
#define PRIME2 UINT64_C(0xc2b2ae3d27d4eb4f)
#define PRIME3 UINT64_C(0x165667b19e3779f9)
#define PRIME4 UINT64_C(0x85ebca77c2b2ae63)
#define PRIME5 UINT64_C(0x27d4eb2f165667c5)

static uint64_t rotate(uint64_t x, int by)
{
	return x << by | x >> (64 - by);
}

static uint64_t word64(const unsigned char *p)
{
	uint64_t x;

	memcpy(&x, p, sizeof x);
	return x;
}

static uint64_t word32(const unsigned char *p)
{
	uint32_t x;

	memcpy(&x, p, sizeof x);
	return x;
}

static uint64_t add_word(uint64_t sum, uint64_t word)
{
	return rotate(sum + word * PRIME2, 31) * PRIME1;
}

struct lanes {
	uint64_t sum[LANES];
};

static struct lanes begin(uint64_t seed)
{
	return (struct lanes){{seed + PRIME1 + PRIME2, seed + PRIME2, seed, seed - PRIME1}};
}

/* The blocks from p on: what is left behind them. */
static const unsigned char *add_blocks(struct lanes *l, const unsigned char *p, const unsigned char *end)
{
	struct lanes sums = *l;

	for (; end - p >= BLOCK; p += BLOCK)
		for (int k = 0; k < LANES; k++)
			sums.sum[k] = add_word(sums.sum[k], word64(p + 8 * k));
	*l = sums;
	return p;
}

static uint64_t join(const struct lanes *l)
{
	const uint64_t *sum = l->sum;
	uint64_t all = rotate(sum[0], 1) + rotate(sum[1], 7) + rotate(sum[2], 12) + rotate(sum[3], 18);

	for (int k = 0; k < LANES; k++)
		all = (all ^ add_word(0, sum[k])) * PRIME1 + PRIME4;
	return all;
}

/* Of `bytes` bytes, of which those from p on are in no block. */
static uint64_t end_hash(
	const struct lanes *l, uint64_t seed, size_t bytes, const unsigned char *p, const unsigned char *end)
{
	uint64_t hash = (bytes >= BLOCK ? join(l) : seed + PRIME5) + bytes;

	for (; end - p >= 8; p += 8)
		hash = rotate(hash ^ add_word(0, word64(p)), 27) * PRIME1 + PRIME4;
	for (; end - p >= 4; p += 4)
		hash = rotate(hash ^ word32(p) * PRIME1, 23) * PRIME2 + PRIME3;
	for (; p < end; p++)
		hash = rotate(hash ^ *p * PRIME5, 11) * PRIME1;
	hash = (hash ^ hash >> 33) * PRIME2;
	hash = (hash ^ hash >> 29) * PRIME3;
	return hash ^ hash >> 32;
}

uint64_t hash64(const void *data, size_t bytes, uint64_t seed)
{
	const unsigned char *p = data, *end = p + bytes;
	struct lanes l = begin(seed);

	p = add_blocks(&l, p, end);
	return end_hash(&l, seed, bytes, p, end);
}

uint64_t hash64_halves(const void *halves, size_t n, uint64_t seed)
{
	enum { PIECE = 2048 };
	float piece[PIECE];
	const unsigned char *p = (const unsigned char *)piece, *end = p;
	struct lanes l = begin(seed);

	for (size_t at = 0; at < n; at += PIECE) {
		const size_t count = n - at < PIECE ? n - at : PIECE;
		half_to_floats((const unsigned char *)halves + 2 * at, count, piece);
		end = (const unsigned char *)(piece + count);
		p = add_blocks(&l, (const unsigned char *)piece, end);
	}
	return end_hash(&l, seed, n * sizeof *piece, p, end);
}
