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
	"height", "width", "size", "compare", "more", "either", "there", "whether", "set", "tally", "even",
	"majority", "surplus", "same", "when", "then", "speed"};

static const char *const class_names[CLOSED_CLASSES] = {
	[CLOSED_BE] = "be", [CLOSED_AUXILIARY] = "do", [CLOSED_PRONOUN] = "pronoun", [CLOSED_HAVE] = "have"};

/* The words that a capture holds: from one token up to another. */
struct capture {
	int begin, end;
};

enum { CAPTURE_A, CAPTURE_B, CAPTURE_C, CAPTURE_WORD, CAPTURES };

struct matching {
	const char *text;
	const struct tokens *tokens;
	struct capture of[CAPTURES];
	int skip;		     /* ways that are passed over */
	int idle_before, idle_after; /* up to which word all are idle, and from which on */
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

/* Whether a sentence or a part of one ends before a word. */
static int is_break(const struct tokens *t, const char *text, int at)
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

	return at && at < t->n && t->n - at <= ASIDE_WORDS && is_break(t, text, at) && !is_listed(t, at) &&
	       (class < 0 || !(more >> class & 1));
}

/* Whether a word says nothing more of what is asked for, before it or behind it. */
static int is_idle(const struct tokens *t, int i)
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

static int match(struct matching *m, const char *said, int at);

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
		if (!tokens_is(m->tokens, end - 1, "the|my|your") && match(m, rest, end))
			return 1;
		if (end < m->tokens->n && is_break(m->tokens, m->text, end) && !is_listed(m->tokens, end))
			break;
	}
	return 0;
}

/* The rest of a row from token `at` on. */
static int match(struct matching *m, const char *said, int at)
{
	size_t length = strcspn(said, " ");
	const char *rest = said + length + (said[length] == ' ');

	if (!length)
		return (at >= m->idle_after || is_aside(m->tokens, m->text, at)) && !m->skip--;
	if (*said == ',') {
		if (at == m->tokens->n || !at || !is_break(m->tokens, m->text, at))
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
		if (match(m, rest, at + 1))
			return 1;
		m->of[CAPTURE_WORD] = before;
	}
	return is_free && match(m, rest, at);
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
		const int begin = m->tokens->word[of.begin].span.begin,
			  end = m->tokens->word[of.end - 1].span.end;
		n += (size_t)snprintf(to + n, QUESTION_TEXT - n, "%.*s", end - begin, text + begin);
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
			memcpy(q->text[1], text, sizeof text);
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

/* What a row's words say of how many; n: its number. */
static void take_numbers(struct question_asked *q, const char *said, int n)
{
	const int is_fewer = strstr(said, "fewer") != NULL;

	q->is_denied = q->kind == QUESTION_THERE &&
		       (strstr(said, " no ") || strstr(said, "nothing") || strstr(said, "none"));
	if (strchr(said, '#')) {
		q->most = is_fewer ? n - 1 : strstr(said, "exactly") || strstr(said, "at most") ? n : 0;
		q->least = is_fewer || strstr(said, "at most") ? 0 : n + (strstr(said, "more") != NULL);
	}
	if (q->kind == QUESTION_NUMBER)
		q->least = strstr(said, "kinds") != NULL;
	if (q->kind == QUESTION_WHETHER)
		q->least = strstr(said, "only") != NULL;
	if (q->kind == QUESTION_TALLY)
		q->least = !strstr(said, "enough");
	if (q->kind == QUESTION_MAJORITY)
		q->least = is_fewer ? -1 : 1;
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
		if (tokens_is(t, i, "height|width|length|size"))
			return tokens_is(t, i, "height") ? PARSE_TALLER
			       : tokens_is(t, i, "size") ? PARSE_LARGER
							 : PARSE_WIDER;
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
	if (strstr(rows[row].said, "nearer|closer A"))
		q->relation = PARSE_NEAR;
	if (strstr(rows[row].said, "far above|"))
		q->relation = PARSE_ABOVE;
	if (strstr(rows[row].said, "difference") || strstr(rows[row].said, "same|equal"))
		q->relation = relation_of_noun(m->tokens);
	take_numbers(q, rows[row].said,
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
		return 3;
	if (!i && tokens_is(t, 0, "is") && tokens_is(t, 1, "it") &&
		tokens_is(t, 2, "true|right|correct|so") && tokens_is(t, 3, "that"))
		return 4;
	return tokens_is(t, i, about);
}

static void leave_fillers(struct tokens *t)
{
	int n = 0;

	for (int i = 0; i < t->n; i++) {
		const int skip = filler_length(t, i);
		if (skip == 4)
			memcpy(t->word[n++].text, "so", 3);
		if (skip)
			i += skip - 1;
		else
			t->word[n++] = t->word[i];
	}
	t->n = n;
}

static int find_kind(struct question_asked *q, const char *text, int way)
{
	struct tokens t;
	struct matching from = {.text = text, .tokens = &t};

	*q = (struct question_asked){.relation = -1};
	tokens_take(&t, text, NULL, NULL, 0);
	leave_fillers(&t);
	while (from.idle_before < t.n && is_idle(&t, from.idle_before))
		from.idle_before++;
	for (from.idle_after = t.n; from.idle_after && is_idle(&t, from.idle_after - 1);)
		from.idle_after--;
	int begins[TOKENS_MOST], n = 0; /* where a question may begin */
	for (int at = 0; at < t.n; at++)
		if (at <= from.idle_before || is_break(&t, text, at))
			begins[n++] = at;
	for (size_t row = 0; row < sizeof rows / sizeof *rows; row++)
		for (int i = 0; i < n; i++) {
			struct matching first = from, m = from;
			m.skip = way;
			if (!match(&first, rows[row].said, begins[i]))
				continue;
			if (!match(&m, rows[row].said, begins[i]))
				return 0;
			take(q, row, &m, text);
			return 1;
		}
	snprintf(q->text[0], sizeof q->text[0], "%s", text);
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

int question_is_half(const char *text)
{
	return has_word(text, "side|half|part");
}
