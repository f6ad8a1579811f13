/* Samples and the loop over them: shuffled, in batches, one step of Adam for each. */
#include "lang/parser_learn.h"

#include "base/mem.h"
#include "nn/adam.h"

#include <stdlib.h>
#include <string.h>

int parser_sample_make(struct parser_sample *s, const struct tokens *t, const struct analysis *right,
	const float *pieces, int piece_count, int width, struct err *e)
{
	struct analysis grammar;
	size_t n = (size_t)t->n;

	*s = (struct parser_sample){.n = t->n};
	s->features = mem_alloc(n, sizeof *s->features, "sample", e);
	s->right = mem_alloc(n, sizeof *s->right, "sample", e);
	s->vectors = mem_alloc(n, sizeof *s->vectors * (size_t)width, "sample", e);
	if (!s->features || !s->right || !s->vectors) {
		parser_sample_free(s);
		return -1;
	}
	grammar_analyse(&grammar, t);
	parser_features_take(s->features, t, &grammar);
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

struct course_state {
	struct parser_batch batch, scratch;
	struct parser_weights gradient;
	float *moments;
	uint32_t *order;
	const struct analysis_word **lessons;
};

static int state_make(struct course_state *s, int width, size_t count, size_t n, int batch, struct err *e)
{
	*s = (struct course_state){0};
	s->moments = mem_zalloc(2 * count, sizeof *s->moments, "parser's moments", e);
	s->order = mem_alloc(n, sizeof *s->order, "order", e);
	s->lessons = mem_alloc((size_t)batch, sizeof *s->lessons, "lessons", e);
	if (!s->moments || !s->order || !s->lessons || parser_weights_make(&s->gradient, width, e) ||
		parser_batch_make(&s->batch, batch * TOKENS_MOST, batch, &s->gradient, e) ||
		parser_scratch_make(&s->scratch, batch * TOKENS_MOST, batch, &s->gradient, e))
		return -1;
	s->batch.keep = mem_alloc((size_t)batch * TOKENS_MOST * NET_HIDDEN, sizeof(float), "dropout", e);
	s->batch.keep_state = mem_alloc((size_t)batch * TOKENS_MOST * NET_STATE, sizeof(float), "dropout", e);
	return s->batch.keep && s->batch.keep_state ? 0 : -1;
}

static void state_free(struct course_state *s)
{
	parser_batch_free(&s->batch);
	parser_batch_free(&s->scratch);
	parser_weights_free(&s->gradient);
	free(s->moments);
	free(s->order);
	free(s->lessons);
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

int parser_learn(struct parser_weights *w, const struct parser_sample *const *samples, size_t n,
	const struct parser_course *course, struct rng *r, struct err *e)
{
	struct course_state s;
	size_t steps = (n + (size_t)course->batch - 1) / (size_t)course->batch, step = 0;
	int bad = state_make(&s, w->width, w->count, n, course->batch, e);

	for (size_t i = 0; i < n && !bad; i++)
		s.order[i] = (uint32_t)i;
	for (int epoch = 0; epoch < course->epochs && !bad; epoch++) {
		double loss = 0;
		rng_shuffle(r, s.order, (uint32_t)n);
		for (size_t at = 0; at < n; at += (size_t)course->batch) {
			parser_batch_clear(&s.batch);
			for (size_t k = at; k < n && k < at + (size_t)course->batch; k++) {
				const struct parser_sample *x = samples[s.order[k]];
				s.lessons[s.batch.sentences] = x->right;
				parser_batch_add(&s.batch, x->features, x->vectors, x->n, w->width);
			}
			drop(s.batch.keep, (size_t)s.batch.rows * NET_HIDDEN, course->dropout, r);
			drop(s.batch.keep_state, (size_t)s.batch.rows * NET_STATE, course->dropout_state, r);
			hide(&s.batch, 0.1, r);
			parser_forward(w, &s.batch);
			memset(s.gradient.slab, 0, sizeof(float) * w->count);
			s.scratch.rows = s.batch.rows;
			loss += parser_backward(w, &s.gradient, &s.batch, s.lessons, &s.scratch);
			step++;
			double left = 1 - (double)step / (double)(steps * (size_t)course->epochs + 1);
			adam_step(w->slab, s.gradient.slab, s.moments, s.moments + w->count, w->count,
				course->rate * left, 0.9, 0.99, 1e-8, (long)step);
		}
		if (course->progress)
			course->progress(course->context, course->member, epoch, loss / (double)steps);
	}
	state_free(&s);
	return bad;
}
