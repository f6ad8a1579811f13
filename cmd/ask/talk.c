/* Words that point back to what was spoken of last. They are put right in the question's text, so that
 * everything else reads it as if it had been said in full. */
#include "cmd/ask/reply.h"

#include "lang/closed.h"
#include "lang/tokens.h"

#include <string.h>

enum { FEW = 4 /* things that "they" may be */ };

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

/* What a word points back to. */
struct pointed {
	const char *article, *to, *tail; /* "the ", "mug", "'s"; to is NULL: nothing */
	int end;			 /* the word behind it */
};

static struct pointed points_to(
	const struct tokens *t, int i, const struct talk *talk, const char *name, const char *noun)
{
	const int is_one = tokens_is(t, i + 1, "one|thing");
	const int class = tokens_class(t, i + 1), before = i ? tokens_class(t, i - 1) : CLOSED_CONJUNCTION;
	/* behind a noun, as of "everything that is red", a clause begins */
	const int may_stand =
		before == CLOSED_CONJUNCTION || before == CLOSED_BE || before == CLOSED_PREPOSITION;
	const int is_end =
		i + 1 == t->n || (may_stand && (class == CLOSED_BE || class == CLOSED_CONJUNCTION));

	if (is_named_before(t, i))
		return (struct pointed){.end = i + 1};
	if (tokens_is(t, i, "its"))
		return (struct pointed){"the ", name, "'s", i + 1};
	if (tokens_is(t, i, "it|him|her"))
		return (struct pointed){"the ", name, "", i + 1};
	if (tokens_is(t, i, "that|this") && (is_one || is_end))
		return (struct pointed){"the ", name, "", i + 1 + is_one};
	if (*talk->things && tokens_is(t, i, "they|them|those|these") &&
		(is_end || class == CLOSED_NUMBER || tokens_is(t, i, "they")))
		return (struct pointed){"", talk->things, "", i + 1 + (class == CLOSED_NUMBER)};
	if (*noun && i && tokens_is(t, i, "one"))
		return (struct pointed){"", noun, "", i + 1};
	return (struct pointed){.end = i + 1};
}

/* "no, the other one", "not that one": asks for another thing than the last. */
static int is_other(const struct tokens *t)
{
	static const char words[] =
		"no|nope|not|the|that|this|it|i|mean|meant|other|one|another|thing|wrong|'s|n't|and|what|"
		"about";
	int is = 0;

	for (int i = 0; i < t->n; i++) {
		if (!tokens_is(t, i, words))
			return 0;
		is |= tokens_is(t, i, "other|another|not|n't");
	}
	return is;
}

/* Where the thing begins of "and the kettle?", "what about the kettle?"; 0: it is none of these. */
static int find_again(const struct tokens *t)
{
	const int about = tokens_is(t, 1, "about") && tokens_is(t, 0, "what|how");
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

/* The question with what its words point back to in their place. */
static void put_pointed(const struct talk *talk, char *const *names, size_t objects, const char *question,
	char understood[QUESTION_TEXT])
{
	char noun[CALLING_TEXT];
	struct tokens t;
	size_t n = 0;
	int from = 0;

	*understood = 0;
	tokens_take(&t, question, NULL, NULL, 0);
	find_shared(names, objects, talk->thing, noun);
	for (int i = 0, end; i < t.n && n < QUESTION_TEXT; i = end) {
		const struct pointed p = points_to(&t, i, talk, names[talk->thing], noun);
		end = p.end;
		if (!p.to)
			continue;
		n += (size_t)snprintf(understood + n, QUESTION_TEXT - n, "%.*s%s%s%s",
			t.word[i].span.begin - from, question + from, p.article, p.to, p.tail);
		from = t.word[end - 1].span.end;
	}
	if (n < QUESTION_TEXT)
		snprintf(understood + n, QUESTION_TEXT - n, "%s", question + from);
}

int talk_understand(const struct talk *talk, char *const *names, size_t objects, const char *question,
	char understood[QUESTION_TEXT])
{
	char again[QUESTION_TEXT];
	struct tokens t;

	snprintf(understood, QUESTION_TEXT, "%s", question);
	if (!talk || !*talk->question || talk->thing == ASKING_NONE)
		return 0;
	tokens_take(&t, question, NULL, NULL, 0);
	if (is_other(&t))
		return snprintf(understood, QUESTION_TEXT, "%s", talk->question) > 0;
	if (find_again(&t))
		ask_again(talk, question + t.word[find_again(&t)].span.begin, again);
	else
		memcpy(again, understood, sizeof again);
	put_pointed(talk, names, objects, again, understood);
	return 0;
}

void talk_take(struct talk *talk, const struct answer_told *t)
{
	const struct asking_answer *a = t->answer;

	if (!a->count)
		return;
	talk->thing = a->things[0];
	*talk->things = 0;
	for (size_t k = 0, n = 0; k < a->count && a->count > 1 && a->count <= FEW && n < CALLING_TEXT; k++)
		n += (size_t)snprintf(talk->things + n, CALLING_TEXT - n, "%sthe %s", k ? " and " : "",
			t->asking->model.lifted.names[a->things[k]]);
	memcpy(talk->question, t->understood, sizeof talk->question);
}
