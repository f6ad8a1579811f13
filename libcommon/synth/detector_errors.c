/* What a detector gets wrong of a scene in every view alike: which sentences it misunderstands, and what it
 * takes for their object. */
#include "synth/detector.h"

#include <math.h>

static int likeness(const struct synth_object *a, const struct synth_object *b)
{
	return 2 * (a->shape == b->shape) + 2 * (a->colour == b->colour) + (a->size == b->size);
}

static double distance(const struct synth_object *a, const struct synth_object *b)
{
	return hypot(a->x - b->x, a->y - b->y);
}

/* The numbers 0 to n-1 in random order. */
static void shuffled(uint32_t *order, int n, struct rng *r)
{
	for (uint32_t i = 0; i < (uint32_t)n; i++)
		order[i] = i;
	rng_shuffle(r, order, (uint32_t)n);
}

/* The object but i that pulls the most. */
static int strongest(const double *pulls, int n, int i)
{
	int best = i ? 0 : 1;

	for (int j = 0; j < n; j++)
		if (j != i && pulls[j] > pulls[best])
			best = j;
	return best;
}

/* Most objects have a confused sentence, three in four a guessing one too: by rank rather than by lot, so
 * that few objects have their share of faults too. */
static void choose_mild(struct synth_errors *h, const struct synth_object *objects, int n, struct rng *r)
{
	static const int usual[SYNTH_ERRORS] = {
		[SYNTH_ERROR_NONE] = 6, [SYNTH_ERROR_PART] = 2, [SYNTH_ERROR_UNION] = 2};
	uint32_t by_rank[SYNTH_MAX_OBJECTS], order[SYNTH_TRAIN_SENTENCES];
	double pulls[SYNTH_MAX_OBJECTS];

	shuffled(by_rank, n, r);
	for (int rank = 0; rank < n; rank++) {
		double share = (rank + 0.5) / n;
		int confused = share < 0.85, guessing = share < 0.75;
		shuffled(order, SYNTH_TRAIN_SENTENCES, r);
		for (int k = 0; k < SYNTH_TRAIN_SENTENCES; k++) {
			int error = rng_draw(r, usual, SYNTH_ERRORS);
			h->of[by_rank[rank]][order[k]] = k < confused		   ? SYNTH_ERROR_CONFUSED
							 : k < confused + guessing ? SYNTH_ERROR_GUESSING
										   : (enum synth_error)error;
		}
	}
	for (int i = 0; i < n; i++) {
		for (int j = 0; j < n; j++)
			pulls[j] =
				likeness(&objects[i], &objects[j]) - 0.1 * distance(&objects[i], &objects[j]);
		for (int k = 0; k < SYNTH_TRAIN_SENTENCES; k++)
			h->mistaken[i][k] = strongest(pulls, n, i);
	}
}

/* How likely a sentence is taken to mean object j: for what the noun phrase says, or because its relation
 * names that object; what is large draws the eye. */
static double temptation(
	const struct synth_sentence *s, const struct synth_object *objects, int j, struct rng *r)
{
	const struct synth_object *own = &objects[s->object], *other = &objects[j];
	double pull = 0.5 * likeness(own, other) - 0.1 * distance(own, other) + 0.8 * rng_uniform(r);

	if (synth_sense_judge(&s->phrases[0].sense, other) > 0)
		pull += 2;
	for (int k = 0; k < s->clause_count; k++)
		if (s->clauses[k].is.a == j || s->clauses[k].is.b == j)
			pull += 2.5;
	return pull + 1.5 * log(fmax(2 * other->radius, other->height) / fmax(2 * own->radius, own->height));
}

/* Object numbers, the harder first: those with look-alikes, and small ones, but not only they. */
static void rank_by_difficulty(int *by_rank, const struct synth_object *objects, int n, struct rng *r)
{
	double difficulty[SYNTH_MAX_OBJECTS];

	for (int i = 0; i < n; i++) {
		int at = i, has_alike = 0;
		for (int j = 0; j < n; j++)
			has_alike |= j != i && synth_look_alike(&objects[i], &objects[j]);
		difficulty[i] = rng_uniform(r) + 0.3 * has_alike + 0.2 * (objects[i].size == SYNTH_SMALL);
		for (; at > 0 && difficulty[by_rank[at - 1]] < difficulty[i]; at--)
			by_rank[at] = by_rank[at - 1];
		by_rank[at] = i;
	}
}

/* `trapped` of the sentences of object i, those that tempt the most, mislead to the thing that most tempts
 * all four. The detector is sure of every other one. */
static void mislead(struct synth_errors *h, int i, const struct synth_object *objects, int n,
	const struct synth_sentence *sentences, int trapped, struct rng *r)
{
	static const int usual[SYNTH_ERRORS] = {[SYNTH_ERROR_NONE] = 6,
		[SYNTH_ERROR_PART] = 1,
		[SYNTH_ERROR_UNION] = 2,
		[SYNTH_ERROR_GROUP] = 1};
	double pulls[SYNTH_TRAIN_SENTENCES][SYNTH_MAX_OBJECTS], sums[SYNTH_MAX_OBJECTS] = {0};

	for (int k = 0; k < SYNTH_TRAIN_SENTENCES; k++) {
		for (int j = 0; j < n; j++) {
			pulls[k][j] = temptation(&sentences[i * SYNTH_SENTENCES + k], objects, j, r);
			sums[j] += pulls[k][j];
		}
		h->of[i][k] = (enum synth_error)rng_draw(r, usual, SYNTH_ERRORS);
		h->mistaken[i][k] = strongest(pulls[k], n, i);
	}
	int trap = strongest(sums, n, i);
	for (int count = 0; count < trapped; count++) {
		int k = -1;
		for (int m = 0; m < SYNTH_TRAIN_SENTENCES; m++) {
			int is_taken =
				h->of[i][m] == SYNTH_ERROR_CONFUSED || h->of[i][m] == SYNTH_ERROR_GUESSING;
			if (!is_taken && (k < 0 || pulls[m][trap] > pulls[k][trap]))
				k = m;
		}
		h->of[i][k] = count % 2 ? SYNTH_ERROR_GUESSING : SYNTH_ERROR_CONFUSED;
		h->mistaken[i][k] = trap;
	}
}

/* Of two in five objects most sentences mislead to one and the same other object, of two half of them. */
static void choose_severe(struct synth_errors *h, const struct synth_object *objects, int n,
	const struct synth_sentence *sentences, struct rng *r)
{
	int by_rank[SYNTH_MAX_OBJECTS];

	rank_by_difficulty(by_rank, objects, n, r);
	for (int rank = 0; rank < n; rank++) {
		double share = (rank + 0.5) / n;
		int trapped = share < 0.08 ? 4 : share < 0.40 ? 3 : share < 0.82 ? 2 : 0;
		mislead(h, by_rank[rank], objects, n, sentences, trapped, r);
	}
}

void synth_errors_make(struct synth_errors *h, const struct synth_object *objects, int n,
	const struct synth_sentence *sentences, enum synth_severity severity, struct rng *r,
	struct rng *r_test)
{
	double pulls[SYNTH_MAX_OBJECTS];

	*h = (struct synth_errors){0};
	if (severity == SYNTH_MILD)
		choose_mild(h, objects, n, r);
	else
		choose_severe(h, objects, n, sentences, r);
	for (int i = 0; i < n; i++) {
		for (int k = SYNTH_TRAIN_SENTENCES; k < SYNTH_SENTENCES; k++) {
			const uint32_t like = rng_below(r_test, SYNTH_TRAIN_SENTENCES);
			h->of[i][k] = h->of[i][like];
			h->mistaken[i][k] = h->mistaken[i][like];
		}
		/* One on the other touch, however far apart their middles are. */
		for (int j = 0; j < n; j++)
			pulls[j] = objects[i].on == j || objects[j].on == i
					   ? 1
					   : -distance(&objects[i], &objects[j]);
		h->neighbours[i] = strongest(pulls, n, i);
	}
}
