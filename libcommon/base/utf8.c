#include "base/utf8.h"

#include <stdlib.h>
#include <string.h>

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

static utf8proc_int32_t plain_form(utf8proc_int32_t c, void *unused)
{
	const utf8proc_category_t kind = utf8proc_category(c);

	(void)unused;
	if (kind == UTF8PROC_CATEGORY_ZS || kind == UTF8PROC_CATEGORY_ZL || kind == UTF8PROC_CATEGORY_ZP)
		return ' ';
	return c >= 0xff01 && c <= 0xff5e ? c - 0xfee0 : c;
}

void utf8_plain(char *text)
{
	utf8proc_uint8_t *plain = NULL;
	const utf8proc_ssize_t n = utf8proc_map_custom((utf8proc_uint8_t *)text, 0, &plain,
		UTF8PROC_NULLTERM | UTF8PROC_STABLE | UTF8PROC_COMPOSE | UTF8PROC_IGNORE, plain_form, NULL);

	if (n >= 0 && (size_t)n <= strlen(text))
		memcpy(text, plain, (size_t)n + 1);
	free(plain);
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
