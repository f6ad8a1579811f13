#include "ask/wording.h"

#include "ask/constants.h"
#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void wording_free(struct wording *w)
{
	free(w->known);
	free(w->match);
	free(w->own);
	*w = (struct wording){0};
}

static double largest(const double *x, size_t n)
{
	double most = -INFINITY;

	for (size_t i = 0; i < n; i++)
		most = fmax(most, x[i]);
	return most;
}

static size_t best_of(const double *x, size_t n)
{
	size_t best = 0;

	for (size_t o = 1; o < n; o++)
		best = x[o] > x[best] ? o : best;
	return best;
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

/* The target's words: noun, then attributes; -1 after the last. */
static int target_word(const struct parse *p, int i)
{
	const struct parse_phrase *f = &p->phrases[0];

	if (i < f->noun.n)
		return f->noun.item[i];
	return i - f->noun.n < f->attributes.n ? f->attributes.item[i - f->noun.n] : -1;
}

/* score (O), and f of its best object. Returns how many words it went by. */
static int fit_words(struct wording *w, const struct vocabulary_sentence *s, double *score, double *fit)
{
	const size_t n = w->arrangement->n;
	const struct parse_phrase *f = &s->parse->phrases[0];
	int words = 0;
	double sum = 0;

	memset(score, 0, n * sizeof *score);
	for (int word; (word = target_word(s->parse, words)) >= 0; words++) {
		match_word(w, s, word, w->match);
		const double best = largest(w->match, n);
		for (size_t o = 0; o < n; o++)
			score[o] += WORDING_SHARP * (w->match[o] - best);
		sum += best;
		if (!vocabulary_colour(w->vocabulary, w->arrangement, s->parse->words[word].lemma, w->own))
			continue;
		const double fits = log(COLOUR_FLOOR + largest(w->own, n));
		for (size_t o = 0; o < n; o++)
			score[o] += WORDING_SHARP * WORDING_COLOUR * (log(COLOUR_FLOOR + w->own[o]) - fits);
	}
	if (!words)
		return 0;
	const size_t o = best_of(score, n);
	double total = 0;
	for (size_t k = 0; k < n; k++)
		total += exp(score[k] - score[o]);
	*fit = WORDING_ALL * sum / words - WORDING_PLAIN * log(total);
	for (int i = 0; i < words; i++) {
		const int word = target_word(s->parse, i);
		if (i + 1 == f->noun.n) {
			match_word(w, s, word, w->match);
			*fit += WORDING_HEAD * w->match[o];
		}
		if (vocabulary_colour(w->vocabulary, w->arrangement, s->parse->words[word].lemma, w->own))
			*fit += log((COLOUR_FLOOR + w->own[o]) / (COLOUR_FLOOR + COLOUR_USUAL));
	}
	return words;
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
