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

/* A word in the table: its line, the number of that, and in which field of nouns it is, from 1 on. */
struct found {
	const char *line, *at;
	int number, field;
};

/* The first place of a word in the next line that has it; *f is zeroed at first. */
static int find_next(struct found *f, const char *word)
{
	char key[KINDS_LENGTH];
	size_t n = 0;

	if (!f->line)
		f->line = f->at = first_line();
	else
		f->at += strcspn(f->at, "\n");
	for (; word[n] && n + 1 < sizeof key; n++)
		key[n] = word[n] == ' ' ? '_' : word[n];
	key[n] = 0;
	while (n && !word[n] && (f->at = strstr(f->at, key))) {
		for (const char *end; (end = strchr(f->line, '\n')) && end < f->at; f->number++)
			f->line = end + 1;
		f->field = 0;
		for (const char *p = f->line; p < f->at; p++)
			f->field += *p == '\t';
		if (f->field && strchr(" \t", f->at[-1]) && strchr(" \t\n", f->at[n]))
			return 1;
		f->at++;
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
	return find_next(&(struct found){0}, lemma);
}

int kinds_listed(const char *list, const char *lemma)
{
	const size_t length = strlen(list);

	for (struct found f = {0}; find_next(&f, lemma);)
		if (!strncmp(f.line, list, length) && f.line[length] == '\t')
			return 1;
	return 0;
}

const char *kinds_has(const char *lemma, size_t *length)
{
	static const char mark[] = "has:";

	for (struct found f = {0}; find_next(&f, lemma);)
		if (!strncmp(f.line, mark, sizeof mark - 1)) {
			*length = strcspn(f.line + sizeof mark - 1, "\t");
			return f.line + sizeof mark - 1;
		}
	return NULL;
}

void kinds_find(struct kinds_lines *to, const char *lemma)
{
	*to = (struct kinds_lines){{{0}}};
	for (struct found f = {0}; find_next(&f, lemma) && f.number < KINDS_LINES;)
		for (int i = 0; i < KINDS_FIELDS; i++)
			to->bits[i][f.number / 64] |= (uint64_t)(!i || i == f.field) << f.number % 64;
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
