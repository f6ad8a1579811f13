#include "base/utf8.h"

/* Bytes of the well-formed character at text[0], 0 where there is none. *c gets its value. */
static size_t decode(const unsigned char *text, size_t len, uint32_t *c)
{
	static const uint32_t least[5] = {0, 0, 0x80, 0x800, 0x10000};
	unsigned char first = text[0];
	size_t n;

	if (first < 0x80) {
		*c = first;
		return 1;
	}
	if (first >= 0xf8 || first < 0xc0)
		return 0;
	n = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
	if (len < n)
		return 0;
	*c = first & (0x7fu >> n);
	for (size_t i = 1; i < n; i++) {
		if ((text[i] & 0xc0) != 0x80)
			return 0;
		*c = *c << 6 | (text[i] & 0x3f);
	}
	return *c >= least[n] && *c <= 0x10ffff && (*c < 0xd800 || *c > 0xdfff) ? n : 0;
}

uint32_t utf8_next(const char *text, size_t len, size_t *at)
{
	uint32_t c = 0xfffd;
	size_t n = decode((const unsigned char *)text + *at, len - *at, &c);

	*at += n ? n : 1;
	return n ? c : 0xfffd;
}

size_t utf8_put(char *out, uint32_t c)
{
	if (c < 0x80) {
		out[0] = (char)c;
		return 1;
	}
	size_t n = c < 0x800 ? 2 : c < 0x10000 ? 3 : 4;
	for (size_t i = n - 1; i; i--, c >>= 6)
		out[i] = (char)(0x80 | (c & 0x3f));
	out[0] = (char)((0xf00u >> n & 0xf0) | c);
	return n;
}

size_t utf8_check(const char *text, size_t len)
{
	size_t at = 0;
	uint32_t c;

	while (at < len) {
		size_t n = decode((const unsigned char *)text + at, len - at, &c);
		if (!n)
			return at;
		at += n;
	}
	return len;
}
