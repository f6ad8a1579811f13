#include "field/query.h"

#include "base/mem.h"

/* Vectors of words are about 6 long, and networks learn what is as large as fast. Of 1 and 3, mIoU of the
 * desk's 11 test sentences 73.7 and 77.1, of its relations 30.5 and 33.7 (1,250 steps of --init, one seed).
 */
static const float flag_size = 3;

/* A sentence's rows in the making. */
struct rows_of {
	const struct parse *parse;
	const float *vectors; /* (pieces, width) */
	int width;
	float *rows;
	size_t n, capacity;
};

int query_width(int width)
{
	return 2 * width + QUERY_FLAGS;
}

/* A row of zeros more; NULL with *e set. */
static float *add_row(struct rows_of *q, struct err *e)
{
	const size_t width = (size_t)query_width(q->width);

	if (mem_grow((void **)&q->rows, &q->capacity, q->n + 1, width * sizeof *q->rows, "query", e))
		return NULL;
	return memset(q->rows + q->n++ * width, 0, width * sizeof *q->rows);
}

static void set_flag(const struct rows_of *q, float *row, int flag)
{
	row[2 * q->width + flag] = flag_size;
}

/* The sum of a list's pieces is added to `to`. Returns how many. */
static int add_pieces(const struct rows_of *q, const struct parse_list *words, float *to)
{
	int n = 0;

	for (int i = 0; i < words->n; i++) {
		const struct parse_word *w = &q->parse->words[words->item[i]];
		for (int k = w->piece; k < w->piece + w->pieces; k++, n++)
			for (int d = 0; d < q->width; d++)
				to[d] += q->vectors[k * q->width + d];
	}
	return n;
}

static void divide(const struct rows_of *q, float *to, int n)
{
	for (int d = 0; d < q->width && n > 1; d++)
		to[d] /= (float)n;
}

/* A row for each piece of a phrase's own words. */
static int put_words(struct rows_of *q, const struct parse_phrase *p, int flag, int negated, struct err *e)
{
	const struct parse_list *lists[] = {&p->attributes, &p->noun};

	for (int l = 0; l < 2; l++)
		for (int i = 0; i < lists[l]->n; i++) {
			const struct parse_word *w = &q->parse->words[lists[l]->item[i]];
			for (int k = w->piece; k < w->piece + w->pieces; k++) {
				float *row = add_row(q, e);
				if (!row)
					return -1;
				memcpy(row, q->vectors + k * q->width, sizeof *row * (size_t)q->width);
				set_flag(q, row, flag);
				if (negated)
					set_flag(q, row, QUERY_NEGATED);
			}
		}
	return 0;
}

static int put_clause(struct rows_of *q, const struct parse_clause *c, int nested, struct err *e)
{
	float *row = add_row(q, e);
	int n = 0;

	if (!row)
		return -1;
	if (c->relation == PARSE_OTHER)
		divide(q, row, add_pieces(q, &c->words, row));
	for (int i = 0; i < c->anchors.n; i++) {
		const struct parse_phrase *a = &q->parse->phrases[c->anchors.item[i]];
		n += add_pieces(q, &a->attributes, row + q->width) + add_pieces(q, &a->noun, row + q->width);
	}
	divide(q, row + q->width, n);
	set_flag(q, row, (int)c->relation);
	set_flag(q, row, QUERY_CLAUSE);
	if (c->negated)
		set_flag(q, row, QUERY_NEGATED);
	if (nested)
		set_flag(q, row, QUERY_NESTED);
	if (c->degree != PARSE_PLAIN)
		set_flag(q, row, c->degree == PARSE_MORE ? QUERY_MORE : QUERY_MOST);
	return 0;
}

static int put_ordinal(struct rows_of *q, const struct parse_phrase *p, struct err *e)
{
	float *row = add_row(q, e);

	if (!row)
		return -1;
	set_flag(q, row, (int)p->from);
	set_flag(q, row, QUERY_ORDINAL + (p->ordinal < 1 || p->ordinal > 4 ? 4 : p->ordinal - 1));
	return 0;
}

/* What is said of a phrase, and of the anchors of that. */
static int put_clauses(struct rows_of *q, const struct parse_phrase *p, int nested, struct err *e)
{
	for (int i = 0; i < p->clauses.n; i++) {
		const struct parse_clause *c = &q->parse->clauses[p->clauses.item[i]];
		const int has = c->relation == PARSE_WITH && c->anchors.n && !nested;
		if (!has && put_clause(q, c, nested, e))
			return -1;
		for (int k = 0; k < c->anchors.n; k++) {
			const struct parse_phrase *a = &q->parse->phrases[c->anchors.item[k]];
			if ((has && put_words(q, a, QUERY_HAS, c->negated, e)) || put_clauses(q, a, 1, e))
				return -1;
		}
	}
	return p->ordinal ? put_ordinal(q, p, e) : 0;
}

static const char *head(const struct rows_of *q, const struct parse_list *noun)
{
	return q->parse->words[noun->item[noun->n - 1]].lemma;
}

/* What is left out: its own words, but not the target's noun that it repeats ("the red one"), and what is
 * said of it, each as what does not hold. */
static int put_except(struct rows_of *q, const struct parse_phrase *p, struct err *e)
{
	const struct parse_list *noun = &q->parse->phrases->noun;
	struct parse_phrase own = *p;
	const size_t before = q->n;

	if (p->noun.n && noun->n && !strcmp(head(q, &p->noun), head(q, noun)))
		own.noun.n = 0;
	if (put_words(q, &own, QUERY_TARGET, 1, e) || put_clauses(q, p, 0, e))
		return -1;
	for (size_t k = before; k < q->n; k++)
		set_flag(q, q->rows + k * (size_t)query_width(q->width), QUERY_NEGATED);
	return 0;
}

static int put_parse(struct rows_of *q, struct err *e)
{
	const struct parse *p = q->parse;

	if (put_words(q, p->phrases, QUERY_TARGET, 0, e) || put_clauses(q, p->phrases, 0, e))
		return -1;
	for (int i = 0; i < p->phrases->also.n; i++) {
		const struct parse_phrase *also = &p->phrases[p->phrases->also.item[i]];
		if (put_words(q, also, QUERY_TARGET, 0, e) || put_clauses(q, also, 0, e))
			return -1;
	}
	for (int i = 0; i < p->phrases->except.n; i++)
		if (put_except(q, &p->phrases[p->phrases->except.item[i]], e))
			return -1;
	return 0;
}

static int put_raw(struct rows_of *q, size_t pieces, struct err *e)
{
	for (size_t k = 0; k < pieces; k++) {
		float *row = add_row(q, e);
		if (!row)
			return -1;
		memcpy(row, q->vectors + k * (size_t)q->width, sizeof *row * (size_t)q->width);
		set_flag(q, row, QUERY_RAW);
	}
	return 0;
}

static int make_one(
	struct rows_of *q, const struct query_text *t, size_t r, const struct parser *parser, struct err *e)
{
	const size_t at = (size_t)t->offsets[r] * (size_t)t->width,
		     pieces = (size_t)(t->offsets[r + 1] - t->offsets[r]);
	const struct parser_vectors v = {
		t->pieces[r], t->middle ? t->middle + at : NULL, (int)pieces, t->width};
	SCOPED_BY(parse_free) struct parse p = {0};

	*q = (struct rows_of){.parse = &p, .vectors = t->words + at, .width = t->width};
	if (!pieces)
		return 0;
	int bad = parse_sentence(&p, parser, t->texts[r], &v, e) || put_parse(q, e) ||
		  (!q->n && put_raw(q, pieces, e));
	q->parse = NULL;
	return bad;
}

static int pack(struct query *q, const struct rows_of *of, size_t n, size_t width, struct err *e)
{
	if (!(q->offsets = mem_zalloc(n + 1, sizeof *q->offsets, "query", e)))
		return -1;
	for (size_t r = 0; r < n; r++)
		q->offsets[r + 1] = q->offsets[r] + (int64_t)of[r].n;
	if (!(q->words = mem_alloc((size_t)q->offsets[n], width * sizeof *q->words, "query", e)))
		return -1;
	for (size_t r = 0; r < n; r++)
		if (of[r].n)
			memcpy(q->words + (size_t)q->offsets[r] * width, of[r].rows,
				of[r].n * width * sizeof *q->words);
	return 0;
}

int query_make(struct query *q, const struct query_text *t, const struct parser *parser, struct err *e)
{
	SCOPED struct rows_of *of = mem_zalloc(t->n, sizeof *of, "query", e);
	int bad = !of;

	*q = (struct query){0};
	for (size_t r = 0; r < t->n && !bad; r++)
		bad = make_one(&of[r], t, r, parser, e);
	bad = bad || pack(q, of, t->n, (size_t)query_width(t->width), e);
	for (size_t r = 0; of && r < t->n; r++)
		free(of[r].rows);
	return bad ? -1 : 0;
}

void query_free(struct query *q)
{
	mem_free_all(q->offsets, q->words);
	*q = (struct query){0};
}
