#include "lang/question_said.h"
#include "lang/wordnet.h"

#include <string.h>

int asked_is_content(const struct tokens *t, int i)
{
	return i < t->n && tokens_class(t, i) < 0 && wordnet_is_noun(t->word[i].lemma) &&
	       !tokens_is(t, i, "make|makes|come|comes|lay|laid");
}

void asked_put(struct asked *q, const char *words)
{
	const size_t n = strlen(words);

	if (q->n + n < q->size) {
		memcpy(q->to + q->n, words, n + 1);
		q->n += n;
	}
}

void asked_put_part(struct asked *q, struct part p)
{
	const int begin = q->t->word[p.begin].span.begin, end = q->t->word[p.end - 1].span.end;

	if (q->n + (size_t)(end - begin) < q->size) {
		memcpy(q->to + q->n, q->text + begin, (size_t)(end - begin));
		q->n += (size_t)(end - begin);
		q->to[q->n] = 0;
	}
}

/* The end of the part of a sentence that begins at a token. */
int asked_end_of(const struct asked *q, int begin)
{
	int end = begin + 1;

	while (end < q->t->n && !question_is_break(q->t, q->text, end))
		end++;
	return end;
}

int asked_begin_of(const struct asked *q, int i)
{
	while (i > 0 && !question_is_break(q->t, q->text, i))
		i--;
	return i;
}

int asked_has_content(const struct tokens *t, struct part p)
{
	for (int i = p.begin; i < p.end; i++)
		if (asked_is_content(t, i) || is_class(t, i, CLOSED_GENERIC) || tokens_is(t, i, "everything"))
			return 1;
	return 0;
}

/* The things of a list, from a token on; returns how many. */
static int take_list(const struct asked *q, int at, struct part items[ITEMS])
{
	static const unsigned of_thing = 1U << CLOSED_DETERMINER | 1U << CLOSED_ATTRIBUTE | 1U << CLOSED_SIZE;
	const struct tokens *t = q->t;
	int n = 0;

	while (n < ITEMS) {
		int end = at;
		while (end < t->n && (tokens_class(t, end) < 0 || of_thing >> tokens_class(t, end) & 1) &&
			(end == at || (!question_is_break(t, q->text, end) &&
					      !is_class(t, end, CLOSED_DETERMINER))) &&
			!tokens_is(t, end, "vs|versus|or|and"))
			end++;
		if (end == at || !asked_is_content(t, end - 1))
			break;
		items[n++] = (struct part){at, end};
		at = end + tokens_is(t, end, "and|or|vs|versus");
		if (at == end && !(end < t->n && q->text[t->word[end - 1].span.end] == ','))
			break;
	}
	return n;
}

static const char order_verbs[] = "rank|order|sort|compare|arrange|put|line|list|take";

int asked_list(const struct asked *q, struct part best[ITEMS])
{
	struct part items[ITEMS];
	int n = 0;

	for (int at = 0; at < q->t->n; at++) {
		const int k = tokens_is(q->t, at, order_verbs) ? 0 : take_list(q, at, items);
		if (k > n)
			memcpy(best, items, sizeof items);
		n = k > n ? k : n;
	}
	return n;
}

/* By what is chosen, and which in that order. */
struct order {
	const char *word; /* "tallest"; NULL: none */
	char made[TOKEN_LENGTH];
	int at, place;	    /* its token, -1; the second, 0: the first */
	struct part anchor; /* of "nearer to the mug" */
};

/* "Greatest height": tallest. */
static const char *by_noun(const struct tokens *t, int noun)
{
	static const char *const words[][3] = {{"height", "tallest", "shortest"},
		{"width", "widest", "narrowest"}, {"length", "longest", "shortest"},
		{"size", "largest", "smallest"}};
	int is_least = 0;

	for (int i = 0; i < t->n; i++)
		is_least |=
			tokens_is(t, i, "least|lowest|smallest|shortest|less|lower|smaller|shorter|minimum");
	for (size_t k = 0; k < sizeof words / sizeof *words; k++)
		if (tokens_is(t, noun, words[k][0]))
			return words[k][1 + is_least];
	return NULL;
}

/* What something is nearer to: "nearer to the mug", "the mug's nearer neighbour". */
static struct part find_anchor(const struct asked *q, int at, struct part list)
{
	const struct tokens *t = q->t;
	int i = at;

	if (tokens_is(t, at + 1, "to|from")) {
		const int end = asked_end_of(q, at);
		return (struct part){at + 2, at < list.begin && list.begin < end ? list.begin : end};
	}
	if (!tokens_is(t, at - 1, "'s"))
		return (struct part){0, 0};
	while (i > 0 && !is_class(t, i, CLOSED_DETERMINER) && !is_class(t, i - 1, CLOSED_BE))
		i--;
	return (struct part){i, at - 1};
}

/* things: how many there are to choose from. */
static struct order find_order(const struct asked *q, struct part list, int things)
{
	const struct tokens *t = q->t;
	struct order o = {.at = -1};

	for (int i = 0; i < t->n; i++) {
		if (i >= list.begin && i < list.end)
			continue;
		const int class = tokens_class(t, i);
		const struct closed_word *w = class < 0 ? NULL : &closed_words[t->word[i].closed];
		const char *noun = by_noun(t, i);
		if (class == CLOSED_ORDINAL && w->value > 1)
			o.place = w->value;
		if (tokens_is(t, i, "middle"))
			o.place = (things + 1) / 2;
		if (noun)
			o.word = noun;
		else if ((class == CLOSED_SIZE || class == CLOSED_PLACE) && w->value != PARSE_PLAIN &&
			 !o.word) {
			o.word = t->word[i].text;
			o.at = i;
		}
	}
	if (o.at >= 0 && o.word == t->word[o.at].text)
		o.anchor = find_anchor(q, o.at, list);
	return o;
}

/* "Taller" is "tallest", of more than two. */
static void put_most(struct asked *q, const char *word)
{
	const size_t n = strlen(word);

	asked_put(q, word);
	if (n > 3 && !strcmp(word + n - 2, "er") && q->n >= 2) {
		q->n -= 2;
		asked_put(q, "est");
	}
}

void asked_put_list(struct asked *q, const struct part *items, int n, const char *last)
{
	for (int k = 0; k < n; k++) {
		asked_put(q, !k ? "" : k + 1 < n ? ", " : last);
		if (!is_class(q->t, items[k].begin, CLOSED_DETERMINER))
			asked_put(q, "the ");
		asked_put_part(q, items[k]);
	}
}

int asked_say_choice(struct asked *q)
{
	struct part best[ITEMS];
	const int n = asked_list(q, best);
	int is_asked = strpbrk(q->text, "?:") != NULL;

	for (int at = 0; at < q->t->n; at++)
		is_asked |= tokens_is(q->t, at, order_verbs);
	if (n < 2 || !is_asked)
		return 0;
	const struct order o = find_order(q, (struct part){best[0].begin, best[n - 1].end}, n);
	const int is_near = o.at >= 0 && (closed_words[q->t->word[o.at].closed].relation == PARSE_NEAR ||
						 closed_words[q->t->word[o.at].closed].relation == PARSE_FAR);
	const int is_placed = n > 2 || o.place;
	if (!o.word || o.place > n || (is_near && (is_placed || o.anchor.begin >= o.anchor.end)))
		return 0;
	if (is_placed) {
		static const char *const places[ITEMS + 1] = {
			"", "", "second ", "third ", "fourth ", "fifth ", "sixth ", "seventh ", "eighth "};
		asked_put(q, "the ");
		asked_put(q, places[o.place]);
		put_most(q, o.word);
		asked_put(q, " of ");
		asked_put_list(q, best, n, " and ");
		return 1;
	}
	asked_put(q, "which is ");
	asked_put(q, o.word);
	asked_put(q, tokens_is(q->t, o.at + 1, "up|down") ? " up" : "");
	if (is_near) {
		asked_put(q, " to ");
		asked_put_part(q, o.anchor);
	}
	asked_put(q, ", ");
	asked_put_list(q, best, n, " or ");
	return 1;
}
