#include "lang/parts.h"

#include "lang/kinds.h"
#include "lang/things.h"
#include "lang/tokens.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

int parts_share(const struct parts *thing, const struct parts *word)
{
	for (int i = 0; i < thing->n; i++)
		for (int k = 0; k < word->n; k++)
			if (thing->stem[i] == word->stem[k])
				return 1;
	return 0;
}

enum { LONGEST = 24 };

/* "drinking" and "drinks" become "drink", "served" and "serve" "serv", "thrown" "throw". */
static void stem(char *w)
{
	static const char *const tails[] = {"ing", "ed", "en", "es", "s"};
	size_t n = strlen(w);

	for (size_t i = 0; i < sizeof tails / sizeof *tails; i++)
		if (token_ends(w, tails[i], 3)) {
			n -= strlen(tails[i]);
			break;
		}
	w[n] = 0;
	if (token_ends(w, "wn", 3))
		w[--n] = 0;
	if (n > 3 && w[n - 1] == 'e')
		w[--n] = 0;
	if (n > 3 && w[n - 1] == w[n - 2] && w[n - 1] != 's' && w[n - 1] != 'l')
		w[--n] = 0;
}

static unsigned hash(const char *w)
{
	unsigned h = 2166136261U;

	for (; *w; w++)
		h = (h ^ (unsigned char)*w) * 16777619U;
	return h;
}

/* Words that say nothing of a part. */
static int is_empty(const char *stemmed)
{
	static const char empty[] =
		" the and for with that from its are was has have any who which one two used use usual made mak "
		"mad put tak tok get got giv let can may often oft such other than into out onto off not all "
		"small larg object thing someth someth part typic consist contain various some who whom his her he "
		"she him they them their it you your what when where were been be is do does an as at by in of on "
		"or to up go com kind form shap piec set particular especial etc own keep ";
	char padded[LONGEST + 3];

	snprintf(padded, sizeof padded, " %s ", stemmed);
	return strlen(stemmed) < 3 || strstr(empty, padded) != NULL;
}

static void add(struct parts *to, const char *word, size_t length)
{
	char w[LONGEST + 1];

	if (length > LONGEST || to->n == PARTS_STEMS)
		return;
	for (size_t i = 0; i < length; i++)
		w[i] = (char)tolower((unsigned char)word[i]);
	w[length] = 0;
	stem(w);
	if (!is_empty(w))
		to->stem[to->n++] = hash(w);
}

static void add_text(struct parts *to, const char *text, size_t length)
{
	for (size_t i = 0, n; i < length; i += n ? n : 1) {
		for (n = 0; i + n < length && isalpha((unsigned char)text[i + n]);)
			n++;
		if (n)
			add(to, text + i, n);
	}
}

void parts_usual(struct parts *to, const char *lemma)
{
	struct things_rows rows;
	size_t length;

	to->n = 0;
	things_find(&rows, lemma);
	for (int i = 0; i < rows.n; i++) {
		const char *text = things_text(rows.row[i], THINGS_HAS, &length);
		add_text(to, text, length);
	}
}

void parts_of_word(struct parts *to, const char *lemma)
{
	size_t length;
	const char *has = kinds_has(lemma, &length);

	to->n = 0;
	if (has)
		add_text(to, has, length);
	else
		add(to, lemma, strlen(lemma));
}
