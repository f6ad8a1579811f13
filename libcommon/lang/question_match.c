/* A row of the table is matched from left to right, each capture as short as will do; where that fails, or
 * another way is wanted, the last capture grows first. */
#include "lang/question_match.h"

#include "lang/closed.h"
#include "lang/colours.h"

#include <string.h>

static const char *const class_names[CLOSED_CLASSES] = {
	[CLOSED_BE] = "be", [CLOSED_AUXILIARY] = "do", [CLOSED_PRONOUN] = "pronoun", [CLOSED_HAVE] = "have"};

/* One of the choices of an element, such as "is|=be", which has `length` bytes. */
static int is_choice(const struct tokens *t, int at, const char *choice, size_t length)
{
	const int class = tokens_class(t, at);

	if (length == 1 && *choice == '$')
		return class == CLOSED_SIZE || class == CLOSED_PLACE;
	if (length == 1 && *choice == '^')
		return (class == CLOSED_SIZE || class == CLOSED_PLACE) &&
		       closed_words[t->word[at].closed].value == PARSE_MOST;
	if (length == 1 && *choice == '#')
		return (class == CLOSED_NUMBER && closed_words[t->word[at].closed].value > 0) ||
		       tokens_is(t, at, "one");
	if (length == 1 && *choice == '%')
		return class == CLOSED_ATTRIBUTE || colour_word(t->word[at].text) >= 0;
	if (length == 1 && *choice == '~')
		return class < 0 && token_ends(t->word[at].text, "s", 1) &&
		       strcmp(t->word[at].text, t->word[at].lemma) != 0;
	if (*choice == '=')
		return class >= 0 && class_names[class] && strlen(class_names[class]) == length - 1 &&
		       !strncmp(class_names[class], choice + 1, length - 1);
	return strlen(t->word[at].text) == length && !strncmp(t->word[at].text, choice, length);
}

static int is_element(const struct tokens *t, int at, const char *element, size_t length)
{
	for (size_t from = 0, to; at < t->n && from < length; from = to + 1) {
		for (to = from; to < length && element[to] != '|'; to++)
			;
		if (is_choice(t, at, element + from, to - from))
			return 1;
	}
	return 0;
}

int question_is_break(const struct tokens *t, const char *text, int at)
{
	const int from = at ? t->word[at - 1].span.end : 0, to = t->word[at].span.begin;

	for (int k = from; k < to; k++)
		if (strchr(",.;:?!", text[k]) || (text[k] == '-' && text[k + 1] == ' '))
			return 1;
	return 0;
}

/* Whether a pause before a word goes on with a list: "bottles, bowls and mugs". */
static int is_listed(const struct tokens *t, int at)
{
	static const unsigned of_thing = 1U << CLOSED_DETERMINER | 1U << CLOSED_ATTRIBUTE | 1U << CLOSED_SIZE;
	int i = at;

	while (i < t->n && (tokens_class(t, i) < 0 || of_thing >> tokens_class(t, i) & 1))
		i++;
	return t->word[at].before == PAUSE_COMMA && i > at && tokens_class(t, i) == CLOSED_CONJUNCTION;
}

enum { ASIDE_WORDS = 3 };

/* Whether words behind a pause say nothing of the thing that was asked for before it: "would you?", but not
 * "the red one". */
static int is_aside(const struct tokens *t, const char *text, int at)
{
	static const unsigned more = 1U << CLOSED_DETERMINER | 1U << CLOSED_PLACE | 1U << CLOSED_WITH |
				     1U << CLOSED_EXCEPT | 1U << CLOSED_RELATIVE | 1U << CLOSED_NEGATION;
	const int class = at < t->n ? tokens_class(t, at) : -1;

	return at && at < t->n && t->n - at <= ASIDE_WORDS && question_is_break(t, text, at) &&
	       !is_listed(t, at) && (class < 0 || !(more >> class & 1));
}

int question_is_idle(const struct tokens *t, int i)
{
	static const unsigned idle =
		1U << CLOSED_PRONOUN | 1U << CLOSED_AUXILIARY | 1U << CLOSED_REQUEST | 1U << CLOSED_ADVERB;
	static const char words[] =
		"tell|list|name|enumerate|describe|show|say|know|wonder|give|measure|compute|calculate|ok|hey|hi|hello|and|so|want|like|to|"
		"if|here|there|now|then|around|about|in|total|altogether|roughly|approximately|exactly|"
		"need|find|out|see|check|just|well|sorry|excuse|thanks|whether|or|estimate|guess|work|figure|"
		"maybe|perhaps|by|together|combined";
	const int class = tokens_class(t, i);

	return (class >= 0 && idle >> class & 1) || tokens_is(t, i, words);
}

/* A capture that begins here and leaves the rest to match; kind: how it has to begin. */
static int match_words(struct matching *m, int which, char kind, const char *rest, int at)
{
	const int class = tokens_class(m->tokens, at);
	const int is_place = class == CLOSED_PLACE || class == CLOSED_PREPOSITION;

	if ((kind == '@' && !is_place) ||
		(kind == '&' && !is_place &&
			!(at < m->tokens->n &&
				(is_choice(m->tokens, at, "$", 1) || is_choice(m->tokens, at, "%", 1)))))
		return 0;
	if (which == CAPTURE_A && tokens_is(m->tokens, at, "what|which|who|where|how"))
		return 0;
	for (int end = at + 1; end <= m->tokens->n; end++) {
		m->of[which] = (struct capture){at, end};
		if (!tokens_is(m->tokens, end - 1, "the|my|your") && question_match(m, rest, end))
			return 1;
		if (end < m->tokens->n && question_is_break(m->tokens, m->text, end) &&
			!is_listed(m->tokens, end))
			break;
	}
	return 0;
}

int question_match(struct matching *m, const char *said, int at)
{
	size_t length = strcspn(said, " ");
	const char *rest = said + length + (said[length] == ' ');

	if (!length)
		return (at >= m->idle_after || is_aside(m->tokens, m->text, at)) && !m->skip--;
	if (*said == ',') {
		if (at == m->tokens->n || !at || !question_is_break(m->tokens, m->text, at))
			return 0;
		said++;
		length--;
	}
	const int begins = *said == '@' || *said == '&';
	static const char captures[] = "ABC";
	const char *mark = strchr(captures, said[begins]);
	if (length == (size_t)begins + 1 && mark)
		return match_words(m, (int)(mark - captures), *said, rest, at);
	const int is_free = said[length - 1] == '?';
	if (is_element(m->tokens, at, said, length - (size_t)is_free)) {
		const struct capture before = m->of[CAPTURE_WORD];
		if (strchr("$%#~^", *said))
			m->of[CAPTURE_WORD] = (struct capture){at, at + 1};
		if (question_match(m, rest, at + 1))
			return 1;
		m->of[CAPTURE_WORD] = before;
	}
	return is_free && question_match(m, rest, at);
}

int question_wants_yes(const struct tokens *t, const char *text)
{
	static const char there[] =
		"happen|notice|spot|detect|observe|recognise|recognize|own|have|perhaps|maybe|possibly|be";
	int after = 0; /* what somebody is called by: "mum," */

	if (!t->n)
		return 0;
	while (after < 3 && after + 1 < t->n && !(after && question_is_break(t, text, after)))
		after++;
	if (!question_is_break(t, text, after))
		after = 0;
	for (int i = 0; i < t->n; i++) /* what is compared, or told of further, is not just asked for */
		if (tokens_is(t, i, "than") || (i > after && t->word[i].before == PAUSE_STOP))
			return 0;
	for (int turn = 0; turn < 2; turn++) {
		const int i = turn ? after : 0, class = tokens_class(t, i);
		const int is_told = tokens_class(t, i + 1) == CLOSED_PRONOUN && !tokens_is(t, i + 2, there);
		if (class == CLOSED_BE ||
			(class == CLOSED_HAVE && tokens_class(t, i + 1) == CLOSED_PRONOUN) ||
			(class == CLOSED_AUXILIARY && !is_told && !tokens_is(t, i, "let")))
			return 1;
	}
	return 0;
}
