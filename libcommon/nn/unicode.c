#include "nn/unicode.h"

static int in_ranges(uint32_t c, const struct unicode_range *ranges, size_t n)
{
	size_t low = 0, high = n;

	while (low < high) {
		size_t middle = (low + high) / 2;
		if (c > ranges[middle].last)
			low = middle + 1;
		else if (c < ranges[middle].first)
			high = middle;
		else
			return 1;
	}
	return 0;
}

int unicode_is_dropped(uint32_t c)
{
	return in_ranges(c, unicode_dropped, unicode_dropped_count);
}

int unicode_is_space(uint32_t c)
{
	return c == ' ' || (c >= 9 && c <= 13) || c == 0x85 || c == 0xa0 || c == 0x1680 ||
	       (c >= 0x2000 && c <= 0x200a) || c == 0x2028 || c == 0x2029 || c == 0x202f || c == 0x205f ||
	       c == 0x3000;
}

int unicode_is_punctuation(uint32_t c)
{
	if (c < 128)
		return (c >= 33 && c <= 47) || (c >= 58 && c <= 64) || (c >= 91 && c <= 96) ||
		       (c >= 123 && c <= 126);
	return in_ranges(c, unicode_punctuation, unicode_punctuation_count);
}

int unicode_is_ideograph(uint32_t c)
{
	static const struct unicode_range blocks[] = {{0x3400, 0x4dbf}, {0x4e00, 0x9fff}, {0xf900, 0xfaff},
		{0x20000, 0x2a6df}, {0x2a700, 0x2b73f}, {0x2b740, 0x2b81f}, {0x2b820, 0x2ceaf},
		{0x2f800, 0x2fa1f}};

	return in_ranges(c, blocks, sizeof blocks / sizeof *blocks);
}

/* A Hangul syllable is a leading consonant, a vowel and perhaps a trailing consonant, numbered
 * systematically. */
static size_t fold_hangul(uint32_t c, uint32_t out[UNICODE_FOLD_MAX])
{
	uint32_t s = c - 0xac00;

	out[0] = 0x1100 + s / 588;
	out[1] = 0x1161 + s % 588 / 28;
	out[2] = 0x11a7 + s % 28;
	return s % 28 ? 3 : 2;
}

/* The last run that begins at or before c, if c is one of its members. */
static const struct unicode_run *find_run(uint32_t c)
{
	size_t low = 0, high = unicode_runs_count;

	while (low < high) {
		size_t middle = (low + high) / 2;
		if (unicode_runs[middle].first <= c)
			low = middle + 1;
		else
			high = middle;
	}
	/* Runs of every second character interlock with their neighbours: look back over those that may reach
	 * c. */
	for (size_t i = low; i-- && c - unicode_runs[i].first <= 510;) {
		const struct unicode_run *run = &unicode_runs[i];
		uint32_t distance = c - run->first;
		if (distance % run->step == 0 && distance / run->step < run->count)
			return run;
	}
	return NULL;
}

size_t unicode_fold(uint32_t c, uint32_t out[UNICODE_FOLD_MAX])
{
	if (c < 128) {
		out[0] = c >= 'A' && c <= 'Z' ? c + 32 : c;
		return 1;
	}
	if (c >= 0xac00 && c <= 0xd7a3)
		return fold_hangul(c, out);
	if (in_ranges(c, unicode_marks, unicode_marks_count))
		return 0;
	const struct unicode_run *run = find_run(c);
	if (run) {
		out[0] = run->to + (c - run->first) / run->step * run->to_step;
		return 1;
	}
	for (size_t i = 0; i < unicode_lists_count; i++)
		if (unicode_lists[i].from == c) {
			size_t n = 0;
			while (n < UNICODE_FOLD_MAX && unicode_lists[i].to[n]) {
				out[n] = unicode_lists[i].to[n];
				n++;
			}
			return n;
		}
	out[0] = c;
	return 1;
}
