/* What a parse still has wrong once it is built, and its own words tell: of what group one thing is meant,
 * what the thing is compared with, and from where one counts. */
#include "lang/analysis.h"
#include "lang/closed.h"
#include "lang/kinds.h"

#include <stdlib.h>
#include <string.h>

static int is(const struct parse *p, int word, const char *text)
{
	return word >= 0 && word < p->word_count && !strcmp(p->words[word].text, text);
}

static int class_of(const struct parse *p, int word)
{
	const int closed = word >= 0 && word < p->word_count ? closed_find(p->words[word].text) : -1;

	return closed < 0 ? -1 : (int)closed_words[closed].class;
}

/* "the first two hooks" are two, but "of my two coats the second" is one of two. */
static void settle_ordinal(const struct parse *p, struct parse_phrase *f)
{
	if (!f->ordinal || f->count == PARSE_ONE)
		return;
	for (int w = 0; w + 1 < p->word_count; w++)
		if (class_of(p, w) == CLOSED_ORDINAL && class_of(p, w + 1) == CLOSED_NUMBER)
			return;
	f->group = f->group ? f->group : f->count;
	f->count = PARSE_ONE;
}

/* Whether one of the words after `from`, up to the noun of a phrase, is `text`. */
static int is_before(const struct parse *p, int from, const struct parse_phrase *f, const char *text)
{
	const int end = f->noun.n ? f->noun.item[f->noun.n - 1] : from + 4;

	for (int w = from + 1; w <= end; w++)
		if (is(p, w, text))
			return 1;
	return 0;
}

static void move_list(struct parse_list *to, struct parse_list *from)
{
	free(to->item);
	*to = *from;
	*from = (struct parse_list){0};
}

/* "the taller of those three vases" is a vase, and "wider than the rest of the shelves" a shelf: the widest.
 */
static void settle_comparison(struct parse *p, struct parse_phrase *f, struct parse_clause *c)
{
	struct parse_phrase *a;

	if (c->degree == PARSE_PLAIN || c->anchors.n != 1 || c->words.n < 1)
		return;
	a = &p->phrases[c->anchors.item[0]];
	const int at = c->words.item[0];
	const int is_of = is(p, at + 1, "of") && (a->count != PARSE_ONE || a->group);
	const int is_rest =
		c->degree == PARSE_MORE && (is_before(p, at, a, "other") || is_before(p, at, a, "others") ||
						   is_before(p, at, a, "rest"));
	if ((!is_of && !is_rest) || a->clauses.n || a == f)
		return;
	if (!f->noun.n)
		move_list(&f->noun, &a->noun);
	if (!f->attributes.n)
		move_list(&f->attributes, &a->attributes);
	if (is_of && !f->group)
		f->group = a->count != PARSE_ONE ? a->count : a->group;
	c->degree = PARSE_MOST;
	c->anchors.n = 0;
}

/* "rounder than anything else on the shelf" is the one thing that is round, "rounder than any other jar" a
 * jar: -1 only where memory is out. */
static int settle_than(struct parse *p, struct parse_phrase *f, struct err *e)
{
	static const char *const any[] = {"anything", "everything", "any", "all", "every", NULL};
	int than = 1;

	while (than + 1 < p->word_count && !is(p, than, "than"))
		than++;
	if (!parse_word_is(p, than + 1, any))
		return 0;
	const char *word = p->words[than - 1].text;
	const size_t length = strlen(word);
	if (length < 4 || strcmp(word + length - 2, "er") != 0 || closed_find(word) >= 0)
		return 0;
	const int is_noun = f->noun.n && f->noun.item[f->noun.n - 1] == than - 1;
	f->count = PARSE_ONE;
	parse_list_cut(&f->noun, than - is_noun);
	parse_list_cut(&f->attributes, than - 1);
	parse_list_cut(&p->unexplained, than - 1);
	if (f->except.n && !f->noun.n)
		move_list(&f->noun, &p->phrases[f->except.item[0]].noun);
	f->except.n = 0;
	return parse_list_add(&f->attributes, than - 1, e);
}

/* "both the jar and the lamp" are two, not two jars and a lamp. */
static void settle_both(const struct parse *p, struct parse_phrase *f)
{
	const struct parse_word *noun = f->noun.n ? &p->words[f->noun.item[f->noun.n - 1]] : NULL;

	if (noun && strcmp(noun->text, noun->lemma) != 0) /* "both plates and the jug" are three */
		return;
	for (int w = 0; w < p->word_count && f->count == 2 && f->also.n == 1; w++)
		if (is(p, w, "both") && f->noun.n && w < f->noun.item[0])
			f->count = PARSE_ONE;
}

/* "the tallest but one" is the second tallest; "of all the jars the tallest" is one jar. */
static void settle_superlative(const struct parse *p, struct parse_phrase *f)
{
	for (int k = 0; k < f->clauses.n; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		if (c->degree != PARSE_MOST || c->words.n < 1)
			continue;
		for (int w = c->words.item[0] + 1; w + 1 < p->word_count; w++)
			if (is(p, w, "but") && class_of(p, w + 1) == CLOSED_NUMBER)
				f->ordinal = 1 + closed_words[closed_find(p->words[w + 1].text)].value;
			else if (is(p, w, "but") && is(p, w + 1, "one"))
				f->ordinal = 2;
		for (int w = 0; w + 1 < c->words.item[0] && f->count == PARSE_ALL; w++)
			if (is(p, w, "of") && is(p, w + 1, "all")) {
				f->count = PARSE_ONE;
				f->group = PARSE_SEVERAL;
			}
	}
}

/* "from the lamp, the farthest jar" is farthest from the lamp, and "starting from the lamp, the second jar"
 * second nearest to it. */
static int settle_view(struct parse *p, struct parse_phrase *f, struct err *e)
{
	struct parse_clause *grown, nearest = {.relation = PARSE_NEAR, .degree = PARSE_MOST};

	if (p->view != PARSE_VIEW_FROM || p->view_phrase < 1)
		return 0;
	for (int k = 0; k < f->clauses.n; k++) {
		struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		if ((c->relation == PARSE_NEAR || c->relation == PARSE_FAR) && c->degree != PARSE_PLAIN &&
			!c->anchors.n)
			return parse_list_add(&c->anchors, p->view_phrase, e);
	}
	if (!f->ordinal || f->from != PARSE_OTHER)
		return 0;
	grown = realloc(p->clauses, sizeof *grown * (size_t)(p->clause_count + 1));
	if (!grown)
		return err_set(e, ERR_SYSTEM, "parse: out of memory");
	p->clauses = grown;
	nearest.span = p->phrases[p->view_phrase].span;
	p->clauses[p->clause_count++] = nearest;
	return parse_list_add(&f->clauses, p->clause_count - 1, e) ||
			       parse_list_add(&p->clauses[p->clause_count - 1].anchors, p->view_phrase, e)
		       ? -1
		       : 0;
}

/* "near the sink but not over it": an anchor "it" is the phrase before it, which is an anchor too. */
static int settle_it(struct parse *p, struct err *e)
{
	static const char *const it[] = {"it", "them", NULL};

	for (int k = 2; k < p->phrase_count; k++) {
		struct parse_phrase *f = &p->phrases[k];
		const struct parse_phrase *earlier = f - 1;
		if (f->noun.n != 1 || f->clauses.n || !parse_word_is(p, f->noun.item[0], it))
			continue;
		f->count = earlier->count;
		parse_list_cut(&f->noun, 0);
		parse_list_cut(&f->attributes, 0);
		if (parse_list_join(&f->noun, &earlier->noun, e) ||
			parse_list_join(&f->attributes, &earlier->attributes, e))
			return -1;
	}
	return 0;
}

/* The phrase that ends right before a relative word and a phrase that is left out, of those that a phrase's
 * clauses are to; or -1. */
static int described_before(
	const struct parse *p, const struct parse_phrase *f, const struct parse_phrase *out)
{
	static const char *const relative[] = {"that", "which", NULL};

	for (int k = 0; k < f->clauses.n; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		for (int j = 0; j < c->anchors.n; j++) {
			const struct parse_phrase *a = &p->phrases[c->anchors.item[j]];
			for (int w = 1; w < p->word_count && p->words[w].span.end < out->span.begin; w++)
				if (parse_word_is(p, w, relative) && p->words[w - 1].span.end == a->span.end)
					return c->anchors.item[j];
		}
	}
	return -1;
}

/* "whatever is on the tray that isn't the red one" is not on the red tray. */
static int settle_except(struct parse *p, struct err *e)
{
	struct parse_phrase *f = &p->phrases[0];
	int n = 0;

	for (int k = 0; k < f->except.n; k++) {
		const int out = f->except.item[k];
		struct parse_phrase *x = &p->phrases[out];
		const int of = f->noun.n ? -1 : described_before(p, f, x);
		if (of < 0) {
			f->except.item[n++] = out;
			continue;
		}
		if ((!x->noun.n && parse_list_join(&x->noun, &p->phrases[of].noun, e)) ||
			parse_list_add(&p->phrases[of].except, out, e))
			return -1;
	}
	f->except.n = n;
	return 0;
}

/* A jar of tea is a jar: what fills it only says which. */
static void settle_content(const struct parse *p, struct parse_phrase *f)
{
	const int content = f->noun.n ? f->noun.item[f->noun.n - 1] : 0;

	for (int k = 0; k < f->attributes.n && is(p, content - 1, "of"); k++) {
		int *const word = &f->attributes.item[k];
		if (*word == content - 2 && kinds_hold(p->words[*word].lemma)) {
			f->noun.item[f->noun.n - 1] = *word;
			*word = content;
			return;
		}
	}
}

int parse_settle(struct parse *p, struct err *e)
{
	struct parse_phrase *f = &p->phrases[0];

	for (int i = 0; i < p->phrase_count; i++)
		settle_content(p, &p->phrases[i]);

	settle_ordinal(p, f);
	settle_both(p, f);
	for (int k = 0; k < f->clauses.n; k++)
		settle_comparison(p, f, &p->clauses[f->clauses.item[k]]);
	settle_superlative(p, f);
	return parse_between(p, e) || settle_it(p, e) || settle_except(p, e) || settle_than(p, f, e) ||
			       settle_view(p, f, e) || parse_members(p, e) || parse_carried(p, e)
		       ? -1
		       : 0;
}
