#include "lang/parser_net.h"

#include "base/mem.h"
#include "nn/linear.h"

#include <math.h>

void parser_parts(int width, struct parser_part parts[PARSER_PARTS])
{
	const struct parser_part all[PARSER_PARTS] = {
		{"vector.weight", NET_HIDDEN, (size_t)width},
		{"vector.bias", NET_HIDDEN, 0},
		{"closed", NET_CLOSED, NET_HIDDEN},
		{"pause", NET_PAUSES, NET_HIDDEN},
		{"ahead.input", 4 * NET_UNITS, NET_HIDDEN},
		{"ahead.recurrent", NET_UNITS, 4 * NET_UNITS},
		{"ahead.bias", 4 * NET_UNITS, 0},
		{"back.input", 4 * NET_UNITS, NET_HIDDEN},
		{"back.recurrent", NET_UNITS, 4 * NET_UNITS},
		{"back.bias", 4 * NET_UNITS, 0},
		{"down.weight", NET_HIDDEN, NET_STATE},
		{"down.bias", NET_HIDDEN, 0},
		{"out.weight", NET_OUT, NET_HIDDEN},
		{"out.bias", NET_OUT, 0},
		{"dependent.weight", NET_ARC, NET_HIDDEN},
		{"dependent.bias", NET_ARC, 0},
		{"head.weight", NET_ARC, NET_HIDDEN},
		{"head.bias", NET_ARC, 0},
		{"root", NET_ARC + 1, 0},
		{"distance", NET_DISTANCES, 0},
	};

	memcpy(parts, all, sizeof all);
}

int parser_weights_make(struct parser_weights *w, int width, struct err *e)
{
	struct parser_part parts[PARSER_PARTS];
	float **const at[PARSER_PARTS] = {&w->vector, &w->vector_bias, &w->closed, &w->pause, &w->ahead.input,
		&w->ahead.recurrent, &w->ahead.bias, &w->back.input, &w->back.recurrent, &w->back.bias,
		&w->down, &w->down_bias, &w->out, &w->out_bias, &w->dependent, &w->dependent_bias, &w->head,
		&w->head_bias, &w->root, &w->distance};

	*w = (struct parser_weights){.width = width,
		.ahead = {.in = NET_HIDDEN, .units = NET_UNITS},
		.back = {.in = NET_HIDDEN, .units = NET_UNITS}};
	parser_parts(width, parts);
	for (int i = 0; i < PARSER_PARTS; i++)
		w->count += parts[i].rows * (parts[i].columns ? parts[i].columns : 1);
	w->slab = mem_zalloc(w->count, sizeof *w->slab, "parser's weights", e);
	if (!w->slab)
		return -1;
	float *p = w->slab;
	for (int i = 0; i < PARSER_PARTS; i++) {
		*at[i] = p;
		p += parts[i].rows * (parts[i].columns ? parts[i].columns : 1);
	}
	return 0;
}

int parser_weights_add(struct parser_weights **to, int width, struct err *e)
{
	*to = mem_zalloc(1, sizeof **to, "parser's weights", e);
	return *to ? parser_weights_make(*to, width, e) : -1;
}

void parser_weights_free(struct parser_weights *w)
{
	if (w->next)
		parser_weights_free(w->next);
	if (w->grammar)
		parser_weights_free(w->grammar);
	mem_free_all(w->next, w->grammar, w->slab);
	*w = (struct parser_weights){0};
}

int parser_batch_make(
	struct parser_batch *b, int capacity, int sentences, const struct parser_weights *w, struct err *e)
{
	size_t n = (size_t)capacity, members = 0;
	int bad = 0;

	for (const struct parser_weights *m = w; m; m = m->next)
		members++;

	*b = (struct parser_batch){.capacity = capacity};
	struct {
		float **at;
		size_t columns;
	} floats[] = {{&b->x, (size_t)w->width}, {&b->first, NET_HIDDEN}, {&b->state, NET_STATE},
		{&b->grown, NET_HIDDEN}, {&b->h, NET_HIDDEN}, {&b->ahead.gates, 4 * NET_UNITS},
		{&b->ahead.cell, NET_UNITS}, {&b->ahead.before, NET_UNITS}, {&b->back.gates, 4 * NET_UNITS},
		{&b->back.cell, NET_UNITS}, {&b->back.before, NET_UNITS}, {&b->out, NET_OUT},
		{&b->own, NET_OUT}, {&b->dependent, members * NET_ARC}, {&b->head, members * NET_ARC}};
	for (size_t i = 0; i < sizeof floats / sizeof *floats && !bad; i++)
		bad = !(*floats[i].at = mem_zalloc(n, floats[i].columns * sizeof(float), "parser", e));
	if (!bad)
		bad = !(b->features = mem_zalloc(n, sizeof *b->features, "parser", e));
	if (!bad)
		bad = !(b->start = mem_zalloc((size_t)sentences + 1, sizeof(int), "parser", e));
	if (bad)
		parser_batch_free(b);
	return bad ? -1 : 0;
}

void parser_batch_free(struct parser_batch *b)
{
	mem_free_all(b->x, b->first, b->state, b->grown, b->h, b->ahead.gates, b->ahead.cell, b->ahead.before,
		b->back.gates, b->back.cell, b->back.before, b->scratch, b->out, b->own, b->dependent,
		b->head, b->features, b->start, b->keep, b->keep_state);
	*b = (struct parser_batch){0};
}

void parser_batch_clear(struct parser_batch *b)
{
	b->rows = b->sentences = 0;
}

void parser_features_take(struct parser_features *f, const struct tokens *t)
{
	for (int i = 0; i < t->n; i++) {
		const struct token *w = &t->word[i];
		f[i] = (struct parser_features){.closed = w->closed < 0 ? NET_CLOSED - 1 : w->closed,
			.pause = w->before		     ? (int)w->before
				 : strcmp(w->text, w->lemma) ? NET_PAUSES - 1
							     : 0};
	}
}

void parser_batch_add(
	struct parser_batch *b, const struct parser_features *f, const float *vectors, int n, int width)
{
	memcpy(b->features + b->rows, f, sizeof *f * (size_t)n);
	memcpy(b->x + (size_t)b->rows * (size_t)width, vectors, sizeof *vectors * (size_t)width * (size_t)n);
	b->rows += n;
	b->start[++b->sentences] = b->rows;
}

void parser_vectors_of_words(const struct tokens *t, const float *vectors, int count, int width, float *out)
{
	memset(out, 0, sizeof *out * (size_t)t->n * (size_t)width);
	for (int i = 0; i < t->n; i++) {
		const struct token *w = &t->word[i];
		for (int k = w->piece; k < w->piece + w->pieces && k < count; k++)
			for (int d = 0; d < width; d++)
				out[(size_t)i * (size_t)width + (size_t)d] +=
					vectors[(size_t)k * (size_t)width + (size_t)d] / (float)w->pieces;
	}
}

static void add_row(float *to, const float *from)
{
	for (int d = 0; d < NET_HIDDEN; d++)
		to[d] += from[d];
}

static void embed(const struct parser_weights *w, struct parser_batch *b)
{
	linear_forward(
		b->first, b->x, w->vector, w->vector_bias, (size_t)b->rows, (size_t)w->width, NET_HIDDEN);
	for (int r = 0; r < b->rows; r++) {
		float *h = b->first + (size_t)r * NET_HIDDEN;
		add_row(h, w->closed + b->features[r].closed * NET_HIDDEN);
		add_row(h, w->pause + b->features[r].pause * NET_HIDDEN);
		for (int d = 0; d < NET_HIDDEN; d++) {
			h[d] = h[d] > 0 ? h[d] : 0;
			if (b->keep)
				h[d] *= b->keep[(size_t)r * NET_HIDDEN + (size_t)d];
		}
	}
}

/* One member: out (rows), and the arcs of that member. */
static void forward(const struct parser_weights *w, struct parser_batch *b, size_t member, float *out)
{
	const size_t rows = (size_t)b->rows, at = member * (size_t)b->capacity * NET_ARC;

	const struct lstm_sequences ahead = {b->start, b->sentences, 0}, back = {b->start, b->sentences, 1};

	embed(w, b);
	lstm_forward(&w->ahead, &ahead, b->first, &b->ahead, b->state, NET_STATE);
	lstm_forward(&w->back, &back, b->first, &b->back, b->state + NET_UNITS, NET_STATE);
	for (size_t i = 0; b->keep_state && i < rows * NET_STATE; i++)
		b->state[i] *= b->keep_state[i];
	linear_forward(b->grown, b->state, w->down, w->down_bias, rows, NET_STATE, NET_HIDDEN);
	for (size_t i = 0; i < rows * NET_HIDDEN; i++)
		b->h[i] = b->first[i] + (b->grown[i] > 0 ? b->grown[i] : 0);
	linear_forward(out, b->h, w->out, w->out_bias, rows, NET_HIDDEN, NET_OUT);
	linear_forward(b->dependent + at, b->h, w->dependent, w->dependent_bias, rows, NET_HIDDEN, NET_ARC);
	linear_forward(b->head + at, b->h, w->head, w->head_bias, rows, NET_HIDDEN, NET_ARC);
}

void parser_forward(const struct parser_weights *w, struct parser_batch *b)
{
	const size_t n = (size_t)b->rows * NET_OUT;
	size_t members = 1;

	if (!n)
		return;
	forward(w, b, 0, b->out);
	for (w = w->next; w; w = w->next, members++) {
		forward(w, b, members, b->own);
		for (size_t i = 0; i < n; i++)
			b->out[i] += b->own[i];
	}
	for (size_t i = 0; i < n && members > 1; i++)
		b->out[i] /= (float)members;
}

int parser_distance(int from, int to)
{
	int d = to - from, most = NET_DISTANCES / 2;

	d = d < -most ? -most : d > most ? most : d;
	return d + most;
}

/* Adds a member's scores, but begins with the first one's. */
static void score_arcs(const struct parser_weights *w, const struct parser_batch *b, size_t member,
	int sentence, int i, float *scores)
{
	const size_t at = member * (size_t)b->capacity * NET_ARC;
	const int first = b->start[sentence], n = b->start[sentence + 1] - first;
	const float *dependent = b->dependent + at + (size_t)(first + i) * NET_ARC;
	const float scale = 1 / sqrtf(NET_ARC);

	for (int j = -1; j < n; j++) {
		const float *head = j < 0 ? w->root : b->head + at + (size_t)(first + j) * NET_ARC;
		float sum = 0;
		for (int k = 0; k < NET_ARC; k++)
			sum += dependent[k] * head[k];
		sum *= scale;
		sum += j < 0 ? w->root[NET_ARC] : w->distance[parser_distance(i, j)];
		scores[j + 1] = member ? scores[j + 1] + sum : sum;
	}
}

void parser_arcs(
	const struct parser_weights *w, const struct parser_batch *b, int sentence, int i, float *scores)
{
	const int n = b->start[sentence + 1] - b->start[sentence];
	float members = 1;

	score_arcs(w, b, 0, sentence, i, scores);
	for (w = w->next; w; w = w->next, members++)
		score_arcs(w, b, (size_t)members, sentence, i, scores);
	for (int j = 0; j <= n && members > 1; j++)
		scores[j] /= members;
}
