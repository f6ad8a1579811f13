#include "mutate.h"

#include <stdint.h>
#include <string.h>

/* Bytes that matter to some format. */
static const char *const words[] = {"\"", "{", "}", "[", "]", ",", ":", "-", ".", "e9", "null", "true",
	"\\u0000", "\n", "\xff", "\x80", "0", "1", "99999999999999999999", "4294967295", "-1", "1e308", "nan",
	"{}", "[]", "\"\"", " ", "[[[[[[[["};

size_t mutate(struct rng *r, unsigned char *data, size_t len, size_t room)
{
	size_t at = len ? rng_below(r, (uint32_t)len) : 0, count;
	const char *word;

	switch (rng_below(r, 7)) {
	case 0: /* another byte */
		if (len)
			data[at] = (unsigned char)rng_u32(r);
		return len;
	case 1: /* one bit */
		if (len)
			data[at] ^= (unsigned char)(1u << rng_below(r, 8));
		return len;
	case 2: /* cut off the end */
		return at;
	case 3: /* leave some out */
		count = rng_below(r, 1 + (uint32_t)(len - at < 16 ? len - at : 16));
		memmove(data + at, data + at + count, len - at - count);
		return len - count;
	case 4: /* say some twice */
		count = rng_below(r, 1 + (uint32_t)(len - at < 64 ? len - at : 64));
		if (len + count > room)
			return len;
		memmove(data + at + count, data + at, len - at);
		return len + count;
	case 5: /* a word over what is there */
		word = words[rng_below(r, sizeof words / sizeof *words)];
		count = strlen(word);
		if (at + count <= len)
			memcpy(data + at, word, count);
		return len;
	default: /* a word between */
		word = words[rng_below(r, sizeof words / sizeof *words)];
		count = strlen(word);
		if (len + count > room)
			return len;
		memmove(data + at + count, data + at, len - at);
		memcpy(data + at, word, count);
		return len + count;
	}
}
