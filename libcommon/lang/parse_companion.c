/* "The tray and whatever is on it", "the jar together with what it stands on", "the mug and the saucer under
 * it": the second thing has a place by the first, which is the target, and often no name. */
#include "lang/analysis.h"
#include "lang/closed.h"

#include <stdlib.h>
#include <string.h>

/* Where such a thing is spoken of: the first word of "and" and the first one after it, the word of its place,
 * and whether it is said the other way round ("what it stands on"); the phrases that have the words of the
 * first thing and of the second, -1 where that has no name. */
struct companion {
	int joint, from, place, is_round, first, second;
};

static int relation_of(const struct parse *p, int word)
{
	const int closed = word >= 0 && word < p->word_count ? closed_find(p->words[word].text) : -1;

	return closed >= 0 && closed_words[closed].class == CLOSED_PLACE ? closed_words[closed].relation : -1;
}

/* The first word of "and", "together with" or "as well as" that ends before word i; or -1. */
static int joint_before(const struct parse *p, int i)
{
	if (parse_word_is(p, i - 1, "and|plus"))
		return i - 1;
	if (parse_word_is(p, i - 1, "with") && parse_word_is(p, i - 2, "together|along"))
		return i - 2;
	return parse_word_is(p, i - 1, "as") && parse_word_is(p, i - 2, "well") &&
			       parse_word_is(p, i - 3, "as")
		       ? i - 3
		       : -1;
}

/* Whether "it" is after a place: "under it", "to the left of it". */
static int is_by_it(const struct parse *p, int place)
{
	return parse_word_is(p, place + 1, "it|them") ||
	       (parse_word_is(p, place + 1, "of|to|from") && parse_word_is(p, place + 2, "it|them"));
}

/* The place of a thing that is spoken of from word `from` on: 1 and *c, or 0. */
static int find_place(const struct parse *p, int from, struct companion *c)
{
	const int last = p->word_count - 1;

	c->is_round = 0;
	for (c->place = from; c->place < last; c->place++)
		if (relation_of(p, c->place) >= 0 && is_by_it(p, c->place))
			return 1;
	for (int w = from; w < last && relation_of(p, last) >= 0; w++)
		c->is_round |= parse_word_is(p, w, "it|they");
	return c->is_round;
}

/* The last word of a phrase's noun among from..to-1; -1. */
static int noun_within(const struct parse *p, int phrase, int from, int to)
{
	const struct parse_list *noun = &p->phrases[phrase].noun;
	int last = -1;

	for (int i = 0; i < noun->n; i++)
		last = noun->item[i] >= from && noun->item[i] < to ? noun->item[i] : last;
	return last;
}

/* The phrase whose noun ends last among the words from..to-1; or -1. */
static int phrase_within(const struct parse *p, int from, int to)
{
	int best = -1, end = -1;

	for (int k = 0; k < p->phrase_count; k++)
		if (noun_within(p, k, from, to) > end) {
			best = k;
			end = noun_within(p, k, from, to);
		}
	return best;
}

/* Whether a word among from..to-1 is of one of the classes, bits. */
static int has_class(const struct parse *p, int from, int to, unsigned classes)
{
	for (int w = from; w < to; w++)
		if (classes >> closed_class_of(p, w) & 1)
			return 1;
	return 0;
}

/* "There's the laptop, and the cable behind it" tells where the cable is; so does what follows a pause. */
static int says_where(const struct parse *p, const struct companion *c)
{
	for (int w = 0; w < c->joint; w++)
		if (parse_word_is(p, w, "there|here|see|spot|locate|start|where|know"))
			return 1;
	for (int w = c->joint; w < c->place; w++)
		if (p->words[w + 1].span.begin > p->words[w].span.end + 1)
			return 1;
	return 0;
}

/* Whether both things are named, and nothing else can be what "it" is. */
static int are_named(const struct parse *p, const struct companion *c)
{
	const unsigned has = 1U << CLOSED_WITH | 1U << CLOSED_HAVE;

	return c->first >= 0 && c->second >= 0 && relation_of(p, c->place) != PARSE_BETWEEN &&
	       !has_class(p, 0, c->joint, has | 1U << CLOSED_PLACE) &&
	       !has_class(p, c->joint, c->place, has | 1U << CLOSED_NEGATION) &&
	       !has_class(p, c->joint, noun_within(p, c->second, c->from, c->place),
		       1U << CLOSED_BE | 1U << CLOSED_REQUEST);
}

static int find_companion(const struct parse *p, struct companion *c)
{
	for (int w = 1; w < p->word_count - 1; w++) {
		int head = w + 1;
		c->joint = joint_before(p, head);
		c->from = w + 1;
		if (c->joint < 1)
			continue;
		while (parse_word_is(p, head, "the|all|also"))
			head++;
		c->first = c->second = -1;
		const int is_named = !parse_word_is(
			p, head, "whatever|what|everything|anything|thing|things|something|stuff");
		if (!find_place(p, head + !is_named, c) || says_where(p, c))
			continue;
		if (!is_named)
			return 1;
		c->first = phrase_within(p, 0, c->joint);
		c->second = phrase_within(p, c->from, c->place);
		if (are_named(p, c))
			return 1;
	}
	return 0;
}

/* The clauses of a list that begin before word `from`. */
static void keep_clauses(const struct parse *p, struct parse_list *l, int from)
{
	int n = 0;

	for (int i = 0; i < l->n; i++)
		if (p->clauses[l->item[i]].span.begin < p->words[from].span.begin)
			l->item[n++] = l->item[i];
	l->n = n;
}

int parse_make_room(struct parse *p, struct err *e)
{
	struct parse_phrase *phrases = realloc(p->phrases, sizeof *phrases * (size_t)(p->phrase_count + 2));
	if (phrases)
		p->phrases = phrases;
	struct parse_clause *clauses =
		phrases ? realloc(p->clauses, sizeof *clauses * (size_t)(p->clause_count + 1)) : NULL;
	if (!clauses)
		return err_set(e, ERR_SYSTEM, "parse: out of memory");
	p->clauses = clauses;
	return 0;
}

/* A phrase as plain as may be. */
static struct parse_phrase plain(struct parse_span span, int count)
{
	return (struct parse_phrase){.span = span, .count = count, .from = PARSE_OTHER};
}

static void widen(const struct parse *p, struct parse_phrase *f, const struct parse_list *words)
{
	for (int i = 0; i < words->n; i++) {
		const struct parse_span *w = &p->words[words->item[i]].span;
		f->span.begin = f->span.end && f->span.begin < w->begin ? f->span.begin : w->begin;
		f->span.end = f->span.end > w->end ? f->span.end : w->end;
	}
}

/* A phrase's noun and attributes among the words from..to-1 become another's. */
static int take_words(const struct parse *p, struct parse_phrase *to, const struct parse_phrase *from,
	int begin, int end, struct err *e)
{
	struct parse_list noun = {0}, attributes = {0};
	int bad = 0;

	for (int i = 0; i < from->noun.n && !bad; i++)
		if (from->noun.item[i] >= begin && from->noun.item[i] < end)
			bad = parse_list_add(&noun, from->noun.item[i], e);
	for (int i = 0; i < from->attributes.n && !bad; i++)
		if (from->attributes.item[i] >= begin && from->attributes.item[i] < end)
			bad = parse_list_add(&attributes, from->attributes.item[i], e);
	free(to->noun.item);
	free(to->attributes.item);
	to->noun = noun;
	to->attributes = attributes;
	to->span = (struct parse_span){0};
	widen(p, to, &noun);
	widen(p, to, &attributes);
	return bad;
}

/* The target is the first thing: its words before "and". Returns 0 and *is_so, or -1. */
static int take_first(struct parse *p, const struct companion *c, int *is_so, struct err *e)
{
	struct parse_phrase *f = &p->phrases[0];

	*is_so = 1;
	if (c->second >= 0) {
		f->count = p->phrases[c->first].count;
		return take_words(p, f, &p->phrases[c->first], 0, c->joint, e);
	}
	parse_list_cut(&f->noun, c->joint);
	parse_list_cut(&f->attributes, c->joint);
	if (f->noun.n)
		return 0;
	/* "whatever" was taken for what is meant */
	*is_so = closed_find(p->words[c->joint - 1].text) < 0;
	parse_list_cut(&f->attributes, *is_so ? c->joint - 1 : c->joint);
	return *is_so ? parse_list_add(&f->noun, c->joint - 1, e) : 0;
}

/* Of the second thing where that has no name: "the thing under it" is one. */
static int count_second(const struct parse *p, const struct companion *c)
{
	int is_one = c->is_round;

	for (int w = c->from; w < c->place; w++)
		is_one |= parse_word_is(p, w, "thing|something");
	return is_one ? PARSE_ONE : PARSE_ALL;
}

int parse_companion(struct parse *p, struct err *e)
{
	struct companion c;
	int is_so;

	const struct parse_list *also = &p->phrases[0].also;
	if (!find_companion(p, &c) || also->n > 1 ||
		(c.second < 0 && also->n && p->phrases[also->item[0]].noun.n && p->phrases[0].noun.n))
		return 0;
	const int named = c.second >= 0 ? p->phrases[c.second].count : 0;
	struct parse_phrase words = {0};
	if (c.second >= 0 && take_words(p, &words, &p->phrases[c.second], c.from, c.place, e))
		return -1;
	const int bad = take_first(p, &c, &is_so, e) || (is_so && parse_make_room(p, e));
	if (bad || !is_so) {
		free(words.noun.item);
		free(words.attributes.item);
		return bad ? -1 : 0;
	}
	keep_clauses(p, &p->phrases[0].clauses, c.joint);
	parse_list_cut(&p->unexplained, c.joint);
	struct parse_phrase *f = &p->phrases[0];
	const int is_new = !f->also.n, other = is_new ? p->phrase_count : f->also.item[0];
	const int again = p->phrase_count + is_new, clause = p->clause_count;
	const int place = closed_find(p->words[c.place].text);
	const enum parse_relation r = (enum parse_relation)closed_words[place].relation;
	if (is_new)
		p->phrases[other] = plain(p->words[c.from].span, PARSE_ONE);
	struct parse_phrase *second = &p->phrases[other];
	second->count = c.second >= 0 ? named : count_second(p, &c);
	second->clauses.n = 0;
	free(second->noun.item);
	free(second->attributes.item);
	second->span = c.second >= 0 ? words.span : second->span;
	second->noun = words.noun;
	second->attributes = words.attributes;
	p->phrases[again] = plain(f->span, f->count);
	p->clauses[clause] = (struct parse_clause){.span = p->words[c.place].span,
		.relation = c.is_round ? closed_inverse(r) : r,
		.degree = c.is_round ? PARSE_PLAIN : (enum parse_degree)closed_words[place].value};
	p->phrase_count = again + 1;
	p->clause_count++;
	return parse_list_add(&p->clauses[clause].anchors, again, e) ||
			       parse_list_add(&second->clauses, clause, e) ||
			       parse_list_join(&p->phrases[again].noun, &f->noun, e) ||
			       parse_list_join(&p->phrases[again].attributes, &f->attributes, e) ||
			       parse_list_join(&p->phrases[again].clauses, &f->clauses, e) ||
			       (is_new && parse_list_add(&f->also, other, e))
		       ? -1
		       : 0;
}
