#include "cmd/ask/reply.h"

#include "lang/closed.h"
#include "lang/tokens.h"

#include <math.h>
#include <string.h>

enum { DISTANCE_SPLITS = 8, DISTANCE_TEXT = 2048 };

/* The two things that a distance may be asked between, as the question has them. */
struct distance_ends {
	char text[2][DISTANCE_TEXT]; /* the second is empty where the first means both: "the two mugs" */
};

/* Whether a word is one of several, of which NULL is the last. */
static int is_one_of(const struct token *w, const char *const *words)
{
	for (; *words; words++)
		if (!strcmp(w->text, *words))
			return 1;
	return 0;
}

static int is_be(const struct token *w)
{
	return w->closed >= 0 && closed_words[w->closed].class == CLOSED_BE;
}

/* Whether all words before one are such as a question or a request begins with: "tell me the distance", but
 * not "the mug at a distance". */
static int is_begun(const struct tokens *t, int n)
{
	static const unsigned begins = 1U << CLOSED_DETERMINER | 1U << CLOSED_PRONOUN | 1U << CLOSED_BE |
				       1U << CLOSED_AUXILIARY | 1U << CLOSED_RELATIVE | 1U << CLOSED_ADVERB |
				       1U << CLOSED_REQUEST;
	static const char *const open[] = {"measure", "compute", "calculate", "give", "say", "know", NULL};

	for (int i = 0; i < n; i++) {
		const int closed = t->word[i].closed;
		if ((closed < 0 || !(begins >> closed_words[closed].class & 1)) &&
			!is_one_of(&t->word[i], open))
			return 0;
	}
	return 1;
}

/* Where the words behind "distance", "how far" or "how close" begin, or -1. */
static int find_asked(const struct tokens *t)
{
	static const char *const far[] = {"far", "close", "near", NULL};
	static const char *const leads[] = {"between", "from", "of", NULL};

	for (int i = 0; i + 1 < t->n; i++) {
		const struct token *next = &t->word[i + 1];
		if (!strcmp(t->word[i].text, "distance") && is_one_of(next, leads) && is_begun(t, i))
			return i + 1;
		if (!strcmp(t->word[i].text, "how") && is_one_of(next, far))
			return i + 2;
	}
	return -1;
}

/* The end of the words, without what only says again that it is a distance. */
static int find_end(const struct tokens *t, int begin)
{
	static const char *const tail[] = {"apart", "away", "other", "another", "each", "one", NULL};
	static const char *const from[] = {"from", "to", NULL};
	int end = t->n;

	while (end > begin && is_one_of(&t->word[end - 1], tail))
		end--;
	while (end < t->n && end > begin && is_one_of(&t->word[end - 1], from))
		end--;
	return end;
}

static void put_span(const char *question, const struct tokens *t, int begin, int end, char *to)
{
	const int from = t->word[begin].span.begin, until = t->word[end - 1].span.end;

	snprintf(to, DISTANCE_TEXT, "%.*s", until - from, question + from);
}

/* Whether a word says that what comes is two things or more. */
static int is_plural(const struct tokens *t, int begin, int end)
{
	static const char *const words[] = {"between", "apart", NULL};

	for (int i = begin; i < end; i++)
		if (is_one_of(&t->word[i], words))
			return 1;
	return 0;
}

/* The ways to read a question as one about a distance: "how far is A from B", "distance between A and B",
 * "how far apart are A and B"; several, where A or B has such a word too. Returns how many, 0 where it is
 * none. */
static int distance_take(const char *question, struct distance_ends ends[DISTANCE_SPLITS])
{
	static const char *const adverbs[] = {"away", "apart", "off", "it", "there", NULL};
	static const char *const leads[] = {"between", "from", "of", "to", NULL};
	static const char *const joints[] = {"from", "to", "and", NULL};
	struct tokens t;
	int n = 0;

	tokens_take(&t, question, NULL, NULL, 0);
	const int asked = find_asked(&t), end = asked < 0 ? -1 : find_end(&t, asked);
	int begin = asked;
	const int is_how = asked > 1 && !strcmp(t.word[asked - 2].text, "how");
	while (begin < end && (is_one_of(&t.word[begin], adverbs) || is_be(&t.word[begin])))
		begin++;
	const int has_lead = begin < end && is_one_of(&t.word[begin], leads);
	begin += has_lead;
	for (int i = begin + 1; i + 1 < end && n < DISTANCE_SPLITS; i++) {
		if (!is_one_of(&t.word[i], joints) && !(has_lead && is_be(&t.word[i])))
			continue;
		put_span(question, &t, begin, i, ends[n].text[0]);
		put_span(question, &t, i + 1, end, ends[n++].text[1]);
	}
	if (!n && asked > 0 && begin < end && (is_how || is_plural(&t, asked, t.n))) {
		put_span(question, &t, begin, end, ends[n].text[0]);
		*ends[n++].text[1] = 0;
	}
	return n;
}

/* Two answers as one. */
struct pair {
	struct asking_answer of[2];
	int count; /* of the answers: 1 where the first means both things */
	size_t ends[2];
	double probability; /* 0: they are not two things */
};

static void pair_free(struct pair *p)
{
	for (int k = 0; k < p->count; k++)
		asking_answer_free(&p->of[k]);
	p->count = 0;
}

static int ask_pair(struct asking *a, const struct distance_ends *ends, struct pair *p,
	const struct report *to, struct err *e)
{
	*p = (struct pair){0};
	for (int k = 0; k < 2 && *ends->text[k]; k++) {
		p->count++;
		if (asking_ask(a, ends->text[k], &p->of[k], to, e))
			return -1;
	}
	for (int k = 0; k < 2; k++) {
		const struct asking_answer *of = &p->of[p->count == 2 ? k : 0];
		const size_t which = p->count == 2 ? 0 : (size_t)k;
		p->ends[k] = which < of->count ? of->things[which] : ASKING_NONE;
	}
	const int is_two = p->ends[0] != p->ends[1] && p->ends[0] != ASKING_NONE &&
			   p->ends[1] != ASKING_NONE && (p->count == 2 || p->of[0].count == 2);
	if (is_two)
		p->probability =
			p->of[0].probability[p->ends[0]] * p->of[p->count - 1].probability[p->ends[1]];
	return 0;
}

/* Why there are no two things, in words that end a sentence. */
static void say_why(const struct pair *p, const struct distance_ends *ends, const struct asking *a,
	char reason[EXPLAIN_REASON])
{
	for (int k = 0; k < p->count; k++)
		if (!p->of[k].count) {
			snprintf(reason, EXPLAIN_REASON, "%.120s: %.120s", ends->text[k], p->of[k].reason);
			return;
		}
	if (p->count == 2)
		snprintf(reason, EXPLAIN_REASON, "a distance is between two things, and both are %.120s",
			a->model.lifted.names[p->ends[0]]);
	else
		snprintf(reason, EXPLAIN_REASON, "a distance is between two things, and '%.120s' means %zu",
			ends->text[0], p->of[0].count);
}

/* The pair as the answer, which takes over what the first of them has. */
static int take_pair(struct asking_answer *answer, struct distance *d, struct pair *p,
	const struct distance_ends *ends, const struct asking *a, struct err *e)
{
	const struct box *x, *y;

	if (asking_answer_make(answer, a->model.lifted.objects, e))
		return -1;
	for (size_t o = 0; o < a->model.lifted.objects; o++)
		memcpy(answer->centres[o], p->of[0].centres[o], sizeof *answer->centres);
	d->probability = answer->there = p->probability;
	if (!(p->probability > 0)) {
		say_why(p, ends, a, answer->reason);
		return 0;
	}
	for (int k = 0; k < 2; k++) {
		answer->things[k] = p->ends[k];
		answer->probability[p->ends[k]] = p->of[p->count == 2 ? k : 0].probability[p->ends[k]];
	}
	answer->count = 2;
	x = &a->model.extents[p->ends[0]].turned;
	y = &a->model.extents[p->ends[1]].turned;
	d->gap = box_gap(x, y);
	d->centres = hypot(
		hypot(x->centre[0] - y->centre[0], x->centre[1] - y->centre[1]), x->centre[2] - y->centre[2]);
	return 0;
}

int distance_ask(struct asking *a, const char *question, struct asking_answer *answer, struct distance *d,
	const struct report *to, struct err *e)
{
	struct distance_ends ends[DISTANCE_SPLITS];
	const int n = distance_take(question, ends);
	struct pair best = {0};
	int chosen = 0, bad = 0;

	*d = (struct distance){.is_asked = n > 0};
	for (int i = 0; i < n && !bad; i++) {
		struct pair p;
		bad = ask_pair(a, &ends[i], &p, to, e);
		if (bad || (i && p.probability <= best.probability)) {
			pair_free(&p);
			continue;
		}
		pair_free(&best);
		best = p;
		chosen = i;
	}
	if (!bad && n)
		bad = take_pair(answer, d, &best, &ends[chosen], a, e);
	pair_free(&best);
	return bad ? -1 : 0;
}
