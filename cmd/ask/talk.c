/* Words that point back to what was spoken of last. They are put right in the question's text, so that
 * everything else reads it as if it had been said in full. */
#include "cmd/ask/reply.h"

#include "lang/closed.h"
#include "lang/tokens.h"

#include <string.h>

/* Whether a thing is named in the question before word i, which then points to that. */
static int is_named_before(const struct tokens *t, int i)
{
	int is_definite = 0;

	for (int k = 0; k < i; k++) {
		const int class = tokens_class(t, k);
		if (class == CLOSED_DETERMINER)
			is_definite = 1;
		else if (class < 0 && is_definite)
			return 1;
		else if (class >= 0 && class != CLOSED_SIZE && class != CLOSED_ATTRIBUTE &&
			 class != CLOSED_ORDINAL)
			is_definite = 0;
	}
	return 0;
}

/* The words of a name but for numbers; with is_noun the last of them alone. */
static void find_words(const char *name, int is_noun, char words[CALLING_TEXT])
{
	struct tokens t;
	size_t n = 0;

	*words = 0;
	tokens_take(&t, name, NULL, NULL, 0);
	for (int i = 0; i < t.n && n < CALLING_TEXT; i++)
		if (strspn(t.word[i].text, "0123456789") < strlen(t.word[i].text)) {
			n = is_noun ? 0 : n;
			n += (size_t)snprintf(
				words + n, CALLING_TEXT - n, "%s%s", n ? " " : "", t.word[i].lemma);
		}
}

/* What several things are called, one of which has this name: "the bigger one" is one of those. "": no others
 * are. */
static void find_shared(char *const *names, size_t objects, size_t thing, char words[CALLING_TEXT])
{
	char other[CALLING_TEXT];

	for (int is_noun = 0; is_noun < 2; is_noun++) {
		int n = 0;
		find_words(names[thing], is_noun, words);
		for (size_t o = 0; o < objects; o++) {
			find_words(names[o], is_noun, other);
			n += !strcmp(words, other);
		}
		if (n > 1)
			return;
	}
	*words = 0;
}

/* What word i points back to, or NULL; *end gets the word behind it. */
static const char *points_to(const struct tokens *t, int i, const char *name, const char *noun, int *end)
{
	static const char *const it[] = {"it", "that", "this", "him", "her", NULL};
	const int is_one = tokens_is(t, i + 1, "one") || tokens_is(t, i + 1, "thing");
	const int is_last = i + 1 == t->n, class = tokens_class(t, i + 1);

	*end = i + 1;
	if (is_named_before(t, i))
		return NULL;
	if (tokens_is(t, i, "it") || tokens_is(t, i, "him") || tokens_is(t, i, "her"))
		return name;
	if (tokens_is_any(t, i, it) &&
		(is_one || is_last || class == CLOSED_BE || class == CLOSED_CONJUNCTION)) {
		*end = i + 1 + is_one;
		return name;
	}
	return *noun && tokens_is(t, i, "one") && i ? noun : NULL;
}

/* "no, the other one", "not that one": asks for another thing than the last. */
static int is_other(const struct tokens *t)
{
	static const char *const words[] = {"no", "nope", "not", "the", "that", "this", "it", "i", "mean",
		"meant", "other", "one", "another", "thing", "wrong", "'s", "n't", NULL};
	int is = 0;

	for (int i = 0; i < t->n; i++) {
		if (!tokens_is_any(t, i, words))
			return 0;
		is |= tokens_is(t, i, "other") || tokens_is(t, i, "another") || tokens_is(t, i, "not") ||
		      tokens_is(t, i, "n't");
	}
	return is;
}

/* Where the thing begins of "and the kettle?", "what about the kettle?"; 0: it is none of these. */
static int find_again(const struct tokens *t)
{
	const int about = tokens_is(t, 1, "about") && (tokens_is(t, 0, "what") || tokens_is(t, 0, "how"));
	const int from = about ? 2 : tokens_is(t, 0, "and");

	return from && from < t->n && tokens_class(t, from) == CLOSED_DETERMINER ? from : 0;
}

/* The last question of the thing that this one names. */
static int ask_again(const struct talk *talk, const char *thing, char understood[QUESTION_TEXT])
{
	struct question_asked last;

	question_read(&last, talk->question, 0);
	const char *at = last.kind == QUESTION_WHICH ? NULL : strstr(talk->question, last.text[0]);
	if (!at || !strcmp(last.text[0], talk->question))
		return snprintf(understood, QUESTION_TEXT, "%s", thing);
	return snprintf(understood, QUESTION_TEXT, "%.*s%s%s", (int)(at - talk->question), talk->question,
		thing, at + strlen(last.text[0]));
}

int talk_understand(const struct talk *talk, char *const *names, size_t objects, const char *question,
	char understood[QUESTION_TEXT])
{
	char noun[CALLING_TEXT];
	struct tokens t;
	size_t n = 0;
	int from = 0;

	snprintf(understood, QUESTION_TEXT, "%s", question);
	if (!talk || !*talk->question || talk->thing == ASKING_NONE)
		return 0;
	tokens_take(&t, question, NULL, NULL, 0);
	if (is_other(&t))
		return snprintf(understood, QUESTION_TEXT, "%s", talk->question) > 0;
	if (find_again(&t))
		return ask_again(talk, question + t.word[find_again(&t)].span.begin, understood), 0;
	find_shared(names, objects, talk->thing, noun);
	for (int i = 0, end; i < t.n && n < QUESTION_TEXT; i = end) {
		const char *to = points_to(&t, i, names[talk->thing], noun, &end);
		if (!to)
			continue;
		n += (size_t)snprintf(understood + n, QUESTION_TEXT - n, "%.*s%s%s",
			t.word[i].span.begin - from, question + from, to == noun ? "" : "the ", to);
		from = t.word[end - 1].span.end;
	}
	if (n < QUESTION_TEXT)
		snprintf(understood + n, QUESTION_TEXT - n, "%s", question + from);
	return 0;
}

void talk_take(struct talk *talk, const struct answer_told *t)
{
	const struct asking_answer *a = t->answer;

	if (!a->count)
		return;
	talk->thing = a->things[0];
	memcpy(talk->question, t->understood, sizeof talk->question);
}
