/* Words of the closed classes. The table is libcommon/lang/closed.tsv. */
#include "lang/closed.h"

#include <string.h>

const struct closed_word closed_words[] = {
#include "lang/closed.inc"
};

const int closed_count = sizeof closed_words / sizeof *closed_words;

int closed_find(const char *text)
{
	/* the first word of each letter, and the next of the same, from 1 on */
	static _Thread_local short first[256], next[CLOSED_MOST];

	for (int i = closed_count; i-- && !next[0];) {
		next[i] = first[(unsigned char)*closed_words[i].text];
		first[(unsigned char)*closed_words[i].text] = (short)(i + 1);
	}
	int i = first[(unsigned char)*text];
	while (i && strcmp(closed_words[i - 1].text, text) != 0)
		i = next[i - 1];
	return i - 1;
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
