#include "lang/kinds.h"

#include "base/embed.h"

#include <stdlib.h>
#include <string.h>

EMBED(kinds, "libcommon/lang/kinds.tsv");
extern const unsigned char kinds_begin[];

/* The first line of the table behind its head. */
static const char *first_line(void)
{
	const char *p = (const char *)kinds_begin;

	while (*p == '#')
		p = strchr(p, '\n') + 1;
	return p;
}

/* In which field of nouns of a line a word is, from 1 on; 0: in none. */
static int has(const char *line, const char *word)
{
	int field = 0;

	for (const char *p = strchr(line, '\t'); *p && *p != '\n';) {
		const char *w = word;
		field += *p == '\t';
		for (p++; *w && *p != ' ' && (*w == *p || (*w == ' ' && *p == '_')); p++)
			w++;
		if (!*w && strchr(" \t\n", *p))
			return field;
		p += strcspn(p, " \t\n");
	}
	return 0;
}

static const char *next_line(const char *p)
{
	return p + strcspn(p, "\n") + 1;
}

int kinds_next(long *at, char noun[KINDS_LENGTH])
{
	const char *const p = (*at ? (const char *)kinds_begin + *at : first_line()), *from = p;

	if (!*p)
		return 0;
	if (*at == 0 || p[-1] == '\n')
		from = strchr(p, '\t') + 1;
	const size_t n = strcspn(from, " \t\n");
	memcpy(noun, from, n);
	noun[n] = 0;
	*at = from + n + 1 - (const char *)kinds_begin;
	return !n || memchr(noun, '_', n) ? kinds_next(at, noun) : 1;
}

int kinds_have(const char *lemma)
{
	for (const char *p = first_line(); *p; p = next_line(p))
		if (has(p, lemma))
			return 1;
	return 0;
}

int kinds_listed(const char *list, const char *lemma)
{
	const size_t length = strlen(list);

	for (const char *p = first_line(); *p; p = next_line(p))
		if (!strncmp(p, list, length) && p[length] == '\t' && has(p, lemma))
			return 1;
	return 0;
}

const char *kinds_has(const char *lemma, size_t *length)
{
	static const char mark[] = "has:";

	for (const char *p = first_line(); *p; p = next_line(p))
		if (!strncmp(p, mark, sizeof mark - 1) && has(p, lemma)) {
			p += sizeof mark - 1;
			*length = strcspn(p, "\t");
			return p;
		}
	return NULL;
}

void kinds_find(struct kinds_lines *to, const char *lemma)
{
	int line = 0;

	*to = (struct kinds_lines){{{0}}};
	for (const char *p = first_line(); *p && line < KINDS_LINES; p = next_line(p), line++)
		for (int f = has(p, lemma), i = 0; f && i < KINDS_FIELDS; i++)
			to->bits[i][line / 64] |= (uint64_t)(!i || i == f) << line % 64;
}

double kinds_share(const struct kinds_lines *word, const struct kinds_lines *known)
{
	uint64_t both[KINDS_LINES / 64], any = 0;
	double best = 0;
	int line = 0;

	for (int i = 0; i < KINDS_LINES / 64; i++)
		any |= both[i] = word->bits[0][i] & known->bits[1][i];
	if (!any)
		return 0;
	for (const char *p = first_line(); *p && line < KINDS_LINES; p = next_line(p), line++) {
		const double chance = both[line / 64] >> line % 64 & 1 ? strtod(p, NULL) : 0;
		best = chance > best ? chance : best;
	}
	return best;
}

int kinds_are_of(const struct kinds_lines *word, const struct kinds_lines *known)
{
	for (int i = 0; i < KINDS_LINES / 64; i++)
		if (word->bits[2][i] & known->bits[1][i])
			return 1;
	return 0;
}
