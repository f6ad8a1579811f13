/* How many things a phrase means, told from the closed-class words around it. */
#include "lang/parse_private.h"

/* Words back from a head that belong to its phrase: articles, numbers, attributes. */
static int phrase_start(const struct build *b, int head)
{
	int i = head;

	while (i > 0 && !b->t->word[i].before) {
		int c = tokens_class(b->t, i - 1);
		enum word_role r = b->a->word[i - 1].role;
		if (!(r == ROLE_NAME || r == ROLE_ATTRIBUTE || c == CLOSED_DETERMINER || c == CLOSED_NUMBER ||
			    c == CLOSED_ORDINAL || c == CLOSED_SIZE || c == CLOSED_ATTRIBUTE ||
			    c == CLOSED_ADVERB ||
			    (c == CLOSED_PLACE && r == ROLE_PREDICATE &&
				    b->a->word[i - 1].head == b->a->word[head].head) ||
			    (tokens_is(b->t, i - 1, "of") && i > 1 &&
				    tokens_class(b->t, i - 2) == CLOSED_NUMBER)))
			break;
		i--;
	}
	return i;
}

static void count_phrase(struct build *b, int head, struct parse_phrase *f)
{
	const struct tokens *t = b->t;
	int start = phrase_start(b, head), number = 0, of;

	for (int i = start; i <= head && !(number > 1 && tokens_is(t, i, "of")); i++)
		if (tokens_class(t, i) == CLOSED_NUMBER && (!number || build_value(t, i) > 0))
			number = build_value(t, i);
	if (tokens_is(t, head, "everything|anything|whatever"))
		number = PARSE_ALL;
	if (!number && build_names_kind(b, head) && build_is_plural(t, head))
		number = PARSE_SEVERAL;
	if (!number &&
		tokens_is(t, head,
			"ones|shapes|things|objects|items|stuff|tableware|crockery|cutlery|those|these"))
		number = PARSE_SEVERAL;
	f->count = number ? number : PARSE_ONE;
	/* "of the two cups", "which of the cups", unless all are meant; not "think of both cups" */
	of = start - 1;
	if (tokens_is(t, of, "of") && f->count != PARSE_ONE && tokens_class(t, of - 1) != CLOSED_NUMBER &&
		f == &b->p->phrases[0] && !tokens_is(t, of - 1, "think")) {
		f->group = number;
		f->count = PARSE_ONE;
	}
}

static int is_left_out(const struct build *b, int i)
{
	const enum word_role role = b->a->word[i].role;

	return role == ROLE_EXCEPT ||
	       ((role == ROLE_ATTRIBUTE || role == ROLE_NAME || role == ROLE_PREDICATE) &&
		       b->a->word[i].head != ROOT);
}

static int is_degree(const struct tokens *t, int i)
{
	const int class = tokens_class(t, i);
	const size_t n = strlen(t->word[i].text);

	if (class == CLOSED_PLACE || class == CLOSED_SIZE)
		return build_value(t, i) != 0;
	return n > 5 && (!strcmp(t->word[i].text + n - 3, "est") || !strcmp(t->word[i].text + n - 4, "most"));
}

/* "Two mugs stand there. I want the smaller", "all my clamps: the very longest". */
static int compares_later(const struct build *b, int i)
{
	const struct tokens *t = b->t;
	const int is_end = i + 1 >= t->n || t->word[i + 1].before;
	const int before = tokens_is(t, i - 1, "very") ? i - 2 : i - 1;

	return b->a->word[i].role == ROLE_PREDICATE && b->a->word[i].head == ROOT &&
	       tokens_is(t, before, "the") && is_end && is_degree(t, i);
}

/* "The red one", but not "every last one", "one small plate" or "not the one". */
static int is_one(const struct build *b, int i)
{
	static const char which[] = "the|that|this|which|whichever|my|your|his|her|their";
	const struct tokens *t = b->t;
	int before = i - 1;

	if (!tokens_is(t, i, "one") || b->a->word[i].role != ROLE_NONE)
		return 0;
	if (tokens_is(t, i - 1, "every|each") || tokens_is(t, i - 2, "every|each") ||
		(tokens_is(t, i - 1, "the") && tokens_class(t, i - 2) == CLOSED_NEGATION))
		return 0;
	while (before > b->noun && !t->word[before + 1].before && !tokens_is(t, before, which))
		before--;
	const int is_number = i + 1 < t->n && !t->word[i + 1].before &&
			      (tokens_class(t, i + 1) < 0 || tokens_class(t, i + 1) == CLOSED_SIZE ||
				      tokens_class(t, i + 1) == CLOSED_ATTRIBUTE);
	return !is_number || tokens_is(t, before, which);
}

/* "Give me the other", "but mine is by the door"; "those are mine" picks none. */
static int picks(const struct tokens *t, int i)
{
	const int is_end = i + 1 >= t->n || t->word[i + 1].before;
	const int is_start = t->word[i].before || tokens_class(t, i - 1) == CLOSED_CONJUNCTION ||
			     tokens_class(t, i - 1) == CLOSED_EXCEPT || tokens_is(t, i - 1, "yet");

	return (tokens_is(t, i, "mine") && is_start && i + 1 < t->n && t->word[i + 1].before != PAUSE_STOP) ||
	       (tokens_is(t, i, "other") && is_end && tokens_is(t, i - 1, "the|that"));
}

/* "Two red chairs. Which one is ...": a later word of the target that means one of them. */
static void find_group(struct build *b)
{
	const struct tokens *t = b->t;
	struct parse_phrase *f = &b->p->phrases[0];
	int is_later = 0; /* a pause has come */

	if (f->count == PARSE_ONE || b->noun < 0)
		return;
	for (int i = b->noun + 1; i < t->n; i++) {
		is_later |= t->word[i].before == PAUSE_STOP;
		if (is_left_out(b, i) || (f->count == PARSE_ALL && !is_later))
			continue;
		if (tokens_is(t, i, "whichever") || compares_later(b, i) || is_one(b, i) || picks(t, i)) {
			f->group = f->count;
			f->count = PARSE_ONE;
			return;
		}
	}
}

void parse_counts(struct build *b, int groups)
{
	for (int k = 0; k < b->p->phrase_count; k++)
		b->p->phrases[k].count = PARSE_ONE;
	for (int i = 0; i < b->t->n; i++)
		if (b->phrase_of[i] > 0 || (b->phrase_of[i] == 0 && i == b->noun))
			count_phrase(b, i, &b->p->phrases[b->phrase_of[i]]);
	if (groups)
		find_group(b);
}
