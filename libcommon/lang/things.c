#include "lang/things.h"

#include "base/embed.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

EMBED(things, "libcommon/lang/things.tsv");
extern const unsigned char things_begin[], things_end[];

/* The end of a field, at a tab, or of a line. */
static const char *end_of(const char *p, char mark)
{
	const char *const end = (const char *)things_end, *at = memchr(p, mark, (size_t)(end - p));

	return at ? at : end;
}

/* The names of the table, sorted by bytes and then by line. */
static const struct {
	char name[THINGS_NAME];
	int row;
} named[] = {
#include "lang/things.inc"
};

static const size_t named_count = sizeof named / sizeof *named;

/* The first of the names that does not stand before this one. */
static size_t find_name(const char *name)
{
	size_t low = 0, high = named_count;

	while (low < high) {
		const size_t middle = (low + high) / 2;
		if (strcmp(named[middle].name, name) < 0)
			low = middle + 1;
		else
			high = middle;
	}
	return low;
}

/* The row of name i where it is this one. */
static int row_of(size_t i, const char *name)
{
	return i < named_count && !strcmp(named[i].name, name) ? named[i].row : INT_MAX;
}

void things_find(struct things_rows *to, const char *lemma)
{
	char plural[THINGS_NAME + 1];

	to->n = 0;
	if (snprintf(plural, sizeof plural, "%ss", lemma) >= (int)sizeof plural)
		return;
	for (size_t one = find_name(lemma), more = find_name(plural); to->n < THINGS_ROWS;) {
		const int a = row_of(one, lemma), b = row_of(more, plural);
		if (a == INT_MAX && b == INT_MAX)
			return;
		to->row[to->n++] = a < b ? a : b;
		one += a <= b;
		more += b <= a;
	}
}

int things_share(const struct things_rows *a, const struct things_rows *b)
{
	for (int i = 0; i < a->n; i++)
		for (int k = 0; k < b->n; k++)
			if (a->row[i] == b->row[k])
				return 1;
	return 0;
}

const char *things_text(int row, enum things_field field, size_t *length)
{
	const char *const end = (const char *)things_end, *p = (const char *)things_begin;

	while (row-- > 0 && p < end)
		p = end_of(p, '\n') + 1;
	if (p >= end)
		return NULL;
	for (int i = 0; i < (int)field; i++)
		p = end_of(p, '\t') + 1;
	*length = (size_t)(end_of(p, field == THINGS_HAS ? '\n' : '\t') - p);
	return p;
}

uint32_t things_hash(void)
{
	uint32_t h = 2166136261U;

	for (const unsigned char *p = things_begin; p < things_end; p++)
		h = (h ^ *p) * 16777619U;
	return h;
}
