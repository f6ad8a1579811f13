/* A row of a verb is looked for, and behind it rows of directions; what is said of all that stands anywhere.
 * Whose motion it is, and which thing it is about, is what the parse has of the words. */
#include "lang/motion_said.h"

#include "lang/closed.h"
#include "lang/motion_rows.h"
#include "lang/tokens.h"

#include <string.h>

static int class_in(const struct parse *p, int word, unsigned classes)
{
	const int class = closed_class_of(p, word);

	return class >= 0 && class < CLOSED_CLASSES && classes >> class & 1;
}

/* Whether a row of a verb is none here: "the roll", "a slow turn"; "still" that says only "until now"; "the
 * cup set down beside the bowl", which says where it is. */
static int is_noun(const struct parse *p, int at, const struct motion_row *r)
{
	static const unsigned before = 1U << CLOSED_DETERMINER | 1U << CLOSED_ATTRIBUTE | 1U << CLOSED_SIZE;
	const char *word = p->words[at].text;

	if (r->kind == MOTION_LOWERED && parse_word_is(p, at, "set|put|laid|placed") &&
		!class_in(p, at - 1,
			1U << CLOSED_BE | 1U << CLOSED_AUXILIARY | 1U << CLOSED_RELATIVE |
				1U << CLOSED_ADVERB) &&
		!parse_word_is(p, at - 1, "being|gets|got|and|then|later"))
		return 1;
	const int is_plain = !token_ends(word, "ing", 2) && !token_ends(word, "ed", 2);
	if (class_in(p, at - 1, 1U << CLOSED_PRONOUN) ||
		parse_word_is(p, at - 1, "i|let|'m|m|'re|re|'ll|please|ok|okay") ||
		(is_plain && ((at == 0 && !token_ends(word, "s", 2)) ||
				     (class_in(p, at, 1U << CLOSED_REQUEST) &&
					     !class_in(p, at - 1,
						     1U << CLOSED_AUXILIARY | 1U << CLOSED_RELATIVE)))))
		return !parse_word_is(
			p, at - 1, "it|they|he|she|itself"); /* "pass me the mug", "i go for the mug" */
	if (parse_word_is(p, at, "wait|pause|stop|rest|halt") &&
		(at == 0 || parse_word_is(p, at - 1, "no|oh|hey|so|now|well|um|er|erm|but")))
		return 1; /* "no wait, the mug" */
	if (parse_word_is(p, at, "still") && r->end == at + 1)
		return r->end < p->word_count && !class_in(p, at - 1, before) &&
		       !parse_word_is(p, r->end, "while|when|before|after|until|and|one|ones|thing");
	return r->kind != MOTION_STILL && is_plain && r->end == at + 1 && class_in(p, at - 1, before) &&
	       !parse_word_is(p, at - 1, "this|that");
}

/* In what way it moves, and nothing else. */
static int is_manner(const struct parse *p, int word)
{
	return word >= 0 && word < p->word_count &&
	       (token_ends(p->words[word].text, "ly", 3) ||
		       parse_word_is(p, word,
			       "again|fast|around|about|along|just|also|then|even|ever|once|there|being"));
}

/* The phrase whose noun, attribute or clause a word is of; -1: none has it. */
static int phrase_of(const struct parse *p, int word)
{
	for (int i = 0; i < p->phrase_count; i++) {
		const struct parse_phrase *f = &p->phrases[i];
		if (parse_list_has(&f->noun, word) || parse_list_has(&f->attributes, word))
			return i;
		for (int k = 0; k < f->clauses.n; k++)
			if (parse_list_has(&p->clauses[f->clauses.item[k]].words, word))
				return i;
	}
	return -1;
}

/* The last phrase that ends before a word. */
static int phrase_before(const struct parse *p, int word)
{
	int best = 0;

	for (int i = 0; i < p->phrase_count; i++) {
		const struct parse_span *s = &p->phrases[i].span;
		if (s->end > s->begin && s->end <= p->words[word].span.begin &&
			s->end > p->phrases[best].span.end)
			best = i;
	}
	return best;
}

/* Whose motion the words from `at` to end - 1 say: the parse's, or, of what it could not place, what stands
 * before "that" or a participle, else the target. */
static int whose(const struct parse *p, int at, int end)
{
	for (int i = at; i < end; i++)
		if (phrase_of(p, i) >= 0)
			return phrase_of(p, i);
	while (at > 0 && (is_manner(p, at - 1) ||
				 class_in(p, at - 1,
					 1U << CLOSED_BE | 1U << CLOSED_AUXILIARY | 1U << CLOSED_NEGATION)))
		at--;
	const int is_near = class_in(p, at - 1, 1U << CLOSED_RELATIVE) ||
			    token_ends(p->words[at].text, "ing", 2) || token_ends(p->words[at].text, "ed", 2);
	return is_near ? phrase_before(p, at) : 0;
}

enum { WHO_LOOKS = -1, NOTHING = -2 };

/* The phrase that begins at a word, but for an article. */
static int phrase_at(const struct parse *p, int word)
{
	while (class_in(p, word, 1U << CLOSED_DETERMINER | 1U << CLOSED_PREPOSITION))
		word++;
	for (int i = 1; i < p->phrase_count && word < p->word_count; i++) {
		const struct parse_span *s = &p->phrases[i].span;
		if (s->begin <= p->words[word].span.begin && s->end >= p->words[word].span.end)
			return p->phrases[i].viewer || p->phrases[i].scene ? WHO_LOOKS : i;
	}
	return class_in(p, word, 1U << CLOSED_PRONOUN) || parse_word_is(p, word, "camera|viewer") ? WHO_LOOKS
												  : NOTHING;
}

/* A row of a slot, with the other thing if it needs one. */
static int find_row(const struct parse *p, int at, int end, char slot, struct motion_row *r)
{
	return (motion_row_find(p, at, end, slot, 1, r) &&
		       (!r->has_other || phrase_at(p, r->end) != NOTHING)) ||
	       motion_row_find(p, at, end, slot, 0, r);
}

static int find_verb(const struct parse *p, int from, int end, struct motion_row *r)
{
	for (int i = from; i < end; i++)
		if (find_row(p, i, end, 'v', r) && !is_noun(p, i, r))
			return i;
	return -1;
}

static int is_negated(const struct parse *p, int at)
{
	for (int k = at - 1; k >= 0 && k >= at - 4; k--)
		if ((class_in(p, k, 1U << CLOSED_NEGATION) && !parse_word_is(p, k, "without")) ||
			parse_word_is(p, k, "nobody|none|nothing") ||
			(parse_word_is(p, k, "one") && parse_word_is(p, k - 1, "no")))
			return 1;
		else if (!is_manner(p, k) &&
			 !class_in(p, k, 1U << CLOSED_BE | 1U << CLOSED_AUXILIARY | 1U << CLOSED_HAVE))
			return 0;
	return 0;
}

static void add(
	struct motion_said *m, const struct parse *p, const struct motion_row *r, int phrase, int negated)
{
	if (m->n < MOTION_EVENTS)
		m->events[m->n++] = (struct motion_event){
			r->kind, negated, phrase, r->has_other ? phrase_at(p, r->end) : -1};
}

static void drop_words(struct parse_list *list, const char *taken)
{
	int n = 0;

	for (int k = 0; k < list->n; k++)
		if (!taken[list->item[k]])
			list->item[n++] = list->item[k];
	list->n = n;
}

/* The parse without words that are taken (words). */
static void strip(struct parse *p, const char *taken)
{
	for (int i = 0; i < p->phrase_count; i++) {
		struct parse_phrase *f = &p->phrases[i];
		int n = 0;
		drop_words(&f->noun, taken);
		drop_words(&f->attributes, taken);
		for (int k = 0; k < f->clauses.n; k++) {
			struct parse_list *words = &p->clauses[f->clauses.item[k]].words;
			const int had = words->n;
			drop_words(words, taken);
			if (words->n || !had)
				f->clauses.item[n++] = f->clauses.item[k];
		}
		f->clauses.n = n;
	}
	drop_words(&p->unexplained, taken);
}

/* "First", "the farthest": of what moves already, or "the fastest" of what may not be said to. */
static void take_ranks(struct motion_said *m, struct parse *p, char *taken)
{
	const int events = m->n;
	struct motion_row r;

	for (int k = 0; k < events; k++) { /* "the first box that moves" */
		struct parse_phrase *f = &p->phrases[m->events[k].phrase];
		if ((f->ordinal != 1 && f->ordinal != -1) || f->from != PARSE_OTHER)
			continue;
		r = (struct motion_row){f->ordinal == 1 ? MOTION_FIRST : MOTION_LAST, 0, 0};
		f->ordinal = 0;
		add(m, p, &r, m->events[k].phrase, 0);
	}
	for (int i = 0; i < p->word_count; i++) {
		if (taken[i] || (!motion_row_find(p, i, p->word_count, 'a', 0, &r) &&
					(!events || !motion_row_find(p, i, p->word_count, 'o', 0, &r))))
			continue;
		const int is_order = r.kind == MOTION_FIRST || r.kind == MOTION_LAST;
		const int has = m->n && m->events[m->n - 1].kind >= MOTION_FIRST;
		if ((is_order && has) || parse_word_is(p, r.end, "of|from"))
			continue;
		add(m, p, &r, events ? m->events[events - 1].phrase : whose(p, i, r.end), 0);
		memset(taken + i, 1, (size_t)(r.end - i));
	}
	for (int k = 0; k < events && m->n > events; k++) /* "starts first": it need not have been at rest */
		if (m->events[k].kind == MOTION_STARTS || m->events[k].kind == MOTION_STOPS)
			m->events[k].kind = MOTION_MOVES;
}

/* What stands before the first verb is what moves, where the parse has it as something else: "the ball
 * moves". */
static void take_subject(const struct motion_said *m, struct parse *p, int verb)
{
	const struct parse_phrase *f = p->phrases, was = *f;
	int k = 1;

	if (f->noun.n || f->attributes.n || f->clauses.n || verb >= p->word_count)
		return;
	while (k < p->phrase_count &&
		(!p->phrases[k].noun.n || p->phrases[k].span.end > p->words[verb].span.begin ||
			m->events[0].about == k))
		k++;
	if (k == p->phrase_count)
		return;
	p->phrases[0] = p->phrases[k];
	p->phrases[k] = was;
}

/* The word behind directions, and behind "the table" that they may be of: "to the left side of the table". */
static int behind_table(const struct parse *p, const struct motion_row *r)
{
	int at = r->end + (!r->has_other && parse_word_is(p, r->end, "of"));

	while (class_in(p, at, 1U << CLOSED_DETERMINER))
		at++;
	return parse_word_is(p, at, "table|tabletop|desk|ground|floor|surface|scene|picture") ? at + 1
											      : r->end;
}

/* Whether directions say more than their verb: not "rolls away", "falls onto the table". */
static int says_way(const struct motion_row *r, enum motion_kind verb, int behind)
{
	return r->kind != MOTION_TIME && (!r->has_other || behind == r->end) &&
	       (r->kind != MOTION_AWAY || r->has_other || verb == MOTION_MOVES);
}

/* "At rest and then moves": it starts; "moves and then rests": it stops. */
static void join_rests(struct motion_said *m)
{
	int rest = 0, n = 0;

	while (rest < m->n && (m->events[rest].kind != MOTION_STILL || m->events[rest].negated))
		rest++;
	for (int k = 0; k < m->n && m->n > 1 && rest < m->n; k++) {
		struct motion_event *v = &m->events[k];
		if (k == rest && !n && k + 1 == m->n)
			return;
		if (v->phrase == m->events[rest].phrase && v->kind <= MOTION_PAUSES && !v->negated)
			v->kind = k < rest ? MOTION_STOPS : k > rest ? MOTION_STARTS : v->kind;
		if (k != rest)
			m->events[n++] = *v;
	}
	m->n = n ? n : m->n;
}

int motion_said_take(struct motion_said *m, struct parse *p)
{
	char taken[TOKENS_MOST] = {0};
	struct motion_row r, verb;
	const int start = find_verb(p, 0, p->word_count, &verb) < 0 ? p->word_count
								    : find_verb(p, 0, p->word_count, &verb);

	m->n = 0;
	for (int at = 0; (at = find_verb(p, at, p->word_count, &verb)) >= 0;) {
		const int first = at, from = m->n, negated = is_negated(p, at);
		add(m, p, &verb, 0, negated);
		for (at = verb.end; at < p->word_count;) {
			if (find_row(p, at, p->word_count, 'd', &r) &&
				(r.has_other || behind_table(p, &r) > r.end ||
					!parse_word_is(p, r.end, "of|from"))) {
				at = behind_table(p, &r);
				if (says_way(&r, verb.kind, at))
					add(m, p, &r, 0, negated);
			} else if (is_manner(p, at)) {
				at++;
			} else {
				break;
			}
		}
		const int phrase = whose(p, first, at);
		for (int k = from; k < m->n; k++)
			m->events[k].phrase = phrase;
		memset(taken + first, 1, (size_t)(at - first));
		for (int k = first - 1; is_manner(p, k); k--)
			taken[k] = 1;
	}
	join_rests(m);
	take_ranks(m, p, taken);
	if (!m->n)
		return 0;
	strip(p, taken);
	take_subject(m, p, start);
	return m->n;
}

/* Whether a pause stands before a word. */
static int is_pause(const struct parse *p, const char *text, int word)
{
	for (int i = p->words[word - 1].span.end; i < p->words[word].span.begin; i++)
		if (strchr(",;:.", text[i]))
			return 1;
	return 0;
}

/* "Does the cup", "when is the cup": what is asked, in front. */
static int begin_of(const struct parse *p)
{
	static const unsigned asks = 1U << CLOSED_BE | 1U << CLOSED_AUXILIARY;
	int i = parse_word_is(p, 0, "when")						? 1
		: parse_word_is(p, 0, "at") && parse_word_is(p, 2, "time|moment|point") ? 3
											: 0;

	if (!class_in(p, i, asks) && !parse_word_is(p, i, "has|have"))
		return 0;
	return i + 1 + parse_word_is(p, i + 1, "there");
}

/* Whether words for a thing begin at a word. */
static int is_thing_at(const struct parse *p, int word)
{
	while (class_in(p, word, 1U << CLOSED_DETERMINER | 1U << CLOSED_ATTRIBUTE | 1U << CLOSED_SIZE))
		word++;
	return closed_class_of(p, word) == CLOSED_CLASSES;
}

int motion_said_cut(struct motion_cut *c, const struct parse *p, const char *text)
{
	struct motion_row r, verb;

	*c = (struct motion_cut){.begin = begin_of(p), .end = p->word_count, .when = MOTION_NONE};
	if (find_verb(p, 0, p->word_count, &verb) < 0)
		c->begin = 0;
	for (int i = c->begin; i < p->word_count && c->when == MOTION_NONE; i++) {
		int stop;
		if (!motion_row_find(p, i, p->word_count, 'w', 0, &r) || r.end >= p->word_count ||
			(parse_word_is(p, i, "as") && class_in(p, i - 1, 1U << CLOSED_SIZE)))
			continue;
		for (stop = r.end + 1; stop < p->word_count && !is_pause(p, text, stop); stop++)
			;
		/* "after the box": after it moves */
		const int is_thing = r.kind != MOTION_WHILE || r.end > i + 2;
		if (find_verb(p, r.end, stop, &verb) < 0 &&
			(!is_thing || find_verb(p, c->begin, i, &verb) < 0 || !is_thing_at(p, r.end) ||
				motion_row_find(p, i, p->word_count, 'o', 0, &verb)))
			continue;
		if (i == c->begin && stop == p->word_count)
			stop = verb.end;
		if (i == c->begin && stop == p->word_count)
			continue;
		*c = (struct motion_cut){i == c->begin ? stop : c->begin, i == c->begin ? p->word_count : i,
			r.kind, r.end, stop};
	}
	return c->begin > 0 || c->when != MOTION_NONE;
}
