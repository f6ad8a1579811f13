#include "lang/parser_net.h"

#include "base/mem.h"
#include "nn/linear.h"
#include "nn/loss.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
/* How likely "with" or "has" must be another relation than that. */
#define NET_WITH_MOST 0.5

static const int reach[NET_LAYERS] = {1, 2, 4};

void parser_parts(int width, struct parser_part parts[PARSER_PARTS])
{
	const struct parser_part all[PARSER_PARTS] = {
		{"vector.weight", NET_HIDDEN, (size_t)width},
		{"vector.bias", NET_HIDDEN, 0},
		{"closed", NET_CLOSED, NET_HIDDEN},
		{"role", ROLES, NET_HIDDEN},
		{"relation", PARSE_RELATIONS + 1, NET_HIDDEN},
		{"pause", NET_PAUSES, NET_HIDDEN},
		{"layer.0.weight", NET_HIDDEN, NET_BLOCKS * NET_HIDDEN},
		{"layer.0.bias", NET_HIDDEN, 0},
		{"layer.1.weight", NET_HIDDEN, NET_BLOCKS * NET_HIDDEN},
		{"layer.1.bias", NET_HIDDEN, 0},
		{"layer.2.weight", NET_HIDDEN, NET_BLOCKS * NET_HIDDEN},
		{"layer.2.bias", NET_HIDDEN, 0},
		{"out.weight", NET_OUT, NET_HIDDEN},
		{"out.bias", NET_OUT, 0},
		{"dependent.weight", NET_ARC, NET_HIDDEN},
		{"dependent.bias", NET_ARC, 0},
		{"head.weight", NET_ARC, NET_HIDDEN},
		{"head.bias", NET_ARC, 0},
		{"root", NET_ARC + 1, 0},
		{"distance", NET_DISTANCES, 0},
		{"agree", 2, 0},
	};

	memcpy(parts, all, sizeof all);
}

int parser_weights_make(struct parser_weights *w, int width, struct err *e)
{
	struct parser_part parts[PARSER_PARTS];
	float **const at[PARSER_PARTS] = {&w->vector, &w->vector_bias, &w->closed, &w->role, &w->relation,
		&w->pause, &w->layer[0], &w->layer_bias[0], &w->layer[1], &w->layer_bias[1], &w->layer[2],
		&w->layer_bias[2], &w->out, &w->out_bias, &w->dependent, &w->dependent_bias, &w->head,
		&w->head_bias, &w->root, &w->distance, &w->agree};

	*w = (struct parser_weights){.width = width};
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

void parser_weights_free(struct parser_weights *w)
{
	if (w->next)
		parser_weights_free(w->next);
	free(w->next);
	free(w->slab);
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
	} floats[] = {{&b->x, (size_t)w->width}, {&b->h[0], NET_HIDDEN}, {&b->h[1], NET_HIDDEN},
		{&b->h[2], NET_HIDDEN}, {&b->h[3], NET_HIDDEN}, {&b->gathered[0], NET_BLOCKS * NET_HIDDEN},
		{&b->gathered[1], NET_BLOCKS * NET_HIDDEN}, {&b->gathered[2], NET_BLOCKS * NET_HIDDEN},
		{&b->grown[0], NET_HIDDEN}, {&b->grown[1], NET_HIDDEN}, {&b->grown[2], NET_HIDDEN},
		{&b->out, NET_OUT}, {&b->own, NET_OUT}, {&b->dependent, members * NET_ARC},
		{&b->head, members * NET_ARC}};
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
	for (int l = 0; l < NET_LAYERS; l++) {
		free(b->gathered[l]);
		free(b->grown[l]);
	}
	for (int l = 0; l <= NET_LAYERS; l++)
		free(b->h[l]);
	free(b->x);
	free(b->out);
	free(b->own);
	free(b->dependent);
	free(b->head);
	free(b->features);
	free(b->start);
	free(b->keep);
	*b = (struct parser_batch){0};
}

void parser_batch_clear(struct parser_batch *b)
{
	b->rows = b->sentences = 0;
}

void parser_features_take(struct parser_features *f, const struct tokens *t, const struct analysis *grammar)
{
	for (int i = 0; i < t->n; i++) {
		const struct token *w = &t->word[i];
		const struct analysis_word *g = &grammar->word[i];
		f[i] = (struct parser_features){.closed = w->closed < 0 ? NET_CLOSED - 1 : w->closed,
			.role = (int)g->role,
			.relation = g->role == ROLE_PREDICATE ? (int)g->relation : PARSE_RELATIONS,
			.pause = w->before		     ? (int)w->before
				 : strcmp(w->text, w->lemma) ? NET_PAUSES - 1
							     : 0,
			.head = g->head};
	}
}

void parser_features_blank(struct parser_features *f, int n)
{
	for (int i = 0; i < n; i++) {
		f[i].role = ROLE_NONE;
		f[i].relation = PARSE_RELATIONS;
		f[i].head = ROOT;
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
		b->h[0], b->x, w->vector, w->vector_bias, (size_t)b->rows, (size_t)w->width, NET_HIDDEN);
	for (int r = 0; r < b->rows; r++) {
		float *h = b->h[0] + (size_t)r * NET_HIDDEN;
		add_row(h, w->closed + b->features[r].closed * NET_HIDDEN);
		add_row(h, w->role + b->features[r].role * NET_HIDDEN);
		add_row(h, w->relation + b->features[r].relation * NET_HIDDEN);
		add_row(h, w->pause + b->features[r].pause * NET_HIDDEN);
		for (int d = 0; d < NET_HIDDEN; d++) {
			h[d] = h[d] > 0 ? h[d] : 0;
			if (b->keep)
				h[d] *= b->keep[(size_t)r * NET_HIDDEN + (size_t)d];
		}
	}
}

static void gather(const struct parser_batch *b, int layer)
{
	const float *h = b->h[layer];
	float *out = b->gathered[layer];

	memset(out, 0, sizeof *out * (size_t)b->rows * NET_BLOCKS * NET_HIDDEN);
	for (int s = 0; s < b->sentences; s++) {
		int first = b->start[s], end = b->start[s + 1];
		float mean[NET_HIDDEN] = {0};
		for (int r = first; r < end; r++)
			add_row(mean, h + (size_t)r * NET_HIDDEN);
		for (int d = 0; d < NET_HIDDEN; d++)
			mean[d] /= (float)(end - first);
		for (int r = first; r < end; r++) {
			float *row = out + (size_t)r * NET_BLOCKS * NET_HIDDEN;
			for (int k = 0; k < 3; k++) {
				int at = r + (k - 1) * reach[layer];
				if (at >= first && at < end)
					memcpy(row + k * NET_HIDDEN, h + (size_t)at * NET_HIDDEN,
						sizeof *row * NET_HIDDEN);
			}
			memcpy(row + 3 * NET_HIDDEN, mean, sizeof mean);
		}
	}
}

/* One member: out (rows), and the arcs of that member. */
static void forward(const struct parser_weights *w, struct parser_batch *b, size_t member, float *out)
{
	const size_t rows = (size_t)b->rows, at = member * (size_t)b->capacity * NET_ARC;

	embed(w, b);
	for (int l = 0; l < NET_LAYERS; l++) {
		gather(b, l);
		linear_forward(b->grown[l], b->gathered[l], w->layer[l], w->layer_bias[l], rows,
			NET_BLOCKS * NET_HIDDEN, NET_HIDDEN);
		for (size_t i = 0; i < rows * NET_HIDDEN; i++)
			b->h[l + 1][i] = b->h[l][i] + (b->grown[l][i] > 0 ? b->grown[l][i] : 0);
	}
	const float *h = b->h[NET_LAYERS];
	linear_forward(out, h, w->out, w->out_bias, rows, NET_HIDDEN, NET_OUT);
	linear_forward(b->dependent + at, h, w->dependent, w->dependent_bias, rows, NET_HIDDEN, NET_ARC);
	linear_forward(b->head + at, h, w->head, w->head_bias, rows, NET_HIDDEN, NET_ARC);
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
	const int first = b->start[sentence], n = b->start[sentence + 1] - first,
		  grammar = b->features[first + i].head;
	const float *dependent = b->dependent + at + (size_t)(first + i) * NET_ARC;
	const float scale = 1 / sqrtf(NET_ARC);

	for (int j = -1; j < n; j++) {
		const float *head = j < 0 ? w->root : b->head + at + (size_t)(first + j) * NET_ARC;
		float sum = 0;
		for (int k = 0; k < NET_ARC; k++)
			sum += dependent[k] * head[k];
		sum *= scale;
		sum += j < 0 ? w->root[NET_ARC] : w->distance[parser_distance(i, j)];
		if (grammar == j)
			sum += w->agree[j < 0];
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

void parser_decode(const struct parser_weights *w, const struct parser_batch *b, int sentence,
	const struct tokens *t, struct analysis *a, double *sure)
{
	int first = b->start[sentence];
	double sum = 0;

	*a = (struct analysis){.n = t->n};
	for (int i = 0; i < t->n; i++) {
		const float *out = b->out + (size_t)(first + i) * NET_OUT;
		a->word[i].role = (enum word_role)best_of(out, ROLES);
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
