/* The gradient of the parser's loss. */
#include "lang/parser_learn.h"

#include "base/mem.h"
#include "nn/linear.h"
#include "nn/loss.h"

#include <math.h>

void parser_weights_begin(struct parser_weights *w, struct rng *r)
{
	struct parser_part parts[PARSER_PARTS];
	float *p = w->slab;

	parser_parts(w->width, parts);
	for (int i = 0; i < PARSER_PARTS; i++) {
		size_t n = parts[i].rows * (parts[i].columns ? parts[i].columns : 1);
		/* tables of words are sums' terms: small */
		double most = !parts[i].columns			     ? 0
			      : p >= w->closed && p < w->ahead.input ? 0.1
								     : sqrt(3.0 / (double)parts[i].columns);
		for (size_t k = 0; k < n; k++)
			p[k] = (float)rng_range(r, -most, most + (most > 0 ? 0 : 1e-30));
		p += n;
	}
	for (int k = 0; k < NET_ARC; k++)
		w->root[k] = (float)rng_range(r, -0.3, 0.3);
}

int parser_scratch_make(
	struct parser_batch *b, int capacity, int sentences, const struct parser_weights *w, struct err *e)
{
	if (parser_batch_make(b, capacity, sentences, w, e))
		return -1;
	b->scratch = mem_alloc(lstm_scratch(&w->ahead, sentences), sizeof *b->scratch, "parser", e);
	if (b->scratch)
		return 0;
	parser_batch_free(b);
	return -1;
}

/* Cross-entropy of n logits against `right`; d gets its gradient times `scale`. */
static double entropy(const float *x, int n, int right, float *d, double scale)
{
	float most;
	const double sum = loss_exp_sum(x, (size_t)n, &most);

	for (int i = 0; i < n; i++)
		d[i] += (float)(scale * (exp((double)(x[i] - most)) / sum - (i == right)));
	return scale * (most + log(sum) - x[right]);
}

static int has_head(enum word_role r)
{
	return r == ROLE_ANCHOR || r == ROLE_PREDICATE || r == ROLE_NAME || r == ROLE_ATTRIBUTE ||
	       r == ROLE_EXCEPT;
}

static double arc_loss(const struct parser_weights *w, struct parser_weights *dw,
	const struct parser_batch *b, int sentence, int i, int right, struct parser_batch *d, double scale)
{
	int first = b->start[sentence], n = b->start[sentence + 1] - first;
	float scores[TOKENS_MOST + 1], ds[TOKENS_MOST + 1] = {0};
	const float inverse = 1 / sqrtf(NET_ARC), *dependent = b->dependent + (size_t)(first + i) * NET_ARC;
	float *ddependent = d->dependent + (size_t)(first + i) * NET_ARC;
	double loss;

	parser_arcs(w, b, sentence, i, scores);
	loss = entropy(scores, n + 1, right + 1, ds, scale);
	for (int j = -1; j < n; j++) {
		const float *head = j < 0 ? w->root : b->head + (size_t)(first + j) * NET_ARC;
		float *dhead = j < 0 ? dw->root : d->head + (size_t)(first + j) * NET_ARC, g = ds[j + 1];
		for (int k = 0; k < NET_ARC; k++) {
			ddependent[k] += g * inverse * head[k];
			dhead[k] += g * inverse * dependent[k];
		}
		if (j < 0)
			dw->root[NET_ARC] += g;
		else
			dw->distance[parser_distance(i, j)] += g;
	}
	return loss;
}

static double negation_loss(float x, int right, float *d, double scale)
{
	double p = 1 / (1 + exp(-(double)x));

	*d += (float)(scale * (p - right));
	return scale * (fmax(x, 0) - x * right + log1p(exp(-fabs((double)x))));
}

static double losses(const struct parser_weights *w, struct parser_weights *dw, const struct parser_batch *b,
	const struct analysis_word *const *right, struct parser_batch *d)
{
	double loss = 0, scale = 1.0 / (b->rows ? b->rows : 1);

	for (int s = 0; s < b->sentences; s++) {
		const struct analysis_word *a = right[s];
		for (int i = 0; i < b->start[s + 1] - b->start[s]; i++) {
			const float *out = b->out + (size_t)(b->start[s] + i) * NET_OUT;
			float *dout = d->out + (size_t)(b->start[s] + i) * NET_OUT;
			enum word_role r = a[i].role;
			if (r == ROLES)
				continue;
			loss += entropy(out, ROLES, (int)r, dout, scale);
			if (r == ROLE_PREDICATE) {
				loss += entropy(out + ROLES, PARSE_RELATIONS, (int)a[i].relation,
					dout + ROLES, scale);
				loss += negation_loss(out[ROLES + PARSE_RELATIONS], a[i].negated,
					dout + ROLES + PARSE_RELATIONS, scale);
			}
			if (has_head(r))
				loss += arc_loss(w, dw, b, s, i, a[i].head, d, scale);
		}
	}
	return loss;
}

static void add_to(float *table, const float *d)
{
	for (int k = 0; k < NET_HIDDEN; k++)
		table[k] += d[k];
}

static void embed_back(struct parser_weights *dw, const struct parser_batch *b, float *dh)
{
	for (int r = 0; r < b->rows; r++) {
		float *d = dh + (size_t)r * NET_HIDDEN;
		for (int k = 0; k < NET_HIDDEN; k++) {
			size_t at = (size_t)r * NET_HIDDEN + (size_t)k;
			if (b->keep)
				d[k] *= b->keep[at];
			if (!(b->first[at] > 0))
				d[k] = 0;
		}
		add_to(dw->closed + b->features[r].closed * NET_HIDDEN, d);
		add_to(dw->pause + b->features[r].pause * NET_HIDDEN, d);
	}
	linear_backward(NULL, dw->vector, dw->vector_bias, dh, b->x, NULL, (size_t)b->rows, (size_t)dw->width,
		NET_HIDDEN);
}

double parser_backward(const struct parser_weights *w, struct parser_weights *dw,
	const struct parser_batch *b, const struct analysis_word *const *right, struct parser_batch *d)
{
	const struct lstm_sequences ahead = {b->start, b->sentences, 0}, back = {b->start, b->sentences, 1};
	const size_t rows = (size_t)b->rows, h = rows * NET_HIDDEN;
	float *dh = d->h, *part = d->first;
	double loss;

	memset(d->out, 0, sizeof(float) * rows * NET_OUT);
	memset(d->dependent, 0, sizeof(float) * rows * NET_ARC);
	memset(d->head, 0, sizeof(float) * rows * NET_ARC);
	loss = losses(w, dw, b, right, d);
	linear_backward(dh, dw->out, dw->out_bias, d->out, b->h, w->out, rows, NET_HIDDEN, NET_OUT);
	linear_backward(part, dw->dependent, dw->dependent_bias, d->dependent, b->h, w->dependent, rows,
		NET_HIDDEN, NET_ARC);
	for (size_t i = 0; i < h; i++)
		dh[i] += part[i];
	linear_backward(part, dw->head, dw->head_bias, d->head, b->h, w->head, rows, NET_HIDDEN, NET_ARC);
	for (size_t i = 0; i < h; i++)
		dh[i] += part[i];
	for (size_t i = 0; i < h; i++)
		part[i] = b->grown[i] > 0 ? dh[i] : 0;
	linear_backward(
		d->state, dw->down, dw->down_bias, part, b->state, w->down, rows, NET_STATE, NET_HIDDEN);
	for (size_t i = 0; b->keep_state && i < rows * NET_STATE; i++)
		d->state[i] *= b->keep_state[i];
	lstm_backward(
		&w->ahead, &dw->ahead, &ahead, b->first, &b->ahead, d->state, NET_STATE, dh, d->scratch);
	lstm_backward(&w->back, &dw->back, &back, b->first, &b->back, d->state + NET_UNITS, NET_STATE, dh,
		d->scratch);
	embed_back(dw, b, dh);
	return loss;
}
