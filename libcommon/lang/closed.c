/* Words of the closed classes. The table is libcommon/lang/closed.tsv. */
#include "lang/closed.h"

#include <string.h>

const struct closed_word closed_words[] = {
#include "lang/closed.inc"
};

const int closed_count = sizeof closed_words / sizeof *closed_words;

int closed_find(const char *text)
{
	for (int i = 0; i < closed_count; i++)
		if (closed_words[i].text[0] == text[0] && !strcmp(closed_words[i].text, text))
			return i;
	return -1;
}

int closed_is(const char *text, enum closed_class class)
{
	const int closed = closed_find(text);

	return closed >= 0 && closed_words[closed].class == class;
}

int closed_class_of(const struct parse *p, int word)
{
	if (word < 0 || word >= p->word_count)
		return -1;
	const int closed = closed_find(p->words[word].text);
	return closed < 0 ? CLOSED_CLASSES : (int)closed_words[closed].class;
}

enum parse_relation closed_inverse(enum parse_relation r)
{
	static const enum parse_relation pairs[][2] = {{PARSE_LEFT, PARSE_RIGHT}, {PARSE_FRONT, PARSE_BEHIND},
		{PARSE_ABOVE, PARSE_BELOW}, {PARSE_ON, PARSE_SUPPORTS}, {PARSE_LARGER, PARSE_SMALLER},
		{PARSE_TALLER, PARSE_SHORTER}};

	for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
		for (int k = 0; k < 2; k++)
			if (pairs[i][k] == r)
				return pairs[i][!k];
	return r == PARSE_INSIDE ? PARSE_SUPPORTS : r;
}
