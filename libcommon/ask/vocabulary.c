#include "ask/vocabulary.h"

#include "base/mem.h"
#include "lang/colours.h"
#include "lang/phrases.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void vocabulary_free(struct vocabulary *v)
{
	free(v->mean);
	free(v->sentence_mean);
	free(v->vectors);
	free(v->begin);
	free(v->of);
	free(v->sentences);
	free(v->scratch);
	free(v->own);
	*v = (struct vocabulary){0};
}

static double length_of(const double *x, int width)
{
	double sum = 0;

	for (int d = 0; d < width; d++)
		sum += x[d] * x[d];
	return sqrt(sum);
}

/* out (width) of length 1: the mean direction of a word's pieces, less the scene's mean. */
static void word_vector(struct vocabulary *v, const struct lang_word *w, const float *vectors, float *out)
{
	const int width = v->lifted->width;
	double *sum = v->scratch;

	memset(sum, 0, (size_t)width * sizeof *sum);
	for (int p = w->first; p < w->first + w->count; p++) {
		const float *x = vectors + (size_t)p * (size_t)width;
		double square = 0;
		for (int d = 0; d < width; d++)
			square += (x[d] - v->mean[d]) * (x[d] - v->mean[d]);
		for (int d = 0; d < width && square > 0; d++)
			sum[d] += (x[d] - v->mean[d]) / sqrt(square);
	}
	const double length = length_of(sum, width);
	for (int d = 0; d < width; d++)
		out[d] = length > 0 ? (float)(sum[d] / length) : 0;
}

/* out (width) of length 1: the mean of pieces, less `less`. */
static void sentence_vector(
	struct vocabulary *v, const float *vectors, size_t words, const double *less, float *out)
{
	const int width = v->lifted->width;
	double *sum = v->scratch;

	for (int d = 0; d < width; d++) {
		sum[d] = 0;
		for (size_t w = 0; w < words; w++)
			sum[d] += vectors[w * (size_t)width + (size_t)d];
		sum[d] = sum[d] / (double)(words ? words : 1) - less[d];
	}
	const double length = length_of(sum, width);
	for (int d = 0; d < width; d++)
		out[d] = length > 0 ? (float)(sum[d] / length) : 0;
}

/* Both means, of length not 1. */
static void find_means(struct vocabulary *v)
{
	const struct lifted *l = v->lifted;
	const size_t width = (size_t)l->width;

	for (size_t r = 0; r < l->sentences; r++) {
		const double words = (double)(l->offsets[r + 1] - l->offsets[r]);
		for (int64_t w = l->offsets[r]; w < l->offsets[r + 1]; w++)
			for (size_t d = 0; d < width; d++) {
				const double x = l->words[(size_t)w * width + d];
				v->mean[d] += x / (double)l->offsets[l->sentences];
				v->sentence_mean[d] += x / words / (double)l->sentences;
			}
	}
}

/* The target words of all training sentences of one object after another. */
static void keep_words(struct vocabulary *v, struct lang_sentence *s)
{
	const struct lifted *l = v->lifted;
	const size_t width = (size_t)l->width;

	for (size_t o = 0; o < l->objects; o++) {
		v->begin[o] = v->n;
		for (size_t r = 0; r < l->sentences; r++) {
			if ((size_t)l->object[r] != o)
				continue;
			lang_sentence_read(s, l->pieces[r]);
			for (int i = 0; i < s->target.n; i++) {
				v->of[v->n] = r;
				word_vector(v, &s->words[s->target.words[i]],
					l->words + (size_t)l->offsets[r] * width,
					v->vectors + width * v->n++);
			}
		}
	}
	v->begin[l->objects] = v->n;
}

int vocabulary_make(struct vocabulary *v, const struct lifted *l, struct err *e)
{
	const size_t width = (size_t)l->width;
	struct lang_sentence *s = mem_alloc(1, sizeof *s, "sentence", e);

	*v = (struct vocabulary){.lifted = l, .without = l->sentences};
	v->mean = mem_zalloc(width, sizeof *v->mean, "vocabulary", e);
	v->sentence_mean = mem_zalloc(width, sizeof *v->sentence_mean, "vocabulary", e);
	v->vectors = mem_alloc((size_t)l->offsets[l->sentences], width * sizeof *v->vectors, "vocabulary", e);
	v->begin = mem_alloc(l->objects + 1, sizeof *v->begin, "vocabulary", e);
	v->of = mem_alloc((size_t)l->offsets[l->sentences], sizeof *v->of, "vocabulary", e);
	v->sentences = mem_alloc(l->sentences + 1, width * sizeof *v->sentences, "vocabulary", e);
	v->scratch = mem_alloc(width, sizeof *v->scratch, "vocabulary", e);
	v->own = mem_alloc(l->objects, sizeof *v->own, "vocabulary", e);
	if (!s || !v->mean || !v->sentence_mean || !v->vectors || !v->begin || !v->of || !v->sentences ||
		!v->scratch || !v->own) {
		free(s);
		return -1;
	}
	find_means(v);
	keep_words(v, s);
	for (size_t r = 0; r < l->sentences; r++)
		sentence_vector(v, l->words + (size_t)l->offsets[r] * width,
			(size_t)(l->offsets[r + 1] - l->offsets[r]), v->sentence_mean,
			v->sentences + r * width);
	free(s);
	return 0;
}

static double dot(const float *a, const float *b, size_t n)
{
	double sum = 0;

	for (size_t i = 0; i < n; i++)
		sum += (double)a[i] * b[i];
	return sum;
}

static char lower(char c)
{
	return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* Whether a word, or it without an s at its end, is a word of a name. */
static int is_in_name(const char *word, const char *name)
{
	const size_t length = strlen(word);

	for (const char *p = name; *p; p += strspn(p, " -_")) {
		size_t n = strcspn(p, " -_"), same = 0;
		while (same < n && same < length && lower(p[same]) == word[same])
			same++;
		if (n && same == n && (length == n || (length == n + 1 && word[n] == 's')))
			return 1;
		p += n;
	}
	return 0;
}

void vocabulary_match(struct vocabulary *v, const struct lang_word *w, const float *vectors, int words,
	int names, const struct arrangement *alike, double *match)
{
	const struct lifted *l = v->lifted;
	const size_t width = (size_t)l->width;
	float *mine = v->sentences + l->sentences * width;

	word_vector(v, w, vectors, mine);
	for (size_t o = 0; o < l->objects; o++) {
		double best = -1;
		for (size_t i = v->begin[o]; i < v->begin[o + 1] && words; i++)
			if (v->of[i] != v->without)
				best = fmax(best, dot(mine, v->vectors + i * width, width));
		best = best < -0.999 ? 0 : best;
		if (names && is_in_name(w->text, l->names[o]))
			best = fmax(best, VOCABULARY_NAME);
		v->own[o] = best;
	}
	for (size_t o = 0; o < l->objects; o++) {
		match[o] = v->own[o];
		for (size_t k = 0; k < l->objects && alike; k++)
			match[o] = fmax(
				match[o], v->own[k] + VOCABULARY_UNLIKE * arrangement_alike(alike, o, k));
	}
}

int vocabulary_colour(const struct arrangement *a, const struct lang_word *w, double *fit)
{
	const int colour = colour_word(w->text);
	double lab[3];

	if (colour < 0)
		return 0;
	colour_word_lab(colour, lab);
	for (size_t o = 0; o < a->n; o++) {
		const struct arranged *p = &a->objects[o];
		fit[o] = 0;
		for (size_t i = 0; i < p->colours; i++)
			fit[o] += p->part[i] * colour_fit(p->palette + 3 * i, lab);
	}
	return 1;
}

/* -1 small, 0 medium, 1 large; anything else no word of size. */
static int size_word(const char *word)
{
	if (lang_is_one_of(word, "small little tiny miniature mini"))
		return -1;
	if (lang_is_one_of(word, "medium mid midsized"))
		return 0;
	return lang_is_one_of(word, "big large huge giant") ? 1 : 2;
}

static double bulk(const struct arranged *o)
{
	double sum = 0;

	for (int k = 0; k < 3; k++)
		sum += log(fmax(o->high[k] - o->low[k], 1e-6)) / 3;
	return sum;
}

int vocabulary_size(const struct arrangement *a, const struct lang_word *w, double *fit)
{
	const int expected = size_word(w->text);
	double sum = 0, square = 0, n = 0;

	if (expected > 1)
		return 0;
	for (size_t o = 0; o < a->n; o++)
		if (a->objects[o].is_there) {
			sum += bulk(&a->objects[o]);
			square += bulk(&a->objects[o]) * bulk(&a->objects[o]);
			n++;
		}
	const double mean = sum / fmax(n, 1), deviation = sqrt(fmax(square / fmax(n, 1) - mean * mean, 1e-6));
	for (size_t o = 0; o < a->n; o++) {
		const double z = a->objects[o].is_there ? (bulk(&a->objects[o]) - mean) / deviation : 0;
		fit[o] = -0.5 * (z - expected) * (z - expected) / (1.5 * 1.5);
	}
	return 1;
}

size_t vocabulary_sentence(
	struct vocabulary *v, const char *pieces, const float *vectors, size_t words, double *match)
{
	const struct lifted *l = v->lifted;
	const size_t width = (size_t)l->width;
	float *mine = v->sentences + l->sentences * width;
	size_t same = l->objects;

	sentence_vector(v, vectors, words, v->sentence_mean, mine);
	for (size_t o = 0; o < l->objects; o++)
		match[o] = -1;
	for (size_t r = 0; r < l->sentences; r++) {
		const size_t o = (size_t)l->object[r];
		match[o] = fmax(match[o], dot(mine, v->sentences + r * width, width));
		if (pieces && same == l->objects && !strcmp(pieces, l->pieces[r]))
			same = o;
	}
	return same;
}
