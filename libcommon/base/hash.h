/* A 64-bit hash for telling data apart: XXH64 (Collet, xxHash; github.com/Cyan4973/xxHash,
 * doc/xxhash_spec.md). Not for secrets. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* The hash of `bytes` bytes. Several arrays have one hash where each one's is the next one's seed. */
uint64_t hash64(const void *data, size_t bytes, uint64_t seed);
/* The hash that n half floats, at any address, have as floats. */
uint64_t hash64_halves(const void *halves, size_t n, uint64_t seed);
