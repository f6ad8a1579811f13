#include "lang/spelling.h"

#include "base/hash.h"
#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/compared.h"
#include "lang/kinds.h"
#include "lang/things.h"
#include "lang/tokens.h"
#include "lang/wordnet.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

int spelling_near(const char *a, const char *b)
{
	size_t n = strlen(a), m = strlen(b), i = 0;

	if (n > m)
		return spelling_near(b, a);
	if (m - n > 1)
		return 0;
	while (i < n && a[i] == b[i])
		i++;
	if (m > n)
		return !strcmp(a + i, b + i + 1);
	if (i == n)
		return 0;
	if (!strcmp(a + i + 1, b + i + 1))
		return 1;
	return i + 1 < n && a[i] == b[i + 1] && a[i + 1] == b[i] && !strcmp(a + i + 2, b + i + 2);
}

/* 1 where b is a with two neighbours exchanged. */
static int is_exchanged(const char *a, const char *b)
{
	size_t i = 0;

	if (strlen(a) != strlen(b) || !spelling_near(a, b))
		return 0;
	while (a[i] && a[i] == b[i])
		i++;
	return a[i] && a[i + 1] && a[i] == b[i + 1] && a[i + 1] == b[i];
}

/* A word that may be misspelt. */
struct suspect {
	const char *word;
	size_t least; /* letters of a right word of which a slip other than an exchange is told */
	char *right;
};

/* Whether the suspect is a slip of this word: right gets it. */
static int is_slip_of(const struct suspect *s, const char *right)
{
	const size_t n = strlen(right);

	if (n < 3 || n >= SPELLING_LENGTH)
		return 0;
	if (!is_exchanged(s->word, right) &&
		(n < s->least || s->word[0] != right[0] || !spelling_near(s->word, right)))
		return 0;
	snprintf(s->right, SPELLING_LENGTH, "%s", right);
	return 1;
}

/* The noun or its plural. */
static int is_slip_of_noun(const struct suspect *s, const char *noun)
{
	static const char *const plurals[] = {"", "s", "es"};
	const size_t length = strlen(noun), forms = length && strchr("sxzho", noun[length - 1]) ? 3 : 2;
	char form[SPELLING_LENGTH + 2];

	if (*noun != s->word[0] && *noun != s->word[1])
		return 0; /* no slip changes the first letter, but an exchange */
	for (size_t i = 0; i < forms && length < SPELLING_LENGTH - 2; i++) {
		snprintf(form, sizeof form, "%s%s", noun, plurals[i]);
		if (is_slip_of(s, form))
			return 1;
	}
	return 0;
}

static int is_known(const char *word, const char *lemma, const char *const *known, int known_count)
{
	struct things_rows rows;
	char base[COMPARED_LENGTH];

	for (int i = 0; i < known_count; i++)
		if (!strcmp(known[i], word) || !strcmp(known[i], lemma))
			return 1;
	things_find(&rows, lemma);
	return rows.n || colour_word(word) >= 0 || kinds_have(lemma) ||
	       compared_of(word, base) != PARSE_PLAIN;
}

static int find_right(const struct suspect *s, const char *const *known, int known_count)
{
	char noun[KINDS_LENGTH];

	for (int i = 0; i < known_count; i++)
		if (is_slip_of_noun(s, known[i]))
			return 1;
	for (int i = 0; i < closed_count; i++)
		if (is_slip_of(s, closed_words[i].text))
			return 1;
	for (int i = 0; i < COLOUR_WORDS; i++)
		if (is_slip_of(s, colour_name(i)))
			return 1;
	for (long at = 0; kinds_next(&at, noun);)
		if (is_slip_of_noun(s, noun))
			return 1;
	return 0;
}

/* What was found for words lately, where none were given: that takes a walk through all words there are. */
struct found {
	char word[SPELLING_LENGTH], right[SPELLING_LENGTH];
	int is_slip;
};

static int find_repair(const char *word, const char *const *known, int known_count, char *right)
{
	char lemma[TOKEN_LENGTH];
	struct suspect s = {word, 6, right};

	token_lemma(word, lemma);
	if (is_known(word, lemma, known, known_count) ||
		(wordnet_is_there() && wordnet_is_noun(lemma) && wordnet_is_verb(lemma)))
		return 0; /* "cost" is none of "cots" */
	if (wordnet_is_there() && !wordnet_is_noun(lemma))
		s.least = 5;
	return find_right(&s, known, known_count) && !wordnet_is_adjective(word); /* an adjective is none */
}

int spelling_repair(const char *word, const char *const *known, int known_count, char *right)
{
	static _Thread_local struct found lately[64];
	const size_t n = strlen(word);

	if (n < 3 || n > SPELLING_LENGTH - 3 || isdigit((unsigned char)word[0]))
		return 0;
	if (known_count)
		return find_repair(word, known, known_count, right);
	struct found *f = &lately[hash64(word, n, 0) % (sizeof lately / sizeof *lately)];
	if (strcmp(f->word, word) != 0) {
		memcpy(f->word, word, n + 1);
		f->is_slip = find_repair(word, NULL, 0, f->right);
	}
	if (f->is_slip)
		memcpy(right, f->right, strlen(f->right) + 1);
	return f->is_slip;
}
