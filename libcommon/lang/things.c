#include "lang/things.h"

#include "base/embed.h"

#include <string.h>

EMBED(things, "libcommon/lang/things.tsv");
extern const unsigned char things_begin[], things_end[];

/* The end of a field, at a tab, or of a line. */
static const char *end_of(const char *p, char mark)
{
	const char *const end = (const char *)things_end, *at = memchr(p, mark, (size_t)(end - p));

	return at ? at : end;
}

/* Whether a word, or its plural ("scissors"), is among the names, which ", " separates. */
static int names(const char *p, const char *end, const char *lemma, size_t length)
{
	while (p < end) {
		const char *comma = memchr(p, ',', (size_t)(end - p));
		const char *const stop = comma ? comma : end;
		const size_t n = (size_t)(stop - p);
		if ((n == length || (n == length + 1 && p[length] == 's')) && !memcmp(p, lemma, length))
			return 1;
		p = stop + 2;
	}
	return 0;
}

void things_find(struct things_rows *to, const char *lemma)
{
	const char *const end = (const char *)things_end;
	const size_t length = strlen(lemma);
	int row = 0;

	to->n = 0;
	for (const char *p = (const char *)things_begin; p < end && to->n < THINGS_ROWS;
		p = end_of(p, '\n') + 1, row++)
		if (names(p, end_of(p, '\t'), lemma, length))
			to->row[to->n++] = row;
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
