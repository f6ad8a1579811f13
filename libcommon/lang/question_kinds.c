#include "lang/question_kinds.h"

#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/question_forms.h"
#include "lang/question_match.h"

#include <stdio.h>
#include <string.h>

static const struct {
	const char *kind, *said, *asks[2], *how;
} rows[] = {
#include "lang/question_kinds.inc"
};

static const char *const names[QUESTION_KINDS] = {"which", "list", "number", "colour", "look", "distance",
	"height", "width", "size", "compare", "more", "either", "there", "whether", "set", "tally", "even",
	"majority", "surplus", "same", "when", "then", "untold"};

const char *question_name(enum question_kind kind)
{
	return names[kind];
}

/* The text that a row asks for, with what was captured in it. */
static void fill(char to[QUESTION_TEXT], const char *asks, const struct matching *m, const char *text)
{
	static const char marks[] = "ABC$";
	size_t n = 0;

	for (const char *c = asks; *c && n + 1 < QUESTION_TEXT; c++) {
		const char mark = *c == '%' ? '$' : *c;
		const int is_mark = *c == '@' || *c == '&';
		const char *is = is_mark ? NULL : strchr(marks, mark);
		if (!is && !is_mark)
			to[n++] = *c;
		if (!is)
			continue;
		const struct capture of = m->of[is - marks];
		const int is_denied = tokens_is(m->tokens, of.begin, "n't"),  /* apart from its verb */
			is_own = tokens_is(m->tokens, of.begin, "its|their"); /* "the laptop or its mouse" */
		const int first = of.begin + ((is_denied || is_own) && of.begin + 1 < of.end);
		const int begin = m->tokens->word[first].span.begin,
			  end = m->tokens->word[of.end - 1].span.end;
		n += (size_t)snprintf(to + n, QUESTION_TEXT - n, "%s%.*s",
			is_denied ? "not "
			: is_own  ? "the "
				  : "",
			end - begin, text + begin);
	}
	to[n < QUESTION_TEXT ? n : QUESTION_TEXT - 1] = 0;
}

void question_noun(const char *phrase, char noun[TOKEN_LENGTH])
{
	struct tokens t;
	int i = 0;

	*noun = 0;
	tokens_take(&t, phrase, NULL, NULL, 0);
	while (i < t.n && tokens_class(&t, i) != CLOSED_DETERMINER)
		i++;
	for (i = i < t.n ? i + 1 : 0; i < t.n; i++) {
		const int class = tokens_class(&t, i);
		if (class < 0 && colour_word(t.word[i].text) >= 0 &&
			tokens_class(&t, i + 1) == CLOSED_GENERIC)
			continue;
		if (class < 0 && (*t.word[i].text < '0' || *t.word[i].text > '9'))
			snprintf(noun, TOKEN_LENGTH, "%s", t.word[i].lemma);
		else if (*noun ||
			 (class != CLOSED_ATTRIBUTE && class != CLOSED_SIZE && class != CLOSED_NUMBER))
			return;
	}
}

/* "Is the mug larger than the red one?": than the red mug. */
static void name_one(struct question_asked *q)
{
	char noun[TOKEN_LENGTH], text[QUESTION_TEXT];
	struct tokens t;

	tokens_take(&t, q->text[1], NULL, NULL, 0);
	question_noun(q->text[0], noun);
	for (int i = 1; i < t.n && *noun && *q->text[0]; i++)
		if (tokens_is(&t, i, "one") && tokens_class(&t, i - 1) != CLOSED_NUMBER) {
			snprintf(text, sizeof text, "%.*s%s%s", t.word[i].span.begin, q->text[1], noun,
				q->text[1] + t.word[i].span.end);
			memcpy(q->text[1], text, strlen(text) + 1);
			return;
		}
}

/* Whether a word tells on which side of something a thing is: of "in front of" that is "front". */
static int is_side(int closed)
{
	const int relation = closed < 0 ? -1 : closed_words[closed].relation;

	return relation >= 0 && (relation <= PARSE_BELOW || relation == PARSE_BETWEEN);
}

/* "Nearer to us", and "the taller of the two": what the two are compared by is no thing. */
static int is_viewer(const struct tokens *t, struct capture of)
{
	return tokens_class(t, of.end - 1) == CLOSED_PRONOUN || tokens_class(t, of.end - 1) == CLOSED_NUMBER;
}

/* What a row asks of a number, n, of things, and by what it compares. */
static void take_how(struct question_asked *q, size_t row, int n)
{
#define IS(word) (!strcmp(rows[row].how, word))
	const int is_fewer = IS("fewer");

	q->is_denied = IS("none");
	if (IS("near"))
		q->relation = PARSE_NEAR;
	if (IS("above"))
		q->relation = PARSE_ABOVE;
	if (strchr(rows[row].said, '#')) {
		q->most = is_fewer ? n - 1 : IS("exactly") || IS("most") ? n : 0;
		q->least = is_fewer || IS("most") ? 0 : n + IS("more");
	} else {
		q->least = q->kind == QUESTION_TALLY	  ? !IS("enough")
			   : q->kind == QUESTION_MAJORITY ? (is_fewer ? -1 : 1)
							  : IS("kinds") || IS("only");
	}
#undef IS
}

/* Where a place's thing begins: at "the mug" of "to the right of the mug". */
static int find_object(const struct tokens *t, struct capture of)
{
	static const unsigned before = 1U << CLOSED_PLACE | 1U << CLOSED_PREPOSITION | 1U << CLOSED_SIZE;
	int i = of.begin;

	while (i < of.end &&
		(tokens_is(t, i, "than") || (tokens_class(t, i) >= 0 && before >> tokens_class(t, i) & 1) ||
			(tokens_class(t, i) == CLOSED_DETERMINER && i + 1 < of.end &&
				tokens_class(t, i + 1) == CLOSED_PLACE)))
		i++;
	return i;
}

/* "Left or right of the mug" is left of the mug, too. */
static void add_object(char to[QUESTION_TEXT], const struct matching *m, const char *text)
{
	const struct tokens *t = m->tokens;
	const struct capture first = m->of[CAPTURE_B], second = m->of[CAPTURE_C];
	const int at = find_object(t, second), last = first.end - 1;
	const size_t n = strlen(to);

	if (find_object(t, first) < first.end || at == second.end || at == second.begin)
		return;
	const char *of = tokens_class(t, last) == CLOSED_SIZE	       ? " than "
			 : tokens_is(t, last, "left|right|front|back") ? " of "
								       : " ";
	snprintf(to + n, QUESTION_TEXT - n, "%s%.*s", of,
		t->word[second.end - 1].span.end - t->word[at].span.begin, text + t->word[at].span.begin);
}

/* By what "the difference in height" compares. */
static int relation_of_noun(const struct tokens *t)
{
	for (int i = 0; i < t->n; i++)
		if (tokens_is(t, i, "height|width|length|size|space|room"))
			return tokens_is(t, i, "height")	 ? PARSE_TALLER
			       : tokens_is(t, i, "width|length") ? PARSE_WIDER
								 : PARSE_LARGER;
	return -1;
}

static void take(struct question_asked *q, size_t row, const struct matching *m, const char *text)
{
	const struct capture word = m->of[CAPTURE_WORD];
	const struct capture asks = word.end ? word : m->of[CAPTURE_B];
	int closed = -1;

	while (q->kind + 1 < QUESTION_KINDS && strcmp(names[q->kind], rows[row].kind) != 0)
		q->kind++;
	for (int i = asks.end; i-- > asks.begin;)
		if (word.end || (tokens_class(m->tokens, i) == CLOSED_PLACE && !is_side(closed)))
			closed = m->tokens->word[i].closed;
	q->relation = closed >= 0 ? closed_words[closed].relation : -1;
	if (q->kind == QUESTION_SET) /* "closest to the mug" is one */
		q->most = closed >= 0 && closed_words[closed].value == PARSE_MOST &&
			  (q->relation == PARSE_NEAR || q->relation == PARSE_FAR);
	if (q->kind == QUESTION_COMPARE) { /* "which of the mugs and jugs is the tallest?" */
		q->most = closed >= 0 && closed_words[closed].value == PARSE_MOST;
		for (int i = 0; i < m->tokens->n; i++)
			q->most &= !tokens_is(m->tokens, i, "are|'re|were");
	}
	if (!word.end && (q->kind == QUESTION_COMPARE || q->kind == QUESTION_SAME))
		q->relation = relation_of_noun(m->tokens);
	take_how(q, row,
		tokens_is(m->tokens, word.begin, "one") ? 1
		: closed < 0				? 0
							: closed_words[closed].value);
	const struct capture about = m->of[m->of[CAPTURE_A].end ? CAPTURE_A : CAPTURE_B];
	if (about.end)
		q->about = (struct parse_span){
			m->tokens->word[about.begin].span.begin, m->tokens->word[about.end - 1].span.end};
	if (m->of[CAPTURE_C].end && !is_viewer(m->tokens, m->of[CAPTURE_C]))
		fill(q->text[2], q->kind == QUESTION_EITHER ? "A that is C" : "C", m, text);
	for (int k = 0; k < 2; k++)
		if (strcmp(rows[row].asks[k], "-") != 0)
			fill(q->text[k], rows[row].asks[k], m, text);
		else
			snprintf(q->text[k], sizeof q->text[k], "%s", k ? "" : text);
	if (q->kind == QUESTION_EITHER)
		add_object(q->text[1], m, text);
	name_one(q);
}

/* "Roughly", and "would you say": they change nothing, wherever they stand. */
static int filler_length(const struct tokens *t, int i)
{
	static const char about[] = "roughly|approximately|exactly|approx|actually|please";
	static const char say[] = "say|think|guess|reckon|estimate|suppose";

	if (tokens_class(t, i) == CLOSED_AUXILIARY && tokens_is(t, i + 1, "you") && tokens_is(t, i + 2, say))
		return 3 + (!i && tokens_is(t, 3, "that"));
	if (!i && tokens_is(t, 0, "let") && tokens_is(t, 1, "'s"))
		return 2;
	if (!i && tokens_is(t, 0, "is") && tokens_is(t, 1, "it") &&
		tokens_is(t, 2, "true|right|correct|so") && tokens_is(t, 3, "that"))
		return 4;
	return tokens_is(t, i, about);
}

/* "Isn't it red?" asks what "is it red?" does. */
static int is_idle_denial(const struct tokens *t, int i)
{
	const int verb = tokens_class(t, 0);

	return i == 1 && tokens_is(t, i, "n't") &&
	       (verb == CLOSED_BE || verb == CLOSED_AUXILIARY || verb == CLOSED_HAVE);
}

static void leave_fillers(struct tokens *t)
{
	int n = 0;

	for (int i = 0; i < t->n; i++) {
		const int skip = is_idle_denial(t, i) ? 1 : filler_length(t, i);
		if (skip >= 3 && !i)
			memcpy(t->word[n++].text, "so", 3);
		if (skip)
			i += skip - 1;
		else
			t->word[n++] = t->word[i];
	}
	t->n = n;
}

/* The way-th way to read a question by a row: 1, 0 where there is no such way, -1 where no row fits. */
static int find_row(struct question_asked *q, const struct tokens *t, const char *text, int way)
{
	struct matching from = {.text = text, .tokens = t};
	int begins[TOKENS_MOST], n = 0; /* where a question may begin */

	*q = (struct question_asked){.relation = -1};
	while (from.idle_before < t->n && question_is_idle(t, from.idle_before))
		from.idle_before++;
	for (from.idle_after = t->n; from.idle_after && question_is_idle(t, from.idle_after - 1);)
		from.idle_after--;
	for (int at = 0; at < t->n; at++)
		if (at <= from.idle_before || question_is_break(t, text, at))
			begins[n++] = at;
	for (size_t row = 0; row < sizeof rows / sizeof *rows; row++)
		for (int i = 0; i < n; i++) {
			struct matching first = from, m = from;
			m.skip = way;
			if (!question_match(&first, rows[row].said, begins[i]))
				continue;
			if (!question_match(&m, rows[row].said, begins[i]))
				return 0;
			take(q, row, &m, text);
			return 1;
		}
	return -1;
}

static int find_kind(struct question_asked *q, const char *text, int way)
{
	char again[QUESTION_TEXT];
	struct tokens t;

	tokens_take(&t, text, NULL, NULL, 0);
	leave_fillers(&t);
	if (question_say_list(again, sizeof again, &t, text)) {
		*q = (struct question_asked){.kind = QUESTION_NUMBER, .relation = -1};
		snprintf(q->text[0], sizeof q->text[0], "%s", again);
		return !way;
	}
	int found = find_row(q, &t, text, way);
	if (found < 0 && question_say_again(again, sizeof again, &t, text)) {
		text = again;
		tokens_take(&t, text, NULL, NULL, 0);
		found = find_row(q, &t, text, way);
		q->about = (struct parse_span){0, 0};
	}
	if (found >= 0)
		return found;
	snprintf(q->text[0], sizeof q->text[0], "%s", text);
	if (question_wants_yes(&t, text))
		q->kind = QUESTION_THERE;
	return !way;
}

int question_read(struct question_asked *q, const char *text, int way)
{
	/* a question is read several times while it is answered */
	static _Thread_local struct question_asked last;
	static _Thread_local char last_text[QUESTION_TEXT];
	const size_t n = strlen(text);

	if (!way && n && !strcmp(text, last_text)) {
		*q = last;
		return 1;
	}
	const int found = find_kind(q, text, way);
	if (!way && n < sizeof last_text) {
		memcpy(last_text, text, n + 1);
		last = *q;
	}
	return found;
}

int question_is_any(const char *phrase)
{
	struct tokens t;

	tokens_take(&t, phrase, NULL, NULL, 0);
	return tokens_is(&t, 0, "a|an|any|some|one|anything|something|anyone|someone|anybody|somebody");
}

static int has_word(const char *text, const char *words)
{
	struct tokens t;
	int is = 0;

	tokens_take(&t, text, NULL, NULL, 0);
	for (int i = 0; i < t.n; i++)
		is |= tokens_is(&t, i, words);
	return is;
}

int question_is_open(const char *text)
{
	return has_word(text, "what|whatever|something|anything|everything|ones|things");
}

int question_is_yes_or_no(const char *text)
{
	struct tokens t;

	tokens_take(&t, text, NULL, NULL, 0);
	const int class = t.n ? tokens_class(&t, 0) : CLOSED_CLASSES;
	return class == CLOSED_BE || class == CLOSED_AUXILIARY;
}

int question_is_of_thing(const char *text)
{
	struct tokens t;

	tokens_take(&t, text, NULL, NULL, 0);
	for (int i = 0; i < t.n; i++)
		if (tokens_class(&t, i) == CLOSED_SIZE) /* "equally high" */
			return 0;
	return question_is_yes_or_no(text) && tokens_is(&t, 1, "the|this|that|these|those|my|your");
}

int question_is_half(const char *text)
{
	return has_word(text, "side|half|part");
}
