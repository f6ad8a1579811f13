/* "The tray and whatever is on it", "the jar together with what it stands on": the second thing has no name,
 * but its place by the first, which is the target. */
#include "lang/analysis.h"
#include "lang/closed.h"

#include <stdlib.h>
#include <string.h>

/* Where such a thing is spoken of: the first word of "and" and the first one after it, the word of its place,
 * and whether it is said the other way round ("what it stands on"). */
struct carried {
	int joint, from, place, is_round;
};

static int relation_of(const struct parse *p, int word)
{
	const int closed = word >= 0 && word < p->word_count ? closed_find(p->words[word].text) : -1;

	return closed >= 0 && closed_words[closed].class == CLOSED_PLACE ? closed_words[closed].relation : -1;
}

/* The first word of "and", "together with" or "as well as" that ends before word i; or -1. */
static int joint_before(const struct parse *p, int i)
{
	static const char *const plus[] = {"and", "plus", NULL}, *const with[] = {"with", NULL},
				 *const along[] = {"together", "along", NULL}, *const as[] = {"as", NULL},
				 *const well[] = {"well", NULL};

	if (parse_word_is(p, i - 1, plus))
		return i - 1;
	if (parse_word_is(p, i - 1, with) && parse_word_is(p, i - 2, along))
		return i - 2;
	return parse_word_is(p, i - 1, as) && parse_word_is(p, i - 2, well) && parse_word_is(p, i - 3, as)
		       ? i - 3
		       : -1;
}

static int find_carried(const struct parse *p, struct carried *c)
{
	static const char *const the[] = {"the", "all", "also", NULL}, *const it[] = {"it", "them", NULL},
				 *const they[] = {"it", "they", NULL};
	static const char *const things[] = {
		"whatever", "what", "everything", "anything", "thing", "things", "something", "stuff", NULL};
	const int last = p->word_count - 1;
	int head;

	for (int w = 1; w < last; w++) {
		const int joint = joint_before(p, w + 1);
		if (joint < 1)
			continue;
		for (head = w + 1; parse_word_is(p, head, the);)
			head++;
		if (!parse_word_is(p, head, things))
			continue;
		for (int i = head + 1; i < last; i++)
			if (relation_of(p, i) >= 0 && parse_word_is(p, i + 1, it)) {
				*c = (struct carried){joint, w + 1, i, 0};
				return 1;
			}
		if (relation_of(p, last) >= 0 &&
			(parse_word_is(p, head + 1, they) || parse_word_is(p, head + 2, they))) {
			*c = (struct carried){joint, w + 1, last, 1};
			return 1;
		}
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

static int copy_list(struct parse_list *to, const struct parse_list *from, struct err *e)
{
	for (int i = 0; i < from->n; i++)
		if (parse_list_add(to, from->item[i], e))
			return -1;
	return 0;
}

/* Room for two phrases and a clause more. */
static int make_room(struct parse *p, struct err *e)
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

int parse_carried(struct parse *p, struct err *e)
{
	static const char *const one[] = {"thing", "something", NULL};
	struct carried c;
	int is_one;

	struct parse_phrase *f = &p->phrases[0];
	if (!find_carried(p, &c) || f->also.n > 1 ||
		(f->also.n && p->phrases[f->also.item[0]].noun.n && f->noun.n))
		return 0;
	parse_list_cut(&f->noun, c.joint);
	parse_list_cut(&f->attributes, c.joint);
	if (!f->noun.n) { /* "whatever" was taken for what is meant */
		if (closed_find(p->words[c.joint - 1].text) >= 0)
			return 0;
		parse_list_cut(&f->attributes, c.joint - 1);
		if (parse_list_add(&f->noun, c.joint - 1, e))
			return -1;
	}
	is_one = c.is_round;
	for (int w = c.from; w < c.place; w++)
		is_one |= parse_word_is(p, w, one);
	keep_clauses(p, &f->clauses, c.joint);
	parse_list_cut(&p->unexplained, c.joint);
	if (make_room(p, e))
		return -1;
	f = &p->phrases[0];
	const int is_new = !f->also.n, other = is_new ? p->phrase_count : f->also.item[0];
	const int again = p->phrase_count + is_new, clause = p->clause_count;
	enum parse_relation r = (enum parse_relation)relation_of(p, c.place);
	if (is_new)
		p->phrases[other] = plain(p->words[c.from].span, PARSE_ONE);
	p->phrases[other].count = is_one ? PARSE_ONE : PARSE_ALL;
	p->phrases[other].noun.n = p->phrases[other].attributes.n = p->phrases[other].clauses.n = 0;
	p->phrases[again] = plain(f->span, f->count);
	p->clauses[clause] = (struct parse_clause){
		.span = p->words[c.place].span, .relation = c.is_round ? closed_inverse(r) : r};
	p->phrase_count = again + 1;
	p->clause_count++;
	return parse_list_add(&p->clauses[clause].anchors, again, e) ||
			       parse_list_add(&p->phrases[other].clauses, clause, e) ||
			       copy_list(&p->phrases[again].noun, &f->noun, e) ||
			       copy_list(&p->phrases[again].attributes, &f->attributes, e) ||
			       copy_list(&p->phrases[again].clauses, &f->clauses, e) ||
			       (is_new && parse_list_add(&f->also, other, e))
		       ? -1
		       : 0;
}
