#include "base/name.h"

#include "base/mem.h"
#include "base/utf8.h"

#include <stdint.h>
#include <stdio.h>
#include <strings.h>

#include <utf8proc.h>

static int is_control(uint32_t c)
{
	return c < 0x20 || (c >= 0x7f && c <= 0x9f);
}

static int is_dots(const char *name)
{
	return !strcmp(name, ".") || !strcmp(name, "..");
}

const char *name_fault(const char *name, enum name_kind kind, char fault[NAME_FAULT])
{
	const size_t len = strlen(name), bad = utf8_check(name, len);

	if (!len)
		return "is empty";
	if (bad < len) {
		snprintf(fault, NAME_FAULT, "is not UTF-8 at byte %zu", bad + 1);
		return fault;
	}
	for (size_t at = 0; at < len;) {
		const size_t first = at;
		if (is_control(utf8_next(name, len, &at))) {
			snprintf(fault, NAME_FAULT, "has a control character at byte %zu", first + 1);
			return fault;
		}
	}
	if (kind == NAME_VIEW && strchr(name, '/'))
		return "has a slash";
	return kind == NAME_VIEW && is_dots(name) ? "is '.' or '..'" : NULL;
}

/* Copies text with the characters of `marked`, and all that no file name may have, as %XX. */
static char *escape(const char *text, const char *marked, struct err *e)
{
	const size_t len = strlen(text);
	char *name = len < SIZE_MAX / 4 ? mem_alloc(3 * len + 1, 1, "name", e) : NULL, *to = name;

	if (!name)
		return NULL;
	for (size_t at = 0; at < len;) {
		size_t from = at;
		const uint32_t c = utf8_next(text, len, &at);
		const int is_bad = utf8_check(text + from, at - from) < at - from || is_control(c) ||
				   (c < 0x80 && strchr(marked, (int)c)) || is_dots(text);
		for (; from < at; from++)
			if (is_bad)
				to += snprintf(to, 4, "%%%02X", (unsigned)(unsigned char)text[from]);
			else
				*to++ = text[from];
	}
	*to = 0;
	return name;
}

/* utf8proc hands out a block of malloc's. */
static char *copy_form(
	const char *text, utf8proc_uint8_t *(*form)(const utf8proc_uint8_t *text), struct err *e)
{
	const char *p = text;

	while ((signed char)*p > 0)
		p++;
	char *made = *p ? (char *)form((const utf8proc_uint8_t *)text) : NULL;
	return made ? made : mem_strdup(text, e);
}

char *name_copy(const char *text, struct err *e)
{
	return copy_form(text, utf8proc_NFC, e);
}

char *name_decomposed(const char *text, struct err *e)
{
	return copy_form(text, utf8proc_NFD, e);
}

int name_is_nothing(const char *name)
{
	static const char *const nothing[] = {"background", "bg", "ignore", "ignored", "ignoreregion",
		"unlabeled", "unlabelled", "void", "dontcare"};
	char bare[16];
	size_t n = 0;

	for (; *name && n < sizeof bare - 1; name++)
		if (!strchr(" _-'", *name))
			bare[n++] = *name;
	bare[n] = 0;
	for (size_t i = 0; i < sizeof nothing / sizeof *nothing; i++)
		if (!strcasecmp(bare, nothing[i]))
			return 1;
	return 0;
}

char *name_trim(char *text)
{
	static const char blanks[] = " \t\r\n";

	utf8_plain(text);
	text += strspn(text, blanks);
	for (size_t n = strlen(text); n && strchr(blanks, text[n - 1]); n--)
		text[n - 1] = 0;
	return text;
}

char *name_to_file(const char *text, struct err *e)
{
	return escape(text, "/%", e);
}

char *name_to_view(const char *text, struct err *e)
{
	SCOPED char *composed = name_copy(text, e);
	char *name = composed ? escape(composed, ",", e) : NULL;

	for (char *p = name; p && *p; p++)
		if (*p == '/')
			*p = '_';
	return name;
}

/* A capital hexadecimal digit's value, or -1. */
static int digit_value(char digit)
{
	static const char digits[] = "0123456789ABCDEF";
	const char *at = digit ? strchr(digits, digit) : NULL;

	return at ? (int)(at - digits) : -1;
}

char *name_from_file(const char *file, struct err *e)
{
	SCOPED char *text = mem_strdup(file, e);
	char *to = text;

	for (const char *from = text; from && *from; from++) {
		const int high = *from == '%' ? digit_value(from[1]) : -1,
			  low = high >= 0 ? digit_value(from[2]) : -1;
		const int is_escaped = low >= 0 && (high || low);
		*to++ = (char)(is_escaped ? 16 * high + low : *from);
		from += 2 * is_escaped;
	}
	if (text)
		*to = 0;
	return text ? name_copy(text, e) : NULL;
}
