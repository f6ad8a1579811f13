#include "base/utf8.h"

#include <utf8proc.h>

/* Bytes of the well-formed character at text[0], 0 where there is none. *c gets its value. */
static size_t decode(const char *text, size_t len, uint32_t *c)
{
	utf8proc_int32_t value;
	const utf8proc_ssize_t n =
		utf8proc_iterate((const utf8proc_uint8_t *)text, (utf8proc_ssize_t)len, &value);

	*c = (uint32_t)value;
	return n > 0 ? (size_t)n : 0;
}

uint32_t utf8_next(const char *text, size_t len, size_t *at)
{
	uint32_t c;
	const size_t n = decode(text + *at, len - *at, &c);

	*at += n ? n : 1;
	return n ? c : 0xfffd;
}

size_t utf8_put(char *out, uint32_t c)
{
	return (size_t)utf8proc_encode_char((utf8proc_int32_t)c, (utf8proc_uint8_t *)out);
}

size_t utf8_check(const char *text, size_t len)
{
	size_t at = 0;
	uint32_t c;

	while (at < len) {
		const size_t n = decode(text + at, len - at, &c);
		if (!n)
			return at;
		at += n;
	}
	return len;
}
