#include "base/base64.h"

#include "base/mem.h"

#include <stdint.h>

static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/* One to three bytes as four characters. */
static void put_group(char *to, const unsigned char *from, size_t n)
{
	const uint32_t bits = (uint32_t)from[0] << 16 | (n > 1 ? (uint32_t)from[1] << 8 : 0) |
			      (n > 2 ? (uint32_t)from[2] : 0);

	to[0] = digits[bits >> 18];
	to[1] = digits[bits >> 12 & 63];
	to[2] = '=';
	to[3] = '=';
	if (n > 1)
		to[2] = digits[bits >> 6 & 63];
	if (n > 2)
		to[3] = digits[bits & 63];
}

char *base64_text(const char *before, const void *bytes, size_t n, struct err *e)
{
	const unsigned char *from = bytes;
	const size_t first = strlen(before), groups = n / 3 + (n % 3 > 0);
	size_t length;
	char *text = NULL;

	if (mem_size(groups, 4, &length) || length > SIZE_MAX - first - 1)
		err_set(e, ERR_SYSTEM, "base64: %zu bytes do not fit in memory", n);
	else
		text = mem_alloc(first + length + 1, 1, "base64", e);
	if (!text)
		return NULL;
	memcpy(text, before, first);
	for (size_t g = 0; g < groups; g++)
		put_group(text + first + 4 * g, from + 3 * g, n - 3 * g);
	text[first + length] = 0;
	return text;
}

void *base64_bytes(const char *text, size_t *n, struct err *e)
{
	const size_t length = strspn(text, digits);
	unsigned char *bytes = mem_alloc(length / 4 * 3 + 3, 1, "base64", e);
	uint32_t bits = 0;

	*n = 0;
	for (size_t i = 0; i < length && bytes; i++) {
		bits = bits << 6 | (uint32_t)(strchr(digits, text[i]) - digits);
		if (i % 4) /* six bits of the first, then a byte for each */
			bytes[(*n)++] = (unsigned char)(bits >> (6 - 2 * (i % 4)));
	}
	return bytes;
}
