#include "lang/parser_net.h"

#include "nn/loss.h"

#include <math.h>

/* Of the decoder: first guesses, each kept since the readings' sentences were parsed better with it, none
 * searched. How likely a word must be a predicate to become one for its anchor, and what that counts beside
 * the arc; what a second anchor without "and" costs; how near an anchor a predicate is rather said of it, and
 * by how much; what it costs to be said of an anchor before a pause or "and". */
#define NET_PREDICATE_LEAST 0.02
#define NET_PREDICATE_WEIGHT 0.5
#define NET_LIST_COST 3.0
#define NET_CLOSE 4
#define NET_CLOSE_BONUS 1.5f
#define NET_PARTED_COST 1.5f
/* How much likelier than the target a word's likeliest role may be, for it to be the target where no word
 * seems to be; in logarithms. */
#define NET_TARGET_MOST 1.5f
/* How likely "with" or "has" must be another relation than that. */
#define NET_WITH_MOST 0.5

static int best_of(const float *x, int n)
{
	int best = 0;

	for (int i = 1; i < n; i++)
		if (x[i] > x[best])
			best = i;
	return best;
}

/* 1 where word i is, or hangs by some way on, word `above`. */
static int is_below(const struct analysis *a, int i, int above)
{
	for (int steps = 0; i != ROOT && steps <= a->n; steps++, i = a->word[i].head)
		if (i == above)
			return 1;
	return 0;
}

static double role_log(const struct parser_batch *b, int sentence, int i, enum word_role r)
{
	const float *out = b->out + (size_t)(b->start[sentence] + i) * NET_OUT;

	return (double)out[r] - loss_log_sum_exp(out, ROLES);
}

/* "the desk with the lamp" may carry it, or have it as a part: where neither is likely, it says no more than
 * that. */
static enum parse_relation relation_of(const float *scores, const struct tokens *t, int i)
{
	const int class = tokens_class(t, i), best = best_of(scores, PARSE_RELATIONS);
	const double p = exp((double)scores[best] - loss_log_sum_exp(scores, PARSE_RELATIONS));

	return (class == CLOSED_WITH || class == CLOSED_HAVE) && p < NET_WITH_MOST
		       ? PARSE_WITH
		       : (enum parse_relation)best;
}

static void make_predicate(
	const struct parser_batch *b, int sentence, const struct tokens *t, struct analysis *a, int i)
{
	const float *out = b->out + (size_t)(b->start[sentence] + i) * NET_OUT;

	a->word[i].role = ROLE_PREDICATE;
	a->word[i].relation = relation_of(out + ROLES, t, i);
	a->word[i].negated = out[ROLES + PARSE_RELATIONS] > 0;
}

/* 1 where a pause or "and" parts words i and j, i before j. */
static int is_parted(const struct tokens *t, int i, int j)
{
	for (int k = i + 1; k <= j; k++)
		if (t->word[k].before || (k < j && t->word[k].closed >= 0 &&
						 closed_words[t->word[k].closed].class == CLOSED_CONJUNCTION))
			return 1;
	return 0;
}

/* 1 where predicate j has an anchor already, and nothing parts that from word i: the two are no list. */
static int has_near_anchor(const struct analysis *a, const struct tokens *t, int j, int i)
{
	for (int k = i - 1; k >= 0; k--)
		if (a->word[k].role == ROLE_ANCHOR && a->word[k].head == j)
			return !is_parted(t, k, i);
	return 0;
}

/* Hangs each anchor on the word that is likeliest its predicate, whatever that word seemed to be by itself:
 * an anchor says that there is a predicate. */
static void hang_anchors(const struct parser_weights *w, const struct parser_batch *b, int sentence,
	const struct tokens *t, struct analysis *a)
{
	float scores[TOKENS_MOST + 1];

	for (int i = 0; i < a->n; i++) {
		int best = ROOT;
		double most = -INFINITY, all;
		if (a->word[i].role != ROLE_ANCHOR)
			continue;
		parser_arcs(w, b, sentence, i, scores);
		all = loss_log_sum_exp(scores, (size_t)a->n + 1);
		for (int j = 0; j < a->n; j++) {
			enum word_role r = a->word[j].role;
			if (j == i || (r != ROLE_PREDICATE && r != ROLE_NONE))
				continue;
			double p = role_log(b, sentence, j, ROLE_PREDICATE);
			if (r == ROLE_NONE && p < log(NET_PREDICATE_LEAST))
				continue;
			double score = scores[j + 1] - all + NET_PREDICATE_WEIGHT * p;
			if (has_near_anchor(a, t, j, i))
				score -= NET_LIST_COST;
			if (score > most) {
				most = score;
				best = j;
			}
		}
		a->word[i].head = best;
		if (best != ROOT && a->word[best].role != ROLE_PREDICATE)
			make_predicate(b, sentence, t, a, best);
	}
}

/* Hangs each word of these roles on the best that it may hang on. */
static void hang(const struct parser_weights *w, const struct parser_batch *b, int sentence,
	const struct tokens *t, struct analysis *a, int wanted)
{
	float scores[TOKENS_MOST + 1];

	for (int i = 0; i < a->n; i++) {
		enum word_role r = a->word[i].role;
		int best = ROOT;
		float most = -INFINITY;
		if (!(wanted >> r & 1))
			continue;
		parser_arcs(w, b, sentence, i, scores);
		for (int j = -1; j < a->n; j++) {
			enum word_role up = j < 0 ? ROLE_TARGET : a->word[j].role;
			int may = j < 0 || (role_is_phrase(up) && up != ROLE_TARGET);
			if (!may || (j >= 0 && is_below(a, j, i)))
				continue;
			/* a predicate right after an anchor is rather said of that */
			if (r == ROLE_PREDICATE && j >= 0 && j < i && i - j <= NET_CLOSE &&
				!is_parted(t, j, i))
				scores[j + 1] += NET_CLOSE_BONUS;
			/* and one after a pause or "and" of the target */
			if (r == ROLE_PREDICATE && j >= 0 && j < i && is_parted(t, j, i))
				scores[j + 1] -= NET_PARTED_COST;
			if (scores[j + 1] > most) {
				most = scores[j + 1];
				best = j;
			}
		}
		a->word[i].head = best;
	}
}

/* What word i is if it is not the target. */
static enum word_role other_role(const float *out)
{
	const int best = best_of(out, ROLES);

	if (best != ROLE_TARGET)
		return (enum word_role)best;
	const int before = best_of(out, ROLE_TARGET),
		  after = ROLE_TARGET + 1 + best_of(out + ROLE_TARGET + 1, ROLES - ROLE_TARGET - 1);
	return (enum word_role)(out[before] >= out[after] ? before : after);
}

/* There is one target: of several words that seem to be it the one for which that counts most, and where none
 * does one that nearly seems to be. */
static void choose_target(const struct parser_batch *b, int sentence, struct analysis *a)
{
	const float *out = b->out + (size_t)b->start[sentence] * NET_OUT;
	float most = -NET_TARGET_MOST;
	int best = -1;

	for (int i = 0; i < a->n; i++, out += NET_OUT) {
		const float more = out[ROLE_TARGET] - out[other_role(out)];
		a->word[i].role = other_role(out);
		if (more > most) {
			most = more;
			best = i;
		}
	}
	if (best >= 0)
		a->word[best].role = ROLE_TARGET;
}

void parser_decode(const struct parser_weights *w, const struct parser_batch *b, int sentence,
	const struct tokens *t, struct analysis *a, double *sure)
{
	int first = b->start[sentence];
	double sum = 0;

	*a = (struct analysis){.n = t->n};
	choose_target(b, sentence, a);
	for (int i = 0; i < t->n; i++) {
		const float *out = b->out + (size_t)(first + i) * NET_OUT;
		a->word[i].head = ROOT;
		sum += exp((double)out[a->word[i].role] - loss_log_sum_exp(out, ROLES));
		if (a->word[i].role == ROLE_PREDICATE)
			make_predicate(b, sentence, t, a, i);
	}
	hang_anchors(w, b, sentence, t, a);
	hang(w, b, sentence, t, a, 1 << ROLE_PREDICATE);
	hang(w, b, sentence, t, a, 1 << ROLE_ATTRIBUTE | 1 << ROLE_NAME | 1 << ROLE_EXCEPT);
	analysis_repair(a);
	*sure = t->n ? sum / t->n : 0;
}
