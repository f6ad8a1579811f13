#include "lang/tokens.h"

#include "base/list.h"
#include "lang/closed.h"
#include "lang/spelling.h"

#include <ctype.h>
#include <stdlib.h>
#include <stdio.h>
#include <string.h>

int token_ends(const char *word, const char *tail, size_t stem)
{
	const size_t n = strlen(word), m = strlen(tail);

	return n >= m + stem && !strcmp(word + n - m, tail);
}

/* A copy of a text in a buffer of `room` bytes. */
static void put(char *to, const char *text, size_t room)
{
	snprintf(to, room, "%s", text);
}

void token_lemma(const char *word, char *out)
{
	static const char *const odd[][2] = {{"mice", "mouse"}, {"shoes", "shoe"}, {"toes", "toe"},
		{"shelves", "shelf"}, {"bookshelves", "bookshelf"}, {"knives", "knife"}, {"feet", "foot"},
		{"men", "man"}, {"women", "woman"}, {"people", "person"}, {"children", "child"},
		{"leaves", "leaf"}, {"loaves", "loaf"}, {"halves", "half"}, {"teeth", "tooth"},
		{"geese", "goose"}, {"scarves", "scarf"}, {"atlas", "atlas"}, {"canvas", "canvas"},
		{"thermos", "thermos"}, {"lens", "lens"}};
	/* the tails of plurals, and what they become */
	static const char *const tails[][2] = {{"ies", "y"}, {"sses", "ss"}, {"xes", "x"}, {"ches", "ch"},
		{"shes", "sh"}, {"zes", "ze"}, {"oes", "o"}};
	size_t n = strlen(word);

	put(out, word, TOKEN_LENGTH);
	for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
		if (!strcmp(word, odd[i][0])) {
			put(out, odd[i][1], TOKEN_LENGTH);
			return;
		}
	if (n < 4)
		return;
	for (size_t i = 0; i < sizeof tails / sizeof *tails; i++)
		if (token_ends(word, tails[i][0], 1)) {
			put(out + n - strlen(tails[i][0]), tails[i][1], strlen(tails[i][0]) + 1);
			return;
		}
	if (word[n - 1] == 's' && word[n - 2] != 's' && word[n - 2] != 'u' && word[n - 2] != 'i')
		out[n - 1] = 0;
}

/* What is written short, written out. */
static void write_out(char *word)
{
	static const char *const shorts[][2] = {{"w/", "with"}, {"w/o", "without"}, {"pls", "please"}};

	for (size_t i = 0; i < sizeof shorts / sizeof *shorts; i++)
		if (!strcmp(word, shorts[i][0]))
			put(word, shorts[i][1], TOKEN_LENGTH);
}

static int push(struct tokens *t, const char *text, int begin, int end, enum token_pause before)
{
	struct token *w = &t->word[t->n];
	int n = 0;

	if (t->n == TOKENS_MOST || begin == end)
		return 0;
	*w = (struct token){.span = {begin, end}, .before = before, .closed = -1};
	for (int i = begin; i < end && n < TOKEN_LENGTH - 1; i++) {
		if ((unsigned char)text[i] == 0xE2 && i + 2 < end && (unsigned char)text[i + 1] == 0x80 &&
			((unsigned char)text[i + 2] == 0x99 || (unsigned char)text[i + 2] == 0x98)) {
			w->text[n++] = '\'';
			i += 2;
		} else {
			w->text[n++] = (char)tolower((unsigned char)text[i]);
		}
	}
	write_out(w->text);
	w->closed = closed_find(w->text);
	t->n++;
	return 1;
}

/* Where a clitic begins in a word of lower case, or 0: "is|n't", "penguin|'s", "where|s". */
static int clitic(const char *word)
{
	static const char *const bare[] = {"isnt", "arent", "doesnt", "dont", "didnt", "hasnt", "havent",
		"wasnt", "wouldnt", "couldnt", "shouldnt"};
	static const char *const bare_s[] = {"wheres", "whats", "thats", "theres", "whos"};
	size_t n = strlen(word);

	for (size_t i = 0; i < sizeof bare / sizeof *bare; i++)
		if (!strcmp(word, bare[i]))
			return (int)n - 2;
	for (size_t i = 0; i < sizeof bare_s / sizeof *bare_s; i++)
		if (!strcmp(word, bare_s[i]))
			return (int)n - 1;
	if (token_ends(word, "n't", 1))
		return (int)n - 3;
	for (size_t i = n; i-- > 1;)
		if (word[i] == '\'' && n - i <= 3)
			return (int)i;
	return 0;
}

static void take_word(struct tokens *t, const char *text, int begin, int end, enum token_pause before)
{
	struct token *w;
	int cut, first = t->n;

	while (begin < end && text[begin] == '\'')
		begin++;
	while (end > begin && text[end - 1] == '\'')
		end--;
	if (!push(t, text, begin, end, before))
		return;
	w = &t->word[first];
	cut = end - begin < TOKEN_LENGTH ? clitic(w->text) : 0;
	if (cut) {
		/* the bytes before the clitic: the text may have a longer apostrophe */
		int rest = (int)strlen(w->text) - cut, wide = 0;
		for (int i = begin; i < end; i++)
			wide += (unsigned char)text[i] >= 0x80;
		int middle = end - rest - (wide && wide % 3 == 0 ? 2 : 0);
		t->n = first;
		if (middle <= begin || middle >= end)
			middle = end;
		push(t, text, begin, middle, before);
		if (push(t, text, middle, end, PAUSE_NONE)) {
			w = &t->word[t->n - 1];
			if (strcmp(w->text, "nt") == 0)
				strcpy(w->text, "n't");
			else if (strcmp(w->text, "s") == 0)
				strcpy(w->text, "'s");
			w->closed = closed_find(w->text);
		}
	}
}

/* Bytes of a character that parts words, 0 for one that does not; *pause rises to what it stands for. */
static int parting(const char *s, enum token_pause *pause)
{
	const unsigned char *u = (const unsigned char *)s;
	enum token_pause p = PAUSE_NONE;
	int bytes = 0;

	if (*u < 0x80) {
		if (isalnum(*u) || *u == '\'')
			return 0;
		p = strchr(".?!;", *u) ? PAUSE_STOP : strchr(",:()[]/\"", *u) ? PAUSE_COMMA : PAUSE_NONE;
		if (*u == '-' && (u[1] == '-' || u[1] == ' '))
			p = PAUSE_COMMA;
		/* a point within a number parts nothing */
		if (*u == '.' && isdigit(u[1]))
			p = PAUSE_NONE;
		bytes = 1;
	} else if (u[0] == 0xE2 && u[1] == 0x80) { /* dashes, curly quotes, ellipsis */
		if (u[2] == 0x98 || u[2] == 0x99)
			return 0;
		p = PAUSE_COMMA;
		bytes = u[2] ? 3 : 2;
	} else if (u[0] == 0xC2 && u[1] == 0xA0) { /* a space that does not break */
		bytes = 2;
	} else {
		return 0;
	}
	if (p > *pause)
		*pause = p;
	return bytes;
}

static int give(struct tokens *t, int begin, int end, int piece, int word)
{
	while (word < t->n && t->word[word].span.end <= begin)
		word++;
	if (word < t->n && t->word[word].span.begin < end) {
		if (!t->word[word].pieces)
			t->word[word].piece = piece;
		t->word[word].pieces = piece + 1 - t->word[word].piece;
	}
	return word;
}

/* Steps over white space and what the encoder drops. */
static int skip_space(const char *text, int at)
{
	while (text[at] && (isspace((unsigned char)text[at]) || iscntrl((unsigned char)text[at])))
		at++;
	return at;
}

static void give_pieces(struct tokens *t, const char *text, const char *pieces)
{
	int at = 0, word = 0, piece = 0;

	for (const char *p = pieces; *p;) {
		int length = (int)strcspn(p, " "), begin;
		const char *s = p;
		begin = at = skip_space(text, at);
		if (length >= 5 && !strncmp(p, "[UNK]", 5)) {
			if (text[at] && ispunct((unsigned char)text[at]))
				at++;
			else
				while (text[at] && !isspace((unsigned char)text[at]) &&
					!ispunct((unsigned char)text[at]))
					at++;
		} else {
			int skip = length > 2 && s[0] == '#' && s[1] == '#' ? 2 : 0;
			for (int k = skip; k < length && text[at];) {
				/* one character each; accents and capitals are gone from the piece */
				for (k++; k < length && ((unsigned char)s[k] & 0xC0) == 0x80;)
					k++;
				for (at++; ((unsigned char)text[at] & 0xC0) == 0x80;)
					at++;
			}
		}
		word = give(t, begin, at, piece, word);
		p += length;
		p += *p == ' ';
		piece++;
	}
}

void tokens_take(
	struct tokens *t, const char *text, const char *pieces, const char *const *known, int known_count)
{
	enum token_pause pause = PAUSE_NONE;
	int at = 0, bytes;

	t->n = 0;
	while (text[at] && t->n < TOKENS_MOST) {
		int begin = at;
		if ((bytes = parting(text + at, &pause))) {
			at += bytes;
			continue;
		}
		while (text[at] && !parting(text + at, &(enum token_pause){PAUSE_NONE}))
			at++;
		/* "t-shirt", "e-mail": one letter before a hyphen is no word */
		if (at - begin == 1 && text[at] == '-' && isalpha((unsigned char)text[at + 1]))
			for (at++; text[at] && !parting(text + at, &(enum token_pause){PAUSE_NONE});)
				at++;
		if (at - begin == 1 && tolower((unsigned char)text[begin]) == 'w' && text[at] == '/')
			at += text[at + 1] == 'o' && !isalnum((unsigned char)text[at + 2]) ? 2 : 1;
		int before = t->n;
		take_word(t, text, begin, at, pause);
		if (t->n > before)
			pause = PAUSE_NONE;
	}
	if (pieces)
		give_pieces(t, text, pieces);
	for (int i = 0; i < t->n; i++) {
		struct token *w = &t->word[i];
		char right[TOKEN_LENGTH];
		if (w->closed < 0 && w->pieces != 1 && spelling_repair(w->text, known, known_count, right)) {
			put(w->text, right, TOKEN_LENGTH);
			w->closed = closed_find(right);
		}
		token_lemma(w->text, w->lemma);
		if (!strcmp(w->text, "is") || !strcmp(w->text, "its"))
			put(w->lemma, w->text, TOKEN_LENGTH);
	}
}

int tokens_class(const struct tokens *t, int i)
{
	return i < 0 || i >= t->n || t->word[i].closed < 0 ? -1 : (int)closed_words[t->word[i].closed].class;
}

int tokens_is(const struct tokens *t, int i, const char *words)
{
	return i >= 0 && i < t->n && list_has(words, t->word[i].text);
}
