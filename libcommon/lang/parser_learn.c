/* Samples, the loop over them (shuffled, in batches, a step of Adam each), networks that learn at once. */
#include "lang/parser_learn.h"

#include "base/mem.h"
#include "nn/adam.h"

/* The rate is a first guess, not searched. The shares of units dropped are, of few tried values, those that
 * took the most of other writers' marked sentences apart rightly. */
enum { BATCH = 16 }; /* sentences in a step */
static const double rate = 0.002, dropout = 0.33, dropout_state = 0.2;

int parser_sample_make(struct parser_sample *s, const struct tokens *t, const struct analysis *right,
	const float *pieces, int piece_count, int width, struct err *e)
{
	size_t n = (size_t)t->n;

	*s = (struct parser_sample){.n = t->n};
	s->features = mem_alloc(n, sizeof *s->features, "sample", e);
	s->right = mem_alloc(n, sizeof *s->right, "sample", e);
	s->vectors = mem_alloc(n, sizeof *s->vectors * (size_t)width, "sample", e);
	if (!s->features || !s->right || !s->vectors) {
		parser_sample_free(s);
		return -1;
	}
	parser_features_take(s->features, t);
	if (right)
		memcpy(s->right, right->word, n * sizeof *s->right);
	parser_vectors_of_words(t, pieces, piece_count, width, s->vectors);
	return 0;
}

void parser_sample_free(struct parser_sample *s)
{
	free(s->features);
	free(s->right);
	free(s->vectors);
	*s = (struct parser_sample){0};
}

struct learning {
	struct parser_batch batch, scratch;
	struct parser_weights gradient;
	float *moments;
	uint32_t *order;
	const struct analysis_word **right;
};

static int state_make(struct learning *s, int width, size_t count, size_t n, struct err *e)
{
	*s = (struct learning){0};
	s->moments = mem_zalloc(2 * count, sizeof *s->moments, "parser's moments", e);
	s->order = mem_alloc(n, sizeof *s->order, "order", e);
	s->right = mem_alloc((size_t)BATCH, sizeof *s->right, "samples", e);
	if (!s->moments || !s->order || !s->right || parser_weights_make(&s->gradient, width, e) ||
		parser_batch_make(&s->batch, BATCH * TOKENS_MOST, BATCH, &s->gradient, e) ||
		parser_scratch_make(&s->scratch, BATCH * TOKENS_MOST, BATCH, &s->gradient, e))
		return -1;
	s->batch.keep = mem_alloc((size_t)BATCH * TOKENS_MOST * NET_HIDDEN, sizeof(float), "dropout", e);
	s->batch.keep_state = mem_alloc((size_t)BATCH * TOKENS_MOST * NET_STATE, sizeof(float), "dropout", e);
	return s->batch.keep && s->batch.keep_state ? 0 : -1;
}

static void state_free(struct learning *s)
{
	parser_batch_free(&s->batch);
	parser_batch_free(&s->scratch);
	parser_weights_free(&s->gradient);
	free(s->moments);
	free(s->order);
	free(s->right);
}

static void drop(float *keep, size_t n, double share, struct rng *r)
{
	for (size_t i = 0; i < n; i++)
		keep[i] = rng_u32(r) < share * 4294967296.0 ? 0 : (float)(1 / (1 - share));
}

/* Some closed words are hidden, so that the vectors learn to do without them. */
static void hide(struct parser_batch *b, double share, struct rng *r)
{
	for (int i = 0; i < b->rows; i++)
		if (rng_u32(r) < share * 4294967296.0)
			b->features[i].closed = NET_CLOSED - 1;
}

/* What the step's samples add to the gradient: the loss. */
static double take_batch(const struct parser_weights *w, struct learning *s,
	const struct parser_sample *const *samples, size_t from, size_t to, struct rng *r)
{
	parser_batch_clear(&s->batch);
	for (size_t k = from; k < to; k++) {
		const struct parser_sample *x = samples[s->order[k]];
		s->right[s->batch.sentences] = x->right;
		parser_batch_add(&s->batch, x->features, x->vectors, x->n, w->width);
	}
	drop(s->batch.keep, (size_t)s->batch.rows * NET_HIDDEN, dropout, r);
	drop(s->batch.keep_state, (size_t)s->batch.rows * NET_STATE, dropout_state, r);
	hide(&s->batch, w->width ? 0.1 : 0, r);
	parser_forward(w, &s->batch);
	memset(s->gradient.slab, 0, sizeof(float) * w->count);
	s->scratch.rows = s->batch.rows;
	return parser_backward(w, &s->gradient, &s->batch, s->right, &s->scratch);
}

static int learn_from(const struct parser_learning *l, struct parser_weights *w, int member,
	const struct parser_sample *const *samples, size_t n, struct rng *r, struct err *e)
{
	struct learning s;
	const size_t steps = (n + BATCH - 1) / BATCH;
	size_t step = 0;
	int bad = state_make(&s, w->width, w->count, n, e);

	for (size_t i = 0; i < n && !bad; i++)
		s.order[i] = (uint32_t)i;
	for (int epoch = 0; epoch < l->epochs && !bad; epoch++) {
		double loss = 0;
		rng_shuffle(r, s.order, (uint32_t)n);
		for (size_t at = 0; at < n; at += BATCH) {
			loss += take_batch(w, &s, samples, at, at + BATCH < n ? at + BATCH : n, r);
			step++;
			double left = 1 - (double)step / (double)(steps * (size_t)l->epochs + 1);
			adam_step(w->slab, s.gradient.slab, s.moments, s.moments + w->count, w->count,
				rate * left, 0.9, 0.99, 1e-8, (long)step);
		}
		if (l->progress)
			l->progress(l->context, member, epoch, loss / (double)steps);
	}
	state_free(&s);
	return bad;
}

/* One network, by itself, so that the number of threads changes nothing. */
static int learn(const struct parser_learning *l, struct parser_weights *w, int member, struct err *e)
{
	const struct parser_sample **samples = mem_alloc(l->sample_count, sizeof *samples, "samples", e);
	struct rng r;
	size_t n = 0;

	if (!samples)
		return -1;
	rng_seed(&r, l->seed + (unsigned long long)member * 1000, 7);
	parser_weights_begin(w, &r);
	for (size_t i = 0; i < l->sample_count; i++)
		if (l->samples[i].n)
			samples[n++] = &l->samples[i];
	const int bad = learn_from(l, w, member, samples, n, &r, e);
	free(samples);
	return bad;
}

int parser_learn(const struct parser_learning *l, struct parser_weights *w, struct err *e)
{
	struct parser_weights *members[PARSER_MEMBERS + 1], *const grammar = w->grammar;
	struct err errors[PARSER_MEMBERS + 1] = {{0}};
	int n = 0, bad = 0;

	for (struct parser_weights *next; w && n < PARSER_MEMBERS; w = next) {
		next = w->next;
		w->next = NULL; /* learns alone */
		members[n++] = w;
	}
	members[n] = grammar;
#pragma omp parallel for schedule(dynamic) reduction(| : bad)
	for (int k = 0; k < n + (grammar != NULL); k++)
		bad |= learn(l, members[k], k, &errors[k]) != 0;
	for (int k = 0; k + 1 < n; k++)
		members[k]->next = members[k + 1];
	for (int k = n + 1; k-- > 0;)
		if (errors[k].message[0])
			*e = errors[k];
	return bad ? -1 : 0;
}
