/* A parse of an analysis. What an analysis does not say is told from the closed-class words around: how many
 * things a phrase means, ordinals, groups, degrees, and from where one looks. */
#include "base/mem.h"
#include "lang/analysis.h"
#include "lang/closed.h"
#include "lang/colours.h"
#include "lang/compared.h"
#include "lang/parse_private.h"
#include "lang/rules.h"

static int add_words(struct build *b)
{
	struct parse *p = b->p;

	p->words = mem_zalloc((size_t)b->t->n, sizeof *p->words, "words", b->e);
	if (!p->words)
		return -1;
	for (int i = 0; i < b->t->n; i++) {
		const struct token *w = &b->t->word[i];
		struct parse_word *out = &p->words[p->word_count++];
		*out = (struct parse_word){.span = w->span, .piece = w->piece, .pieces = w->pieces};
		out->text = mem_strdup(w->text, b->e);
		out->lemma = mem_strdup(w->lemma, b->e);
		if (!out->text || !out->lemma)
			return -1;
	}
	return 0;
}

static int add_phrases(struct build *b)
{
	struct parse *p = b->p;
	int n = 1;

	b->noun = -1;
	for (int i = 0; i < b->t->n; i++) {
		enum word_role r = b->a->word[i].role;
		b->phrase_of[i] = r == ROLE_TARGET ? 0 : role_is_phrase(r) ? n++ : -1;
		/* the first noun that names a kind is the target's */
		if (r == ROLE_TARGET &&
			(b->noun < 0 || (tokens_class(b->t, b->noun) >= 0 && tokens_class(b->t, i) < 0)))
			b->noun = i;
	}
	p->phrases = mem_zalloc((size_t)n, sizeof *p->phrases, "phrases", b->e);
	if (!p->phrases)
		return -1;
	p->phrase_count = n;
	for (int i = 0; i < n; i++)
		p->phrases[i].from = PARSE_OTHER;
	return 0;
}

/* Words that only lead to one that says something: "of red colour", "a piece of fruit", "mid-sized"; but
 * "coloured" by itself does. */
static int says_nothing(const struct tokens *t, int i)
{
	return tokens_is(t, i, "'s|side|hand|end|colour|color|piece|sized|shaped") ||
	       (tokens_is(t, i, "coloured|colored") && i && colour_word(t->word[i - 1].text) >= 0);
}

static void widen(struct parse_span *s, struct parse_span by)
{
	if (s->begin == s->end) {
		*s = by;
	} else {
		s->begin = by.begin < s->begin ? by.begin : s->begin;
		s->end = by.end > s->end ? by.end : s->end;
	}
}

static int add_noun(struct build *b, int head, struct parse_phrase *f)
{
	int first = head, owner = b->a->word[head].role == ROLE_TARGET ? ROOT : head;

	while (first > 0 && b->a->word[first - 1].role == ROLE_NAME && b->a->word[first - 1].head == owner &&
		!b->t->word[first].before)
		first--;
	widen(&f->span, b->t->word[head].span);
	if (!build_names_kind(b, head))
		return 0;
	for (int i = first; i <= head; i++) {
		widen(&f->span, b->t->word[i].span);
		if (parse_list_add(&f->noun, i, b->e))
			return -1;
	}
	return 0;
}

/* "the cup next to the red one": a red cup. */
static int name_ones(struct build *b)
{
	const struct parse_list *noun = &b->p->phrases[0].noun;

	for (int i = 0; i < b->t->n; i++) {
		if (b->phrase_of[i] <= 0 || !(tokens_is(b->t, i, "one|ones|twin|others") ||
						    tokens_class(b->t, i) == CLOSED_NUMBER))
			continue;
		for (int k = 0; k < noun->n; k++)
			if (parse_list_add(&b->p->phrases[b->phrase_of[i]].noun, noun->item[k], b->e))
				return -1;
	}
	return 0;
}

static int fill_phrases(struct build *b)
{
	for (int i = 0; i < b->t->n; i++) {
		if (b->phrase_of[i] < 0)
			continue;
		struct parse_phrase *f = &b->p->phrases[b->phrase_of[i]];
		if (b->phrase_of[i] == 0 && i != b->noun)
			continue;
		if (add_noun(b, i, f))
			return -1;
		f->viewer =
			b->phrase_of[i] && tokens_is(b->t, i, "us|me|you|i|myself|yourself|camera|viewer");
		f->scene = tokens_is(b->t, i, "room|scene") ||
			   (b->phrase_of[i] &&
				   tokens_is(b->t, i, "room|scene|photo|image|picture|table|desk|view|row") &&
				   tokens_is(b->t, i - 1, "the") && tokens_is(b->t, i - 2, "of"));
	}
	for (int i = 0; i < b->t->n; i++) {
		enum word_role r = b->a->word[i].role;
		int owner = build_phrase_under(b, b->a->word[i].head);
		if ((r != ROLE_ATTRIBUTE && r != ROLE_NAME) || owner < 0 || says_nothing(b->t, i) ||
			tokens_class(b->t, i) == CLOSED_CONJUNCTION)
			continue;
		struct parse_phrase *f = &b->p->phrases[owner];
		if (parse_list_has(&f->noun, i))
			continue;
		if (!f->span.end || b->t->word[i].span.end > f->span.begin - 20)
			widen(&f->span, b->t->word[i].span);
		if (parse_list_add(&f->attributes, i, b->e))
			return -1;
	}
	return name_ones(b);
}

/* By the words around a predicate: "furthest back", "more to the left", "the very left". */
static enum parse_degree degree_of(const struct build *b, int i)
{
	static const char most[] =
		"most|extreme|very|farthest|furthest|least|greatest|shortest|smallest|largest";
	const struct tokens *t = b->t;
	const char *w = t->word[i].text;
	int c = tokens_class(t, i);
	enum parse_relation r = b->a->word[i].relation;

	/* "on top of it" compares nothing */
	if (r == PARSE_ON || r == PARSE_SUPPORTS || r == PARSE_INSIDE || r == PARSE_WITH)
		return PARSE_PLAIN;
	/* "farthest from everything" is near nothing */
	if (r == PARSE_NEAR && b->a->word[i].negated && c == CLOSED_PLACE &&
		closed_words[t->word[i].closed].relation == PARSE_FAR)
		return PARSE_PLAIN;
	if (tokens_is(t, i, most) ||
		(r == PARSE_NEAR && tokens_is(t, i, "from"))) /* "second from the door" */
		return PARSE_MOST;
	if (r == PARSE_OTHER)
		return compared_at(t, i);
	if (c == CLOSED_PLACE || c == CLOSED_SIZE) {
		if (build_value(t, i))
			return (enum parse_degree)build_value(t, i);
	} else if (token_ends(w, "est", 3) || token_ends(w, "most", 3)) {
		return PARSE_MOST;
	} else if (token_ends(w, "er", 3) && tokens_is(t, i + 1, "than")) {
		return PARSE_MORE;
	}
	for (int j = i - 1; j >= 0 && j >= i - 3; j--) {
		if (b->a->word[j].role != ROLE_NONE || t->word[j + 1].before)
			break;
		if (tokens_is(t, j, most))
			return PARSE_MOST;
		if (tokens_is(t, j, "more|further|farther"))
			return PARSE_MORE;
	}
	const int is_end = tokens_is(t, i + 1, "hand") ? i + 2 : i + 1;
	if (tokens_is(t, i + 1, "most") || (r <= PARSE_RIGHT && tokens_is(t, is_end, "end")))
		return PARSE_MOST;
	return PARSE_PLAIN;
}

static int is_filler(const struct build *b, int i)
{
	int c = tokens_class(b->t, i);

	return i >= 0 && i < b->t->n && b->a->word[i].role == ROLE_NONE &&
	       (c == CLOSED_ADVERB || c == CLOSED_PREPOSITION || c == CLOSED_PLACE);
}

static struct parse_span predicate_span(const struct build *b, int i)
{
	int first = i, last = i;

	while (!b->t->word[first].before &&
		(is_filler(b, first - 1) || (tokens_is(b->t, first - 1, "the") && is_filler(b, first - 2))))
		first--;
	while (is_filler(b, last + 1) && !b->t->word[last + 1].before)
		last++;
	return (struct parse_span){b->t->word[first].span.begin, b->t->word[last].span.end};
}

static int is_nothing(const struct tokens *t, int i)
{
	return tokens_is(t, i, "nothing|nobody|none");
}

/* Whether a predicate says what a thing does or is for. */
static int says_use(const struct build *b, int i)
{
	return b->a->word[i].role == ROLE_PREDICATE && b->a->word[i].relation == PARSE_OTHER &&
	       compared_at(b->t, i) == PARSE_PLAIN;
}

/* Whether word j goes on with what a predicate before it says: "put on the road to warn drivers". */
static int tells_on(const struct build *b, int j)
{
	return !b->t->word[j].before && b->a->word[j].role == ROLE_NONE;
}

/* The clause of predicate i with the anchors `from` to `end` of those that it has; all where end is -1. */
static int add_clause(struct build *b, int i, int from, int end)
{
	struct parse *p = b->p;
	int figure = build_phrase_under(b, b->a->word[i].head), at = p->clause_count, k = 0;
	struct parse_clause *c = &p->clauses[at];

	if (figure < 0)
		figure = 0;
	*c = (struct parse_clause){.span = predicate_span(b, i),
		.relation = b->a->word[i].relation,
		.degree = degree_of(b, i),
		.negated = b->a->word[i].negated};
	p->clause_count++;
	if (parse_list_add(&c->words, i, b->e) || parse_list_add(&p->phrases[figure].clauses, at, b->e))
		return -1;
	for (int j = i + 1; says_use(b, i) && j < b->t->n && tells_on(b, j); j++)
		if (b->t->word[j].closed < 0 && parse_list_add(&c->words, j, b->e))
			return -1;
	for (int j = 0; j < b->t->n; j++) {
		if (b->a->word[j].role != ROLE_ANCHOR || b->a->word[j].head != i)
			continue;
		if (k >= from && (end < 0 || k < end)) {
			if (is_nothing(b->t, j))
				c->negated = 1;
			if (parse_list_add(&c->anchors, b->phrase_of[j], b->e))
				return -1;
		}
		k++;
	}
	return 0;
}

/* "near the desk and the chair" says two things; "between the desk and the chair" one, as "above" does. */
static int add_predicate(struct build *b, int i)
{
	int anchors = 0;

	for (int j = 0; j < b->t->n; j++)
		anchors += b->a->word[j].role == ROLE_ANCHOR && b->a->word[j].head == i;
	if (anchors < 2 || b->a->word[i].relation != PARSE_NEAR)
		return add_clause(b, i, 0, -1);
	for (int k = 0; k < anchors; k++)
		if (add_clause(b, i, k, k + 1))
			return -1;
	return 0;
}

static int add_clauses(struct build *b)
{
	int n = 0;

	for (int i = 0; i < b->t->n; i++)
		n += b->a->word[i].role == ROLE_PREDICATE || b->a->word[i].role == ROLE_ANCHOR;
	b->p->clauses = mem_zalloc((size_t)n, sizeof *b->p->clauses, "clauses", b->e);
	if (!b->p->clauses)
		return -1;
	for (int i = 0; i < b->t->n; i++)
		if (b->a->word[i].role == ROLE_PREDICATE && i != b->from && !build_is_way(b->t, i) &&
			!tokens_is(b->t, i, "room|scene|picture|photo") &&
			add_predicate(b, i)) /* "in the room" */
			return -1;
	return 0;
}

/* Whether a word is one of a predicate's. */
static int is_of_use(const struct build *b, int j)
{
	while (j > 0 && tells_on(b, j))
		j--;
	return says_use(b, j);
}

static int add_others(struct build *b)
{
	struct parse *p = b->p;

	for (int i = 0; i < b->t->n; i++) {
		enum word_role r = b->a->word[i].role;
		int bad = 0;
		if (r == ROLE_ALSO) {
			bad = parse_list_add(&p->phrases[0].also, b->phrase_of[i], b->e);
		} else if (r == ROLE_MEMBER) {
			bad = parse_list_add(&p->phrases[0].among, b->phrase_of[i], b->e);
		} else if (r == ROLE_EXCEPT) {
			int owner = build_phrase_under(b, b->a->word[i].head);
			bad = parse_list_add(
				&p->phrases[owner < 0 ? 0 : owner].except, b->phrase_of[i], b->e);
		} else if (r == ROLE_NONE && b->t->word[i].closed < 0 && !says_nothing(b->t, i) &&
			   !is_of_use(b, i)) {
			bad = parse_list_add(&p->unexplained, i, b->e);
		}
		if (bad)
			return -1;
	}
	return 0;
}

static void find_view(struct build *b)
{
	b->p->view_phrase = -1;
	for (int i = 0; i < b->t->n; i++) {
		if (b->a->word[i].role != ROLE_VIEW)
			continue;
		b->p->view_phrase = b->phrase_of[i];
		b->p->view = PARSE_VIEW_FACING;
		for (int j = i - 1; j >= 0 && j >= i - 5 && !b->t->word[j + 1].before; j--) {
			if (tokens_is(b->t, j, "facing|face|towards|toward"))
				break;
			if (tokens_is(b->t, j, "from|through|entering|enter|standing|in"))
				b->p->view = PARSE_VIEW_FROM;
		}
		return;
	}
}

int parse_build(
	struct parse *p, const struct analysis *a, const struct tokens *t, unsigned without, struct err *e)
{
	struct analysis own = *a;
	struct build b = {.p = p, .a = &own, .t = t, .e = e, .from = -1};

	if (rule_counts(without, RULE_from))
		analysis_take_from(&own, t);
	*p = (struct parse){.view_phrase = -1};
	if (add_words(&b) || add_phrases(&b) || fill_phrases(&b)) {
		parse_free(p);
		return -1;
	}
	parse_counts(&b, rule_counts(without, RULE_group));
	parse_ordinals(&b);
	if (add_clauses(&b) || add_others(&b)) {
		parse_free(p);
		return -1;
	}
	find_view(&b);
	p->confidence = t->n ? 1 - (double)p->unexplained.n / t->n : 0;
	if (parse_apply_rules(p, without, e)) {
		parse_free(p);
		return -1;
	}
	return 0;
}
