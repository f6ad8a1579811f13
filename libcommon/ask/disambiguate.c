#include "ask/disambiguate.h"

#include "ask/choose.h"
#include "base/mem.h"
#include "nn/assignment.h"

#include <math.h>
#include <stdint.h>

enum { ROUNDS = 4 };
static const double least = 0.003, naming = 0.1;
/* How much it counts, for which regions are left over, that masks agree with what was lifted. Of 0, 0.1,
 * 0.25, 0.5 and 1, on the 23 scenes that it was chosen on: an object more is wrong with 0, and with 1. */
/* Sums of logs for each object of a circle that changes places; of a sentence for one that is named, of most
 * of two or more and of one alone. Of right sentences on the desk and four made scenes at most 2 of 4 are
 * above the first, and none above the second; of two objects' exchanged ones at least one is found. */
static const double clear_gain = 0.7, contradicting = 1, plain = 3.5;
static const double never = -1e9;
static const size_t ANY = SIZE_MAX;
static const double agreement_worth = 0.25, least_agreement = 0.02;

/* value (O,O): how well object o's sentences fit the Gaussians of object k; 0 where o is none of `named`.
 * probability (R,O) is normalised. */
static int judge(const struct lifted *l, size_t named, const char *is_fixed, const struct choose_scene *scene,
	const struct choose_sentence *sentences, struct choice *choices, float *probability, char *chosen,
	double *value, struct err *e)
{
	const size_t n = l->objects;

	if (choose(scene, sentences, l->sentences, CHOOSE_ALL & ~(1U << CHOOSE_SENTENCE), choices,
		    probability, chosen, NULL, e))
		return -1;
	memset(value, 0, n * n * sizeof *value);
	for (size_t r = 0; r < l->sentences; r++) {
		float *p = probability + r * n;
		double sum = 0;
		for (size_t k = 0; k < n; k++)
			sum += (double)p[k];
		for (size_t k = 0; k < n; k++) {
			p[k] = sum > 0 ? (float)((double)p[k] / sum) : 0;
			value[(size_t)l->object[r] * n + k] += log((double)p[k] + least);
		}
	}
	for (size_t o = 0; o < n; o++)
		for (size_t k = 0; k < n; k++)
			if (o != k && (is_fixed[o] || is_fixed[k]))
				value[o * n + k] = never;
			else if (o < named)
				value[o * n + k] +=
					agreement_worth * log((double)l->confidence[k] + least_agreement);
	return 0;
}

/* Object o gets the Gaussians that `from`[o] has in `old`. */
static void share_out(struct lifted *l, const struct lifted *old, const size_t *from)
{
	for (size_t o = 0; o < l->objects; o++) {
		const int64_t begin = old->indptr[from[o]], n = old->indptr[from[o] + 1] - begin;
		l->indptr[o + 1] = l->indptr[o] + n;
		memcpy(l->index + l->indptr[o], old->index + begin, (size_t)n * sizeof *l->index);
		memcpy(l->share + l->indptr[o], old->share + begin, (size_t)n * sizeof *l->share);
		l->confidence[o] = old->confidence[from[o]];
		if (l->cut)
			l->cut[o] = old->cut[from[o]];
	}
}

/* What changes of a model, copied. */
static int copy_shares(struct lifted *to, const struct lifted *l, struct err *e)
{
	const size_t shares = (size_t)l->indptr[l->objects];

	*to = *l;
	to->indptr = mem_alloc(l->objects + 1, sizeof *to->indptr, "objects", e);
	to->index = mem_alloc(shares, sizeof *to->index, "objects", e);
	to->share = mem_alloc(shares, sizeof *to->share, "objects", e);
	to->confidence = mem_alloc(l->objects, sizeof *to->confidence, "objects", e);
	to->cut = l->cut ? mem_alloc(l->objects, sizeof *to->cut, "objects", e) : NULL;
	if (!to->indptr || !to->index || !to->share || !to->confidence || (l->cut && !to->cut))
		return -1;
	if (!l->objects)
		return 0;
	memcpy(to->indptr, l->indptr, (l->objects + 1) * sizeof *to->indptr);
	memcpy(to->index, l->index, shares * sizeof *to->index);
	memcpy(to->share, l->share, shares * sizeof *to->share);
	memcpy(to->confidence, l->confidence, l->objects * sizeof *to->confidence);
	if (l->cut)
		memcpy(to->cut, l->cut, l->objects * sizeof *to->cut);
	return 0;
}

static void free_shares(struct lifted *l)
{
	free(l->indptr);
	free(l->index);
	free(l->share);
	free(l->confidence);
	free(l->cut);
}

/* Of object o's sentences the one that means object k most plainly in place of it; ANY: any other named. */
static void explain(const struct lifted *l, size_t named, const float *probability, size_t o, size_t only,
	struct disambiguated *to)
{
	double best = 0;

	for (size_t r = 0; r < l->sentences; r++) {
		const float *p = probability + r * l->objects;
		double most = 0;
		if ((size_t)l->object[r] != o)
			continue;
		to->sentences++;
		for (size_t k = 0; k < l->objects; k++) {
			if (k == o || (only == ANY ? k >= named : k != only))
				continue;
			const double gain = log((p[k] + least) / (p[o] + least));
			if (gain > most)
				most = gain;
			if (gain > best) {
				best = gain;
				to->sentence = r;
				to->other = k;
				to->own_p = p[o];
				to->other_p = p[k];
			}
		}
		to->against += most > contradicting;
	}
	if (best <= plain && (to->against < 2 || 2 * to->against <= to->sentences))
		to->against = 0;
}

/* Only what nobody has fixed may change places, and only for what is clearly better: of next, each circle of
 * objects that change places is undone where it gains too little. Returns how many named ones change. */
static size_t undo_unclear(const struct lifted *l, size_t named, const double *value, size_t *next)
{
	const size_t n = l->objects;
	size_t changes = 0;

	for (size_t o = 0; o < n; o++) {
		double gain = 0;
		size_t moving = 0, k = o;
		int is_first = next[o] != o;
		do {
			is_first &= k >= o;
			gain += value[k * n + next[k]] - value[k * n + k];
			moving += k < named;
			k = next[k];
		} while (k != o);
		if (!is_first)
			continue;
		if (gain >= clear_gain * (double)moving) {
			changes += moving;
			continue;
		}
		do {
			const size_t after = next[k];
			next[k] = k;
			k = after;
		} while (k != o);
	}
	return changes;
}

static int settle(struct lifted *l, size_t named, const char *is_fixed, const struct lifted *old,
	const struct choose_scene *scene, size_t *from, struct disambiguated *to, struct err *e)
{
	const size_t n = l->objects, width = (size_t)l->width;
	struct choose_sentence *sentences = mem_alloc(l->sentences, sizeof *sentences, "sentences", e);
	float *probability = mem_alloc(l->sentences, (n + 1) * sizeof *probability, "sentences", e);
	struct choice *choices = mem_alloc(l->sentences, sizeof *choices, "sentences", e);
	char *chosen = mem_alloc(l->sentences, n, "sentences", e);
	double *value = mem_alloc(n * n, sizeof *value, "objects", e);
	size_t *next = mem_alloc(n, sizeof *next, "objects", e),
	       *now = mem_alloc(n, sizeof *now, "objects", e);
	int bad = !sentences || !choices || !chosen || !probability || !value || !next || !now;
	size_t changes = 1;

	for (size_t r = 0; r < l->sentences && !bad; r++)
		sentences[r] = (struct choose_sentence){l->texts[r], l->pieces[r],
			l->words + (size_t)l->offsets[r] * width, lifted_middle(l, r),
			(size_t)(l->offsets[r + 1] - l->offsets[r]), {.kind = VIEWPOINT_USUAL}, NULL, 0};
	for (int round = 0; round < ROUNDS && changes && !bad; round++) {
		bad = judge(l, named, is_fixed, scene, sentences, choices, probability, chosen, value, e) ||
		      assignment_best(value, n, n, next, e);
		changes = bad ? 0 : undo_unclear(l, named, value, next);
		for (size_t o = 0; o < n && !bad; o++) {
			now[o] = from[next[o]];
			if (o < named && (is_fixed[o] || next[o] != o)) {
				to[o] = (struct disambiguated){0};
				explain(l, named, probability, o, is_fixed[o] ? ANY : next[o], &to[o]);
				if (!is_fixed[o])
					to[o].other = now[o];
			}
		}
		if (changes) {
			memcpy(from, now, n * sizeof *from);
			share_out(l, old, from);
		}
	}
	free(sentences);
	free(choices);
	free(chosen);
	free(probability);
	free(value);
	free(next);
	free(now);
	return bad ? -1 : 0;
}

int disambiguate(struct lifted *l, size_t named, const char *is_fixed, const struct splats *splats,
	const struct cameras *cameras, const struct parser *parser, struct disambiguated *to, struct err *e)
{
	const struct choose_scene scene = {l, splats, cameras, parser, naming, NULL};
	size_t *from = mem_alloc(l->objects, sizeof *from, "objects", e);
	struct lifted old = {0};

	memset(to, 0, named * sizeof *to);
	if (!from || copy_shares(&old, l, e)) {
		free(from);
		free_shares(&old);
		return -1;
	}
	for (size_t o = 0; o < l->objects; o++)
		from[o] = o;
	int bad = settle(l, named, is_fixed, &old, &scene, from, to, e);
	for (size_t o = 0; o < l->objects && bad; o++)
		from[o] = o;
	if (bad)
		share_out(l, &old, from);
	for (size_t o = 0; o < named; o++)
		to[o].is_moved = from[o] != o;
	free(from);
	free_shares(&old);
	return bad ? -1 : 0;
}
