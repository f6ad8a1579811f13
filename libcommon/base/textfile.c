#include "base/textfile.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/utf8.h"

#include <stdio.h>

enum order { NARROW, LITTLE, BIG };

static enum order order_of(const char *text, size_t len)
{
	const int is_long = len >= 4;

	if (len >= 2 &&
		(!memcmp(text, "\xff\xfe", 2) || (is_long && text[0] && !text[1] && text[2] && !text[3])))
		return LITTLE;
	if (len >= 2 &&
		(!memcmp(text, "\xfe\xff", 2) || (is_long && !text[0] && text[1] && !text[2] && text[3])))
		return BIG;
	return NARROW;
}

int textfile_is_wide(const char *text, size_t len)
{
	return order_of(text, len) != NARROW;
}

static uint32_t unit_at(const char *text, size_t at, enum order order)
{
	const unsigned char *p = (const unsigned char *)text + at;

	return order == BIG ? (uint32_t)p[0] << 8 | p[1] : (uint32_t)p[1] << 8 | p[0];
}

/* The character at *at, which moves behind it; -1 where the text is cut within it. */
static int next_wide(const char *text, size_t len, size_t *at, enum order order, uint32_t *c)
{
	if (len - *at < 2)
		return -1;
	*c = unit_at(text, *at, order);
	*at += 2;
	if (*c < 0xd800 || *c > 0xdfff)
		return 0;
	const uint32_t low = *c < 0xdc00 && len - *at >= 2 ? unit_at(text, *at, order) : 0;
	if (low < 0xdc00 || low > 0xdfff)
		return -1;
	*at += 2;
	*c = 0x10000 + ((*c - 0xd800) << 10) + (low - 0xdc00);
	return 0;
}

int textfile_decode(char **text, size_t *len, const char *name, struct err *e)
{
	const enum order order = order_of(*text, *len);
	size_t at = 0, used = 0;
	uint32_t c;

	if (order == NARROW) {
		if (*len >= 3 && !memcmp(*text, "\xef\xbb\xbf", 3))
			memmove(*text, *text + 3, (*len -= 3) + 1);
		return 0;
	}
	char *out = mem_alloc(*len / 2 + 1, 3, name, e);
	if (!out)
		return -1;
	while (at < *len) {
		if (next_wide(*text, *len, &at, order, &c)) {
			free(out);
			return err_file(e, name,
				"UTF-16 that is cut within a character at offset %zu: save it as UTF-8", at);
		}
		if (c != 0xfeff)
			used += utf8_put(out + used, c);
	}
	out[used] = 0;
	free(*text);
	*text = out;
	*len = used;
	return 0;
}

int textfile_read(const char *path, char **text, size_t *len, struct err *e)
{
	if (file_read(path, text, len, e))
		return -1;
	if (!textfile_decode(text, len, file_name(path), e))
		return 0;
	free(*text);
	*text = NULL;
	return -1;
}

int textfile_note(const char *path, struct err *e)
{
	char begin[4];
	FILE *in = strcmp(path, "-") && !file_is_pipe(path) ? fopen(path, "rb") : NULL;
	const size_t used = strlen(e->message);

	if (in && textfile_is_wide(begin, fread(begin, 1, sizeof begin, in)))
		snprintf(e->message + used, sizeof e->message - used, " (read as UTF-16)");
	if (in)
		fclose(in);
	return -1;
}
