#include "lang/purpose.h"

#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/tokens.h"
#include "lang/wordnet.h"

#include <string.h>

static int is_open(const struct parse *p, int i)
{
	return closed_class_of(p, i) == CLOSED_CLASSES;
}

static int asks_before(const struct parse *p, int word)
{
	for (int i = 0; i < word; i++)
		if (parse_word_is(p, i, "what|whatever|where|which|how"))
			return 1;
	return 0;
}

/* "you could", "I need to", "would I", "people": what somebody does begins after it; i where nobody is spoken
 * of. What "I" did is no purpose. */
static int after_doer(const struct parse *p, int i)
{
	const int is_self = parse_word_is(p, i, "i|we"),
		  is_us = parse_word_is(p, i - 1, "let") && parse_word_is(p, i, "us|'s");
	int verb = i + 1;

	if (closed_class_of(p, i - 1) == CLOSED_AUXILIARY && !is_us &&
		!asks_before(p, i)) /* "could you lift it" */
		return i;
	const int is_one =
		is_us || (parse_word_is(p, i, "one") && closed_class_of(p, i + 1) == CLOSED_AUXILIARY);
	if (parse_word_is(p, i - 1, "did") ||
		(!is_self && !is_one && !parse_word_is(p, i, "you|they|people|somebody|someone|anybody")))
		return i;
	while (closed_class_of(p, verb) == CLOSED_AUXILIARY || closed_class_of(p, verb) == CLOSED_HAVE ||
		closed_class_of(p, verb) == CLOSED_ADVERB ||
		(closed_class_of(p, verb) == CLOSED_REQUEST && parse_word_is(p, verb + 1, "to")) ||
		parse_word_is(p, verb, "to"))
		verb++;
	return is_self && verb == i + 1 && closed_class_of(p, i - 1) != CLOSED_AUXILIARY ? i : verb;
}

static int says_doing(const struct parse *p)
{
	for (int i = 0; i < p->word_count; i++) {
		const int verb = after_doer(p, i);
		if (verb > i && is_open(p, verb) && closed_find(p->words[verb].lemma) < 0)
			return 1;
	}
	return 0;
}

/* "for cutting", "used to cut", "something to cut with". */
static int says_for(const struct parse *p)
{
	for (int i = 0; i < p->word_count; i++) {
		if (parse_word_is(p, i, "for") && is_open(p, i + 1) &&
			token_ends(p->words[i + 1].text, "ing", 2))
			return 1;
		if (parse_word_is(p, i, "for") && is_open(p, i + 1) &&
			closed_class_of(p, i - 1) == CLOSED_GENERIC)
			return 1;
		if (i &&
			parse_word_is(p, i,
				"place|area|spot|space|surface|product|stuff|fluid|liquid|agent|equipment|gear|tool|"
				"utensil|device|supplies|thing|item|gadget") &&
			is_open(p, i - 1) &&
			token_ends(p->words[i - 1].text, "ing", 2)) /* "a sleeping place" */
			return 1;
		if (parse_word_is(p, i, "used|use") && parse_word_is(p, i + 1, "to|for|it"))
			return 1;
		if (parse_word_is(p, i, "to|for|it") && is_open(p, i + 1) &&
			(!i || closed_class_of(p, i - 1) == CLOSED_GENERIC ||
				parse_word_is(p, i - 1, "anything|everything")))
			return 1;
	}
	return 0;
}

static int first_word(const struct parse *p)
{
	int i = 0;

	while (closed_class_of(p, i) == CLOSED_REQUEST || closed_class_of(p, i) == CLOSED_CONJUNCTION ||
		closed_class_of(p, i) == CLOSED_ADVERB)
		i++;
	return i;
}

/* "where the flowers go", "what rings", but not "where is the vase", "what stands by the wall" or "how many
 * stand by it". */
static int asks_for(const struct parse *p)
{
	const int i = first_word(p), next = closed_class_of(p, i + 1);
	const int asks_who = next == CLOSED_AUXILIARY &&
			     (closed_class_of(p, i + 2) == CLOSED_PRONOUN || after_doer(p, i + 2) > i + 2);

	if (parse_word_is(p, i, "how") && next != CLOSED_AUXILIARY && !parse_word_is(p, i + 1, "to"))
		return 0;
	return parse_word_is(p, i, "what|where|how") && !asks_who && next != CLOSED_BE &&
	       next != CLOSED_POSE && next != CLOSED_PLACE && next != CLOSED_HAVE && next != -1;
}

/* "Watch a film on it", "give these to a friend": what is to be done with what is meant. */
static int says_to_do(const struct parse *p)
{
	const int verb = first_word(p);

	if (!is_open(p, verb) || !wordnet_is_verb(p->words[verb].lemma))
		return 0;
	for (int i = verb + 1; i < p->word_count; i++)
		if (parse_word_is(p, i, "it|them") || (parse_word_is(p, i, "this|these|that|those") &&
							      closed_class_of(p, i + 1) != CLOSED_CLASSES &&
							      closed_class_of(p, i + 1) != CLOSED_GENERIC &&
							      closed_class_of(p, i + 1) != CLOSED_ATTRIBUTE &&
							      closed_class_of(p, i + 1) != CLOSED_SIZE))
			return 1;
	return 0;
}

int purpose_is_said(const struct parse *p)
{
	return says_doing(p) || says_for(p) || asks_for(p) || says_to_do(p);
}

int purpose_is_content(const struct parse *p, int word)
{
	static const char empty[] =
		"used|use|using|go|goes|come|comes|make|makes|put|keep|keeps|let|lets|want|wants|somebody|people";

	return (is_open(p, word) || parse_word_is(p, word, "sit|sits|lie|hang|hangs|lean")) &&
	       !parse_word_is(p, word, empty) && colour_word(p->words[word].lemma) < 0;
}
