#include "ask/wording.h"

#include "ask/constants.h"
#include "base/largest.h"
#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TARGET_WORDS = 32 };

void wording_free(struct wording *w)
{
	free(w->known);
	free(w->match);
	free(w->own);
	*w = (struct wording){0};
}

/* match (O): M of a word. */
static void match_word(struct wording *w, const struct vocabulary_sentence *s, int word, double *match)
{
	const size_t n = w->arrangement->n;

	vocabulary_cosine(w->vocabulary, s, word, w->own);
	for (size_t o = 0; o < n; o++) {
		match[o] = w->own[o];
		for (size_t k = 0; k < n; k++)
			match[o] = fmax(match[o],
				w->own[k] + WORDING_UNLIKE * arrangement_alike(w->arrangement, o, k));
	}
}

/* The words of a target, as far as they are no place. */
struct target {
	int n, head; /* head: its place among them, or -1 */
	int word[TARGET_WORDS];
};

static void add_words(struct target *t, struct parse_list words)
{
	for (int i = 0; i < words.n && t->n < TARGET_WORDS; i++)
		t->word[t->n++] = words.item[i];
}

/* Noun, attributes, and what it has or does: "with white dots", "that you type on". */
static struct target target_of(const struct parse *p)
{
	const struct parse_phrase *f = &p->phrases[0];
	struct target t = {0, f->noun.n - 1, {0}};

	add_words(&t, f->noun);
	add_words(&t, f->attributes);
	for (int k = 0; k < f->clauses.n; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		if (c->negated || (c->relation != PARSE_WITH && c->relation != PARSE_OTHER))
			continue;
		if (c->relation == PARSE_OTHER)
			add_words(&t, c->words);
		for (int j = 0; j < c->anchors.n; j++) {
			add_words(&t, p->phrases[c->anchors.item[j]].noun);
			add_words(&t, p->phrases[c->anchors.item[j]].attributes);
		}
	}
	t.head = t.head < t.n ? t.head : -1;
	return t;
}

/* score (O), and f of its best object. Returns how many words it went by. */
static int fit_words(struct wording *w, const struct vocabulary_sentence *s, double *score, double *fit)
{
	const size_t n = w->arrangement->n;
	const struct target t = target_of(s->parse);
	double sum = 0;

	memset(score, 0, n * sizeof *score);
	for (int i = 0; i < t.n; i++) {
		match_word(w, s, t.word[i], w->match);
		const double best = largest(w->match, n);
		for (size_t o = 0; o < n; o++)
			score[o] += WORDING_SHARP * (w->match[o] - best);
		sum += best;
		if (!vocabulary_colour(
			    w->vocabulary, w->arrangement, s->parse->words[t.word[i]].lemma, w->own))
			continue;
		const double fits = log(COLOUR_FLOOR + largest(w->own, n));
		for (size_t o = 0; o < n; o++)
			score[o] += WORDING_SHARP * WORDING_COLOUR * (log(COLOUR_FLOOR + w->own[o]) - fits);
	}
	if (!t.n)
		return 0;
	const size_t o = best_of(score, n);
	double total = 0;
	for (size_t k = 0; k < n; k++)
		total += exp(score[k] - score[o]);
	*fit = WORDING_ALL * sum / t.n - WORDING_PLAIN * log(total);
	for (int i = 0; i < t.n; i++) {
		if (i == t.head) {
			match_word(w, s, t.word[i], w->match);
			*fit += WORDING_HEAD * w->match[o];
		}
		if (vocabulary_colour(
			    w->vocabulary, w->arrangement, s->parse->words[t.word[i]].lemma, w->own))
			*fit += log((COLOUR_FLOOR + w->own[o]) / (COLOUR_FLOOR + COLOUR_USUAL));
	}
	return t.n;
}

double wording_judge(struct wording *w, const struct vocabulary_sentence *s, double *score)
{
	const size_t n = w->vocabulary->lifted->sentences;
	size_t below = 0;
	double fit;

	if (!fit_words(w, s, score, &fit))
		return 0;
	while (below < n && w->known[below] <= fit)
		below++;
	const double p = (double)(below + 1) / (double)(n + 1);
	return PRESENT_ODDS / (PRESENT_ODDS + ABSENT_SHAPE * pow(p, ABSENT_SHAPE - 1));
}

static int by_value(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;

	return (x > y) - (x < y);
}

int wording_make(struct wording *w, struct vocabulary *v, const struct arrangement *a, struct err *e)
{
	const struct lifted *l = v->lifted;

	*w = (struct wording){.vocabulary = v, .arrangement = a};
	w->known = mem_alloc(l->sentences, sizeof *w->known, "wording", e);
	w->match = mem_alloc(a->n, sizeof *w->match, "wording", e);
	w->own = mem_alloc(a->n, sizeof *w->own, "wording", e);
	double *score = mem_alloc(a->n, sizeof *score, "wording", e);
	const int bad = !w->known || !w->match || !w->own || !score;
	for (size_t r = 0; r < l->sentences && a->n && !bad; r++) {
		const struct vocabulary_sentence s = {&v->parses[r],
			l->words + (size_t)l->offsets[r] * (size_t)l->width,
			(size_t)(l->offsets[r + 1] - l->offsets[r])};
		v->without = r;
		if (!fit_words(w, &s, score, &w->known[r]))
			w->known[r] = -INFINITY;
	}
	v->without = l->sentences;
	if (l->sentences && !bad)
		qsort(w->known, l->sentences, sizeof *w->known, by_value);
	free(score);
	return bad ? -1 : 0;
}
