#include "nn/unicode.h"

#include "base/mem.h"
#include "base/utf8.h"

#include <utf8proc.h>

static utf8proc_category_t category(uint32_t c)
{
	return utf8proc_category((utf8proc_int32_t)c);
}

int unicode_is_dropped(uint32_t c)
{
	if (c == '\t' || c == '\n' || c == '\r' || c == 0xfffd)
		return c == 0xfffd;
	const utf8proc_category_t is = category(c);
	return is == UTF8PROC_CATEGORY_CC || is == UTF8PROC_CATEGORY_CF || is == UTF8PROC_CATEGORY_CO;
}

int unicode_is_space(uint32_t c)
{
	return (c >= 9 && c <= 13) || c == 0x85 || c == 0x2028 || c == 0x2029 ||
	       category(c) == UTF8PROC_CATEGORY_ZS;
}

int unicode_is_punctuation(uint32_t c)
{
	if (c < 128)
		return (c >= 33 && c <= 47) || (c >= 58 && c <= 64) || (c >= 91 && c <= 96) ||
		       (c >= 123 && c <= 126);
	const utf8proc_category_t is = category(c);
	return is >= UTF8PROC_CATEGORY_PC && is <= UTF8PROC_CATEGORY_PO;
}

int unicode_is_ideograph(uint32_t c)
{
	static const uint32_t blocks[][2] = {{0x3400, 0x4dbf}, {0x4e00, 0x9fff}, {0xf900, 0xfaff},
		{0x20000, 0x2a6df}, {0x2a700, 0x2b73f}, {0x2b740, 0x2b81f}, {0x2b820, 0x2ceaf},
		{0x2f800, 0x2fa1f}};

	for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
		if (c >= blocks[i][0] && c <= blocks[i][1])
			return 1;
	return 0;
}

size_t unicode_fold(uint32_t c, uint32_t out[UNICODE_FOLD_MAX])
{
	utf8proc_int32_t parts[UNICODE_FOLD_MAX];
	size_t kept = 0;

	if (c < 128) {
		out[0] = c >= 'A' && c <= 'Z' ? c + 32 : c;
		return 1;
	}
	/* without UTF8PROC_COMPAT the decomposition is the canonical one */
	const utf8proc_ssize_t n = utf8proc_decompose_char(
		(utf8proc_int32_t)c, parts, UNICODE_FOLD_MAX, UTF8PROC_DECOMPOSE, NULL);
	for (utf8proc_ssize_t i = 0; i < n && i < UNICODE_FOLD_MAX; i++)
		if (category((uint32_t)parts[i]) != UTF8PROC_CATEGORY_MN)
			out[kept++] = (uint32_t)utf8proc_tolower(parts[i]);
	return kept;
}

int unicode_is_letter(uint32_t c)
{
	const utf8proc_category_t is = category(c);

	return is >= UTF8PROC_CATEGORY_LU && is <= UTF8PROC_CATEGORY_LO;
}

int unicode_is_number(uint32_t c)
{
	const utf8proc_category_t is = category(c);

	return is >= UTF8PROC_CATEGORY_ND && is <= UTF8PROC_CATEGORY_NO;
}

size_t unicode_lower(uint32_t c, uint32_t out[2])
{
	if (c == 0x130) { /* the only one that becomes two: a dotted capital I */
		out[0] = 'i';
		out[1] = 0x307;
		return 2;
	}
	out[0] = (uint32_t)utf8proc_tolower((utf8proc_int32_t)c);
	return 1;
}

char *unicode_compose(const char *text, size_t *length, struct err *e)
{
	const size_t len = strlen(text);
	size_t at = 0, kept = 0;
	utf8proc_uint8_t *out = NULL;
	SCOPED char *well = mem_alloc(len + 1, 1, "text", e);

	while (well && at < len) {
		const size_t begin = at;
		const uint32_t c = utf8_next(text, len, &at);
		if (c != 0xfffd || at - begin == 3)
			kept += utf8_put(well + kept, c);
	}
	const utf8proc_ssize_t n = well ? utf8proc_map((const utf8proc_uint8_t *)well, (utf8proc_ssize_t)kept,
						  &out, UTF8PROC_STABLE | UTF8PROC_COMPOSE)
					: 0;
	if (well && n < 0)
		err_set(e, ERR_SYSTEM, "text: %s", utf8proc_errmsg(n));
	*length = n > 0 ? (size_t)n : 0;
	return n < 0 ? NULL : (char *)out;
}
