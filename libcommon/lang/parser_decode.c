#include "lang/parser_net.h"

#include "nn/loss.h"

#include <math.h>

/* How likely a word must be a predicate to become one for its anchor, and what that counts beside the arc:
 * first guesses, kept because sentences were parsed better with them. */
#define NET_PREDICATE_LEAST 0.02
#define NET_PREDICATE_WEIGHT 0.5
/* How much likelier than the target a word's likeliest role may be, for it to be the target where no word
 * seems to be; in logarithms. */
#define NET_TARGET_MOST 1.5f

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

static void make_predicate(const struct parser_batch *b, int sentence, struct analysis *a, int i)
{
	const float *out = b->out + (size_t)(b->start[sentence] + i) * NET_OUT;

	a->word[i].role = ROLE_PREDICATE;
	a->word[i].relation = (enum parse_relation)best_of(out + ROLES, PARSE_RELATIONS);
	a->word[i].negated = out[ROLES + PARSE_RELATIONS] > 0;
}

/* Hangs each anchor on the word that is likeliest its predicate, whatever that word seemed to be by itself:
 * an anchor says that there is a predicate. */
static void hang_anchors(
	const struct parser_weights *w, const struct parser_batch *b, int sentence, struct analysis *a)
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
			const double score = scores[j + 1] - all + NET_PREDICATE_WEIGHT * p;
			if (score > most) {
				most = score;
				best = j;
			}
		}
		a->word[i].head = best;
		if (best != ROOT && a->word[best].role != ROLE_PREDICATE)
			make_predicate(b, sentence, a, best);
	}
}

/* Hangs each word of these roles on the best that it may hang on. */
static void hang(const struct parser_weights *w, const struct parser_batch *b, int sentence,
	struct analysis *a, int wanted)
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
			make_predicate(b, sentence, a, i);
	}
	hang_anchors(w, b, sentence, a);
	hang(w, b, sentence, a, 1 << ROLE_PREDICATE);
	hang(w, b, sentence, a, 1 << ROLE_ATTRIBUTE | 1 << ROLE_NAME | 1 << ROLE_EXCEPT);
	analysis_repair(a);
	*sure = t->n ? sum / t->n : 0;
}
