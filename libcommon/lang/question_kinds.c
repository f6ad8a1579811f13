/* A row of the table is matched from left to right, each capture as short as will do; where that fails, or
 * another way is wanted, the last capture grows first. */
#include "lang/question_kinds.h"

#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/tokens.h"

#include <stdio.h>
#include <string.h>

static const struct {
	const char *kind, *said, *asks[2];
} rows[] = {
#include "lang/question_kinds.inc"
};

static const char *const names[QUESTION_KINDS] = {"which", "list", "number", "colour", "look", "distance",
	"height", "width", "size", "compare", "there", "whether", "set"};

static const char *const class_names[CLOSED_CLASSES] = {
	[CLOSED_BE] = "be", [CLOSED_AUXILIARY] = "do", [CLOSED_PRONOUN] = "pronoun"};

/* The words that a capture holds: from one token up to another. */
struct capture {
	int begin, end;
};

enum { CAPTURE_A, CAPTURE_B, CAPTURE_WORD, CAPTURES };

struct matching {
	const char *text;
	const struct tokens *tokens;
	struct capture of[CAPTURES];
	int skip; /* ways that are passed over */
};

const char *question_name(enum question_kind kind)
{
	return names[kind];
}

/* One of the choices of an element, such as "is|=be", which has `length` bytes. */
static int is_choice(const struct tokens *t, int at, const char *choice, size_t length)
{
	const int class = tokens_class(t, at);

	if (length == 1 && *choice == '$')
		return class == CLOSED_SIZE || class == CLOSED_PLACE;
	if (length == 1 && *choice == '%')
		return class == CLOSED_ATTRIBUTE || colour_word(t->word[at].text) >= 0;
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

/* Whether a sentence or a part of one ends before a word. */
static int is_break(const struct tokens *t, const char *text, int at)
{
	const int from = at ? t->word[at - 1].span.end : 0, to = t->word[at].span.begin;

	for (int k = from; k < to; k++)
		if (strchr(",.;:?!", text[k]))
			return 1;
	return 0;
}

/* Whether words say nothing more of what is asked for, before it or behind it. */
static int are_idle(const struct tokens *t, int begin, int end)
{
	static const unsigned idle =
		1U << CLOSED_PRONOUN | 1U << CLOSED_AUXILIARY | 1U << CLOSED_REQUEST | 1U << CLOSED_ADVERB;
	static const char words[] =
		"tell|say|know|wonder|give|measure|compute|calculate|ok|hey|hi|hello|and|so|want|like|to|"
		"if|here|there|now|then|around|about|in|total|altogether|roughly|approximately|exactly|"
		"need|find|out|see|check|just|well|sorry|excuse|thanks|whether|or";

	for (; begin < end; begin++) {
		const int class = tokens_class(t, begin);
		if ((class < 0 || !(idle >> class & 1)) && !tokens_is(t, begin, words))
			return 0;
	}
	return 1;
}

static int match(struct matching *m, const char *said, int at);

/* A capture that begins here and leaves the rest to match. */
static int match_words(struct matching *m, int which, int is_place, const char *rest, int at)
{
	const int class = tokens_class(m->tokens, at);

	if (is_place && class != CLOSED_PLACE && class != CLOSED_PREPOSITION)
		return 0;
	for (int end = at + 1; end <= m->tokens->n; end++) {
		m->of[which] = (struct capture){at, end};
		if (match(m, rest, end))
			return 1;
		if (end < m->tokens->n && is_break(m->tokens, m->text, end))
			break;
	}
	return 0;
}

/* The rest of a row from token `at` on. */
static int match(struct matching *m, const char *said, int at)
{
	const size_t length = strcspn(said, " ");
	const char *rest = said + length + (said[length] == ' ');

	if (!length)
		return are_idle(m->tokens, at, m->tokens->n) && !m->skip--;
	const int is_place = *said == '@';
	if (length == (size_t)is_place + 1 && (said[is_place] == 'A' || said[is_place] == 'B'))
		return match_words(m, said[is_place] == 'A' ? CAPTURE_A : CAPTURE_B, is_place, rest, at);
	const int is_free = said[length - 1] == '?';
	if (is_element(m->tokens, at, said, length - (size_t)is_free)) {
		const struct capture before = m->of[CAPTURE_WORD];
		if (*said == '$' || *said == '%')
			m->of[CAPTURE_WORD] = (struct capture){at, at + 1};
		if (match(m, rest, at + 1))
			return 1;
		m->of[CAPTURE_WORD] = before;
	}
	return is_free && match(m, rest, at);
}

/* The text that a row asks for, with what was captured in it. */
static void fill(char to[QUESTION_TEXT], const char *asks, const struct matching *m, const char *text)
{
	static const char marks[] = "AB$";
	size_t n = 0;

	for (const char *c = asks; *c && n + 1 < QUESTION_TEXT; c++) {
		const char mark = *c == '%' ? '$' : *c;
		const char *is = *c == '@' ? NULL : strchr(marks, mark);
		if (!is && *c != '@')
			to[n++] = *c;
		if (!is)
			continue;
		const struct capture of = m->of[is - marks];
		const int begin = m->tokens->word[of.begin].span.begin,
			  end = m->tokens->word[of.end - 1].span.end;
		n += (size_t)snprintf(to + n, QUESTION_TEXT - n, "%.*s", end - begin, text + begin);
	}
	to[n < QUESTION_TEXT ? n : QUESTION_TEXT - 1] = 0;
}

static void take(struct question_asked *q, size_t row, const struct matching *m, const char *text)
{
	const struct capture word = m->of[CAPTURE_WORD];
	const int closed = word.end ? m->tokens->word[word.begin].closed : -1;

	while (q->kind + 1 < QUESTION_KINDS && strcmp(names[q->kind], rows[row].kind) != 0)
		q->kind++;
	q->relation = closed < 0 ? -1 : closed_words[closed].relation;
	for (int k = 0; k < 2; k++)
		if (strcmp(rows[row].asks[k], "-") != 0)
			fill(q->text[k], rows[row].asks[k], m, text);
		else
			snprintf(q->text[k], sizeof q->text[k], "%s", k ? "" : text);
}

int question_read(struct question_asked *q, const char *text, int way)
{
	struct tokens t;

	*q = (struct question_asked){.relation = -1};
	tokens_take(&t, text, NULL, NULL, 0);
	for (size_t row = 0; row < sizeof rows / sizeof *rows; row++)
		for (int at = 0; at < t.n; at++) {
			struct matching first = {.text = text, .tokens = &t}, m = first;
			m.skip = way;
			if ((!are_idle(&t, 0, at) && !is_break(&t, text, at)) ||
				!match(&first, rows[row].said, at))
				continue;
			if (!match(&m, rows[row].said, at))
				return 0;
			take(q, row, &m, text);
			return 1;
		}
	snprintf(q->text[0], sizeof q->text[0], "%s", text);
	return !way;
}
