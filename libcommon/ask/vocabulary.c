#include "ask/vocabulary_private.h"

#include "ask/constants.h"
#include "base/mem.h"
#include "lang/closed.h"
#include "lang/finish.h"
#include "lang/kinds.h"

#include <math.h>

void vocabulary_free(struct vocabulary *v)
{
	for (size_t r = 0; v->parses && r < v->lifted->sentences; r++)
		parse_free(&v->parses[r]);
	mem_free_strings(v->heads, v->lifted->objects);
	mem_free_strings(v->contents, v->lifted->objects);
	mem_free_strings(v->wholes, v->lifted->objects);
	mem_free_all(v->parses, v->mean, v->sentence_mean, v->items, v->vectors, v->sentences, v->kinds,
		v->content_kinds, v->head_kinds, v->whole_kinds, v->scratch, v->about, v->kin, v->word,
		v->other, v->line_begin, v->line_named, v->lines, v->cosine);
	things_vectors_free(&v->things);
	*v = (struct vocabulary){0};
}

/* out (width) of length 1: x over its length. */
static void take_direction(const double *x, int width, float *out)
{
	double square = 0;

	for (int d = 0; d < width; d++)
		square += x[d] * x[d];
	const double length = sqrt(square);
	for (int d = 0; d < width; d++)
		out[d] = length > 0 ? (float)(x[d] / length) : 0;
}

void vocabulary_word_vector(
	struct vocabulary *v, const struct parse_word *w, const float *vectors, float *out)
{
	const int width = v->lifted->width;
	double *sum = v->scratch;

	memset(sum, 0, (size_t)width * sizeof *sum);
	for (int p = w->piece; p < w->piece + w->pieces; p++) {
		const float *x = vectors + (size_t)p * (size_t)width;
		double square = 0;
		for (int d = 0; d < width; d++)
			square += (x[d] - v->mean[d]) * (x[d] - v->mean[d]);
		for (int d = 0; d < width && square > 0; d++)
			sum[d] += (x[d] - v->mean[d]) / sqrt(square);
	}
	take_direction(sum, width, out);
}

void vocabulary_sentence_vector(
	struct vocabulary *v, const float *vectors, size_t pieces, const double *less, float *out)
{
	const int width = v->lifted->width;
	double *sum = v->scratch;

	for (int d = 0; d < width; d++) {
		sum[d] = 0;
		for (size_t w = 0; w < pieces; w++)
			sum[d] += vectors[w * (size_t)width + (size_t)d];
		sum[d] = sum[d] / (double)(pieces ? pieces : 1) - less[d];
	}
	take_direction(sum, width, out);
}

void vocabulary_words_vector(struct vocabulary *v, const struct vocabulary_sentence *s, const char *counts,
	const double *less, float *out)
{
	const size_t width = (size_t)v->lifted->width;
	double *sum = v->scratch, pieces = 0;

	memset(sum, 0, width * sizeof *sum);
	for (int w = 0; w < s->parse->word_count; w++)
		for (int p = s->parse->words[w].piece;
			counts[w] && p < s->parse->words[w].piece + s->parse->words[w].pieces; p++) {
			for (size_t d = 0; d < width; d++)
				sum[d] += s->vectors[(size_t)p * width + d];
			pieces++;
		}
	for (size_t d = 0; d < width; d++)
		sum[d] = pieces ? sum[d] / pieces - (less ? less[d] : 0) : 0;
	take_direction(sum, v->lifted->width, out);
}

/* Both means, of length not 1. */
static void find_means(struct vocabulary *v)
{
	const struct lifted *l = v->lifted;
	const size_t width = (size_t)l->width;

	for (size_t r = 0; r < l->sentences; r++) {
		const double words = (double)(l->offsets[r + 1] - l->offsets[r]);
		for (int64_t w = l->offsets[r]; w < l->offsets[r + 1]; w++)
			for (size_t d = 0; d < width; d++) {
				const double x = l->words[(size_t)w * width + d];
				v->mean[d] += x / (double)l->offsets[l->sentences];
				v->sentence_mean[d] += x / words / (double)l->sentences;
			}
	}
}

static const float *vectors_of(const struct lifted *l, size_t r)
{
	return l->words + (size_t)l->offsets[r] * (size_t)l->width;
}

static int add_kind(struct vocabulary *v, const char *lemma, size_t *kind, struct err *e)
{
	for (*kind = 0; *kind < v->kind_count; ++*kind)
		if (!strcmp(v->kinds[*kind].lemma, lemma))
			return 0;
	if (mem_grow((void **)&v->kinds, &v->kind_capacity, v->kind_count + 1, sizeof *v->kinds, "vocabulary",
		    e))
		return -1;
	struct vocabulary_kind *to = &v->kinds[v->kind_count++];
	*to = (struct vocabulary_kind){0};
	to->lemma = lemma;
	to->parts.n = -1;
	naming_of_thing(&to->naming, lemma);
	to->finish = finish_of(lemma);
	return 0;
}

static int add_item(struct vocabulary *v, size_t r, int word, enum vocabulary_role role,
	enum parse_relation relation, struct err *e)
{
	const struct lifted *l = v->lifted;
	const struct parse_word *w = &v->parses[r].words[word];
	const size_t width = (size_t)l->width;
	size_t capacity = v->capacity;

	if (mem_grow((void **)&v->items, &capacity, v->n + 1, sizeof *v->items, "vocabulary", e) ||
		mem_grow((void **)&v->vectors, &v->capacity, v->n + 1, width * sizeof *v->vectors,
			"vocabulary", e))
		return -1;
	struct vocabulary_item *item = &v->items[v->n];
	*item = (struct vocabulary_item){role, (size_t)l->object[r], r, w->lemma, relation, 0, 0, 0};
	if (add_kind(v, w->lemma, &item->kind, e))
		return -1;
	vocabulary_word_vector(v, w, vectors_of(l, r), v->vectors + width * v->n++);
	return 0;
}

/* The words of a phrase: its head by one role, the others as what is said of it. */
static int add_phrase(struct vocabulary *v, size_t r, const struct parse_phrase *f, enum vocabulary_role head,
	enum vocabulary_role other, enum parse_relation relation, struct err *e)
{
	int bad = 0;

	for (int i = 0; i < f->noun.n && !bad; i++) {
		bad = add_item(v, r, f->noun.item[i], i + 1 == f->noun.n ? head : other, relation, e);
		if (!bad)
			v->items[v->n - 1].is_of_name = head == VOCABULARY_NOUN;
	}
	for (int i = 0; i < f->attributes.n && !bad; i++)
		bad = add_item(v, r, f->attributes.item[i], other, relation, e);
	return bad;
}

static int add_sentence(struct vocabulary *v, size_t r, struct err *e)
{
	const struct parse *p = &v->parses[r];
	int bad = add_phrase(v, r, &p->phrases[0], VOCABULARY_NOUN, VOCABULARY_ATTRIBUTE, PARSE_OTHER, e);

	for (int c = 0; c < p->clause_count && !bad; c++) {
		const struct parse_clause *clause = &p->clauses[c];
		for (int k = 0; k < clause->anchors.n && !bad; k++)
			bad = add_phrase(v, r, &p->phrases[clause->anchors.item[k]], VOCABULARY_ANCHOR,
				VOCABULARY_OTHER, clause->relation, e);
		for (int k = 0; k < clause->words.n && !bad; k++)
			bad = add_item(v, r, clause->words.item[k], VOCABULARY_OTHER, clause->relation, e);
	}
	for (int k = 0; k < p->unexplained.n && !bad; k++)
		bad = add_item(v, r, p->unexplained.item[k], VOCABULARY_OTHER, PARSE_OTHER, e);
	return bad;
}

static int read_sentences(struct vocabulary *v, const struct parser *parser, struct err *e)
{
	const struct lifted *l = v->lifted;
	int bad = 0;

	for (size_t r = 0; r < l->sentences && !bad; r++) {
		const struct parser_vectors vectors = {l->pieces[r], lifted_middle(l, r),
			(int)(l->offsets[r + 1] - l->offsets[r]), l->width};
		bad = parse_sentence(&v->parses[r], parser, l->texts[r], &vectors, e) ||
		      add_sentence(v, r, e);
	}
	return bad ? -1 : 0;
}

/* Whether two objects were called by one noun that is not general. */
static int share_noun(const struct vocabulary *v, size_t a, size_t b)
{
	for (size_t i = 0; i < v->n; i++)
		for (size_t k = 0; k < v->n && v->items[i].object == a && v->items[i].role == VOCABULARY_NOUN;
			k++)
			if (v->items[k].object == b && v->items[k].role == VOCABULARY_NOUN &&
				v->items[k].kind == v->items[i].kind &&
				!(v->items[i].is_general || v->items[k].is_general))
				return 1;
	return 0;
}

/* Whether two objects were called by other nouns than this one, and none of them are akin. */
static int differ_but_for(const struct vocabulary *v, size_t a, size_t b, size_t kind)
{
	int compared = 0;

	for (size_t i = 0; i < v->n; i++)
		for (size_t k = 0; k < v->n && v->items[i].object == a && v->items[i].role == VOCABULARY_NOUN;
			k++) {
			const struct vocabulary_item *p = &v->items[i], *q = &v->items[k];
			if (q->object != b || q->role != VOCABULARY_NOUN || p->kind == kind ||
				q->kind == kind || closed_is(p->lemma, CLOSED_GENERIC) ||
				closed_is(q->lemma, CLOSED_GENERIC))
				continue;
			const struct naming *x = &v->kinds[p->kind].naming, *y = &v->kinds[q->kind].naming;
			if (x == y || naming_fits(x, y, 0) > 0 || naming_fits(y, x, 0) > 0)
				return 0;
			compared = 1;
		}
	return compared;
}

/* What kinds of a general noun there are says nothing of a thing that is called so. A noun is general that is
 * "thing", that is above another one of the same thing, or that is all that two things have in common:
 * "crockery" of a plate and a bowl. */
static void mark_general(struct vocabulary *v)
{
	for (size_t i = 0; i < v->n; i++) {
		struct vocabulary_item *a = &v->items[i];
		a->is_general = a->role == VOCABULARY_NOUN && closed_is(a->lemma, CLOSED_GENERIC);
		v->kinds[a->kind].is_thing |= a->role == VOCABULARY_NOUN;
		for (size_t k = 0; k < v->n && a->role == VOCABULARY_NOUN && !a->is_general; k++) {
			const struct vocabulary_item *b = &v->items[k];
			if (b->role != VOCABULARY_NOUN)
				continue;
			if (b->object == a->object)
				a->is_general = wordnet_is_above(
					&v->kinds[a->kind].naming.noun, &v->kinds[b->kind].naming.noun);
			else if (b->kind == a->kind)
				a->is_general = differ_but_for(v, a->object, b->object, a->kind);
		}
	}
}

/* Which objects are of one kind: 2 called by one noun that is not general, 1 their names end alike. */
static int find_kin(struct vocabulary *v, struct err *e)
{
	const size_t n = v->lifted->objects;

	v->kin = mem_alloc(n, n * sizeof *v->kin, "vocabulary", e);
	for (size_t o = 0; o < n && v->kin; o++)
		for (size_t k = 0; k < n; k++)
			v->kin[o * n + k] =
				(char)(share_noun(v, o, k)
						? 2
						: *v->heads[o] && v->head_kinds[o] == v->head_kinds[k]);
	return v->kin ? 0 : -1;
}

static int is_called(const struct vocabulary_item *i)
{
	return i->role == VOCABULARY_NOUN || i->is_of_name;
}

/* out (width) gets the mean of the words of a kind in all sentences added: what stands around a noun in one
 * sentence then counts little. */
static void add_kind_vector(const struct vocabulary *v, size_t kind, double *out)
{
	const size_t width = (size_t)v->lifted->width;
	size_t n = 0;

	for (size_t i = 0; i < v->n; i++)
		n += v->items[i].kind == kind && is_called(&v->items[i]);
	for (size_t i = 0; i < v->n; i++)
		for (size_t d = 0; d < width && v->items[i].kind == kind && is_called(&v->items[i]); d++)
			out[d] += v->vectors[i * width + d] / (double)n;
}

/* What each object is about: its nouns. */
static int find_about(struct vocabulary *v, struct err *e)
{
	const size_t width = (size_t)v->lifted->width;

	v->about = mem_alloc(v->lifted->objects, width * sizeof *v->about, "vocabulary", e);
	if (!v->about)
		return -1;
	for (size_t o = 0; o < v->lifted->objects; o++) {
		memset(v->scratch, 0, width * sizeof *v->scratch);
		for (size_t i = 0; i < v->n; i++)
			if (v->items[i].object == o && is_called(&v->items[i]) && !v->items[i].is_general)
				add_kind_vector(v, v->items[i].kind, v->scratch);
		take_direction(v->scratch, v->lifted->width, v->about + o * width);
	}
	return 0;
}

static char *lower_copy(const char *word, size_t length, struct err *e)
{
	char *copy = mem_strdup(word, e);

	for (size_t i = 0; copy && i < length; i++)
		copy[i] = vocabulary_lower(copy[i]);
	if (copy)
		copy[length] = 0;
	return copy;
}

/* The longest end of a name that is known: "pencil case" of "red pencil case". */
static int read_whole(struct vocabulary *v, size_t o, struct err *e)
{
	const char *const name = v->lifted->names[o];
	size_t n = strlen(name);
	struct naming known;

	while (n && (strchr(" -_", name[n - 1]) || (name[n - 1] >= '0' && name[n - 1] <= '9')))
		n--;
	v->wholes[o] = lower_copy(name, n, e);
	if (!v->wholes[o])
		return -1;
	for (char *p = v->wholes[o]; *p; p++)
		*p = (char)(strchr("-_", *p) ? ' ' : *p);
	for (char *gap; naming_of_thing(&known, v->wholes[o]),
		!naming_is_known(&known) && (gap = strchr(v->wholes[o], ' '));)
		memmove(v->wholes[o], gap + 1, strlen(gap));
	return add_kind(v, v->wholes[o], &v->whole_kinds[o], e);
}

/* The nouns that objects' names end in, and what is in them. */
static int read_names(struct vocabulary *v, struct err *e)
{
	for (size_t o = 0; o < v->lifted->objects; o++) {
		const char *name = v->lifted->names[o], *head = name, *before = name;
		size_t length = 0, length_before = 0;
		for (const char *p = name; *p; p += strspn(p, " -_")) {
			const size_t n = strcspn(p, " -_");
			if (n && (*p < '0' || *p > '9')) {
				before = head;
				length_before = length;
				head = p;
				length = n;
			}
			p += n;
		}
		v->heads[o] = lower_copy(head, length, e);
		if (!v->heads[o])
			return -1;
		v->contents[o] = lower_copy(before,
			kinds_listed("holder", v->heads[o]) || kinds_listed("gathering", v->heads[o])
				? length_before
				: 0,
			e);
		if (!v->contents[o] || add_kind(v, v->heads[o], &v->head_kinds[o], e) ||
			add_kind(v, v->contents[o], &v->content_kinds[o], e) || read_whole(v, o, e))
			return -1;
	}
	return 0;
}

int vocabulary_make(struct vocabulary *v, const struct lifted *l, const struct parser *parser, struct err *e)
{
	const size_t width = (size_t)l->width;

	*v = (struct vocabulary){.lifted = l, .has_names = 1, .has_knowledge = 1, .has_said = 1};
	v->parses = mem_zalloc(l->sentences, sizeof *v->parses, "vocabulary", e);
	v->mean = mem_zalloc(width, sizeof *v->mean, "vocabulary", e);
	v->sentence_mean = mem_zalloc(width, sizeof *v->sentence_mean, "vocabulary", e);
	v->sentences = mem_alloc(l->sentences, width * sizeof *v->sentences, "vocabulary", e);
	v->scratch = mem_alloc(width, sizeof *v->scratch, "vocabulary", e);
	v->word = mem_alloc(width, sizeof *v->word, "vocabulary", e);
	v->heads = mem_zalloc(l->objects, sizeof *v->heads, "vocabulary", e);
	v->head_kinds = mem_alloc(l->objects, sizeof *v->head_kinds, "vocabulary", e);
	v->contents = mem_zalloc(l->objects, sizeof *v->contents, "vocabulary", e);
	v->content_kinds = mem_alloc(l->objects, sizeof *v->content_kinds, "vocabulary", e);
	v->wholes = mem_zalloc(l->objects, sizeof *v->wholes, "vocabulary", e);
	v->whole_kinds = mem_alloc(l->objects, sizeof *v->whole_kinds, "vocabulary", e);
	v->other = mem_alloc(l->objects, sizeof *v->other, "vocabulary", e);
	if (!v->heads || !v->head_kinds || !v->contents || !v->content_kinds || !v->wholes ||
		!v->whole_kinds || !v->other || !v->parses || !v->mean || !v->sentence_mean ||
		!v->sentences || !v->scratch || !v->word)
		return -1;
	find_means(v);
	if (read_names(v, e) || read_sentences(v, parser, e))
		return -1;
	mark_general(v);
	for (size_t o = 0; o < l->objects; o++)
		v->kinds[v->head_kinds[o]].is_thing = v->kinds[v->whole_kinds[o]].is_thing = 1;
	if (find_about(v, e) || find_kin(v, e) || vocabulary_find_lines(v, parser, e))
		return -1;
	for (size_t r = 0; r < l->sentences; r++)
		vocabulary_sentence_vector(v, vectors_of(l, r), (size_t)(l->offsets[r + 1] - l->offsets[r]),
			v->sentence_mean, v->sentences + r * width);
	return 0;
}
