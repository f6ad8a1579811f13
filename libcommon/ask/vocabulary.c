#include "ask/vocabulary.h"

#include "ask/constants.h"
#include "base/dot.h"
#include "base/mem.h"
#include "lang/colours.h"
#include "lang/kinds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void vocabulary_free(struct vocabulary *v)
{
	for (size_t r = 0; v->parses && r < v->lifted->sentences; r++)
		parse_free(&v->parses[r]);
	free(v->parses);
	free(v->mean);
	free(v->sentence_mean);
	free(v->items);
	free(v->vectors);
	free(v->sentences);
	free(v->kinds);
	for (size_t o = 0; v->heads && o < v->lifted->objects; o++)
		free(v->heads[o]);
	free(v->heads);
	free(v->head_kinds);
	free(v->scratch);
	free(v->about);
	free(v->word);
	free(v->other);
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

/* out (width) of length 1: the mean direction of a word's pieces, less the scene's mean. */
static void word_vector(struct vocabulary *v, const struct parse_word *w, const float *vectors, float *out)
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

/* out (width) of length 1: the mean of pieces, less one of v's means. */
static void sentence_vector(
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

/* out (width) of length 1: the mean of the pieces of the words that count, less the mean. */
static void words_vector(
	struct vocabulary *v, const struct vocabulary_sentence *s, const char *counts, float *out)
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
		sum[d] = pieces ? sum[d] / pieces - v->mean[d] : 0;
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
	to->lemma = lemma;
	to->uses.n = -1;
	wordnet_find(&to->noun, lemma);
	wordnet_find_adjective(&to->adjective, lemma);
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
	word_vector(v, w, vectors_of(l, r), v->vectors + width * v->n++);
	return 0;
}

/* The words of a phrase: its head by one role, the others as what is said of it. */
static int add_phrase(struct vocabulary *v, size_t r, const struct parse_phrase *f, enum vocabulary_role head,
	enum vocabulary_role other, enum parse_relation relation, struct err *e)
{
	int bad = 0;

	for (int i = 0; i < f->noun.n && !bad; i++) {
		bad = add_item(v, r, f->noun.item[i], i + 1 == f->noun.n ? head : other, relation, e);
		v->items[v->n - 1].is_of_name = !bad && head == VOCABULARY_NOUN;
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
		const struct parser_vectors vectors = {
			l->pieces[r], vectors_of(l, r), (int)(l->offsets[r + 1] - l->offsets[r]), l->width};
		bad = parse_sentence(&v->parses[r], parser, l->texts[r], &vectors, e) ||
		      add_sentence(v, r, e);
	}
	return bad ? -1 : 0;
}

int vocabulary_shares_noun(const struct vocabulary *v, size_t a, size_t b)
{
	for (size_t i = 0; i < v->n; i++)
		for (size_t k = 0; k < v->n && v->items[i].object == a && v->items[i].role == VOCABULARY_NOUN;
			k++)
			if (v->items[k].object == b && v->items[k].role == VOCABULARY_NOUN &&
				v->items[k].kind == v->items[i].kind)
				return 1;
	return 0;
}

static int are_akin(const struct vocabulary_kind *a, const struct vocabulary_kind *b)
{
	return a == b || wordnet_fits(&a->noun, &b->noun, 0) > 0 || wordnet_fits(&b->noun, &a->noun, 0) > 0 ||
	       kinds_share(a->lemma, b->lemma);
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
				q->kind == kind)
				continue;
			if (are_akin(&v->kinds[p->kind], &v->kinds[q->kind]))
				return 0;
			compared = 1;
		}
	return compared;
}

/* What kinds of a general noun there are says nothing of a thing that is called so. A noun is general that is
 * above another one of the same thing, or that is all that two things have in common: "crockery" of a plate
 * and a bowl. */
static void mark_general(struct vocabulary *v)
{
	for (size_t i = 0; i < v->n; i++) {
		struct vocabulary_item *a = &v->items[i];
		for (size_t k = 0; k < v->n && a->role == VOCABULARY_NOUN && !a->is_general; k++) {
			const struct vocabulary_item *b = &v->items[k];
			if (b->role != VOCABULARY_NOUN)
				continue;
			if (b->object == a->object)
				a->is_general =
					wordnet_is_above(&v->kinds[a->kind].noun, &v->kinds[b->kind].noun);
			else if (b->kind == a->kind)
				a->is_general = differ_but_for(v, a->object, b->object, a->kind);
		}
	}
}

static char lower(char c)
{
	return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* The nouns that objects' names end in. */
static int read_names(struct vocabulary *v, struct err *e)
{
	for (size_t o = 0; o < v->lifted->objects; o++) {
		const char *name = v->lifted->names[o], *head = name;
		size_t length = 0;
		for (const char *p = name; *p; p += strspn(p, " -_")) {
			const size_t n = strcspn(p, " -_");
			if (n && (*p < '0' || *p > '9')) {
				head = p;
				length = n;
			}
			p += n;
		}
		v->heads[o] = mem_strdup(head, e);
		if (!v->heads[o])
			return -1;
		v->heads[o][length] = 0;
		for (char *p = v->heads[o]; *p; p++)
			*p = lower(*p);
		if (add_kind(v, v->heads[o], &v->head_kinds[o], e))
			return -1;
	}
	return 0;
}

int vocabulary_make(struct vocabulary *v, const struct lifted *l, const struct parser *parser, struct err *e)
{
	const size_t width = (size_t)l->width;

	*v = (struct vocabulary){
		.lifted = l, .has_names = 1, .has_knowledge = 1, .has_said = 1, .without = l->sentences};
	v->parses = mem_zalloc(l->sentences, sizeof *v->parses, "vocabulary", e);
	v->mean = mem_zalloc(width, sizeof *v->mean, "vocabulary", e);
	v->sentence_mean = mem_zalloc(width, sizeof *v->sentence_mean, "vocabulary", e);
	v->sentences = mem_alloc(l->sentences, width * sizeof *v->sentences, "vocabulary", e);
	v->scratch = mem_alloc(width, sizeof *v->scratch, "vocabulary", e);
	v->about = mem_alloc(2 * width, sizeof *v->about, "vocabulary", e);
	v->word = mem_alloc(width, sizeof *v->word, "vocabulary", e);
	v->heads = mem_zalloc(l->objects, sizeof *v->heads, "vocabulary", e);
	v->head_kinds = mem_alloc(l->objects, sizeof *v->head_kinds, "vocabulary", e);
	v->other = mem_alloc(l->objects, sizeof *v->other, "vocabulary", e);
	if (!v->heads || !v->head_kinds || !v->other || !v->parses || !v->mean || !v->sentence_mean ||
		!v->sentences || !v->scratch || !v->about || !v->word)
		return -1;
	find_means(v);
	if (read_names(v, e) || read_sentences(v, parser, e))
		return -1;
	mark_general(v);
	for (size_t r = 0; r < l->sentences; r++)
		sentence_vector(v, vectors_of(l, r), (size_t)(l->offsets[r + 1] - l->offsets[r]),
			v->sentence_mean, v->sentences + r * width);
	return 0;
}

static double step(double x)
{
	return 1 / (1 + exp(-fmin(fmax(x, -40), 40)));
}

/* Whether a word is a word of a name: 2 the last one that is no number, 1 another. */
static int is_in_name(const char *word, const char *name)
{
	const size_t length = strlen(word);
	int is = 0;

	for (const char *p = name; *p; p += strspn(p, " -_")) {
		size_t n = strcspn(p, " -_"), same = 0;
		while (same < n && same < length && lower(p[same]) == word[same])
			same++;
		if (n && same == n && length == n)
			is = 2;
		else if (n && (*p < '0' || *p > '9'))
			is = is ? 1 : 0;
		p += n;
	}
	return is;
}

/* What the cosine of two words of a role is worth. */
static double worth(double cosine, double half, double soft)
{
	return step((cosine - half) / soft);
}

/* What is known besides of a noun and the one of this kind that a thing is called by. */
static double knowledge(const struct vocabulary *v, const char *lemma, const struct wordnet_noun *noun,
	const struct vocabulary_kind *kind, int is_general)
{
	const double x = WORDNET_WORTH * wordnet_fits(noun, &kind->noun, is_general);

	return v->has_knowledge && !is_general && kinds_share(lemma, kind->lemma) ? fmax(x, KINDS_WORTH) : x;
}

void vocabulary_noun(struct vocabulary *v, const struct vocabulary_sentence *s, int w, double *match)
{
	const struct lifted *l = v->lifted;
	const struct parse_word *word = &s->parse->words[w];
	const size_t width = (size_t)l->width, objects = l->objects;
	struct wordnet_noun noun;

	word_vector(v, word, s->vectors, v->word);
	noun.n = 0;
	if (v->has_knowledge)
		wordnet_find(&noun, word->lemma);
	for (size_t o = 0; o < objects; o++) {
		const int named = v->has_names ? is_in_name(word->lemma, l->names[o]) : 0;
		match[o] = named == 2 ? 1 : named ? NAME_PART : 0;
		if (v->has_names && named < 2)
			match[o] = fmax(
				match[o], knowledge(v, word->lemma, &noun, &v->kinds[v->head_kinds[o]], 0));
	}
	match[objects] = 0;
	for (size_t i = 0; i < v->n; i++) {
		const struct vocabulary_item *item = &v->items[i];
		if (item->sentence == v->without ||
			(item->role != VOCABULARY_NOUN && item->role != VOCABULARY_ANCHOR))
			continue;
		double x = !strcmp(word->lemma, item->lemma) ? 1 : 0;
		if (x < 1) {
			x = worth(dot_float(v->word, v->vectors + i * width, width), NOUN_HALF, NOUN_SOFT);
			x = fmax(
				x, knowledge(v, word->lemma, &noun, &v->kinds[item->kind], item->is_general));
		}
		double *to = &match[item->role == VOCABULARY_NOUN ? item->object : objects];
		*to = fmax(*to, x);
	}
}

void vocabulary_attribute(struct vocabulary *v, const struct vocabulary_sentence *s, int w, double *match)
{
	const struct lifted *l = v->lifted;
	const struct parse_word *word = &s->parse->words[w];
	const size_t width = (size_t)l->width;
	struct wordnet_adjective adjective;

	word_vector(v, word, s->vectors, v->word);
	adjective.n = 0;
	if (v->has_knowledge)
		wordnet_find_adjective(&adjective, word->lemma);
	for (size_t o = 0; o < l->objects; o++)
		match[o] = v->has_names && is_in_name(word->lemma, l->names[o]) ? 1 : 0;
	for (size_t i = 0; i < v->n; i++) {
		const struct vocabulary_item *item = &v->items[i];
		double *to = &match[item->object], x;
		if (item->sentence == v->without)
			continue;
		x = item->role == VOCABULARY_ATTRIBUTE
			    ? wordnet_adjectives_fit(&adjective, &v->kinds[item->kind].adjective)
			    : 0;
		if (x == 0)
			x = worth(dot_float(v->word, v->vectors + i * width, width), ATTRIBUTE_HALF,
				ATTRIBUTE_SOFT);
		x = !strcmp(word->lemma, item->lemma) ? 1 : x;
		/* what is said to be so once is so, whatever else is said */
		if (x > 0 ? x > *to && x > -*to : -x > fabs(*to))
			*to = x;
	}
}

void vocabulary_cosine(struct vocabulary *v, const struct vocabulary_sentence *s, int w, double *match)
{
	const struct lifted *l = v->lifted;
	const struct parse_word *word = &s->parse->words[w];
	const size_t width = (size_t)l->width;

	word_vector(v, word, s->vectors, v->word);
	for (size_t o = 0; o < l->objects; o++)
		match[o] = -1;
	for (size_t i = 0; i < v->n; i++) {
		const struct vocabulary_item *item = &v->items[i];
		const int is_place = item->role > VOCABULARY_ATTRIBUTE && item->relation != PARSE_WITH &&
				     item->relation != PARSE_OTHER;
		if (item->sentence == v->without || is_place)
			continue;
		match[item->object] =
			fmax(match[item->object], dot_float(v->word, v->vectors + i * width, width));
	}
	for (size_t o = 0; o < l->objects; o++) {
		match[o] = match[o] < -0.999 ? 0 : match[o];
		if (v->has_names && is_in_name(word->lemma, l->names[o]))
			match[o] = fmax(match[o], WORDING_NAME);
	}
}

/* What a training sentence's relation says of another: on a shelf is above it. */
static int is_like(enum parse_relation said, enum parse_relation meant)
{
	static const unsigned on = 1U << PARSE_ON | 1U << PARSE_ABOVE | 1U << PARSE_INSIDE;
	static const unsigned near = 1U << PARSE_NEAR | 1U << PARSE_WITH;

	return said == meant || ((on >> said & 1) && (on >> meant & 1)) ||
	       ((near >> said & 1) && (near >> meant & 1)) ||
	       ((1U << PARSE_NEAR | 1U << PARSE_OTHER) >> meant & 1);
}

void vocabulary_clause(struct vocabulary *v, const struct vocabulary_sentence *s, int w,
	enum parse_relation relation, double *match)
{
	const struct lifted *l = v->lifted;
	const struct parse_word *word = &s->parse->words[w];
	const size_t width = (size_t)l->width;

	word_vector(v, word, s->vectors, v->word);
	memset(match, 0, l->objects * sizeof *match);
	for (size_t i = 0; i < v->n && v->has_said; i++) {
		const struct vocabulary_item *item = &v->items[i];
		if (item->sentence == v->without || item->role != VOCABULARY_ANCHOR ||
			!is_like(item->relation, relation))
			continue;
		double x = worth(dot_float(v->word, v->vectors + i * width, width), NOUN_HALF, NOUN_SOFT);
		x = !strcmp(word->lemma, item->lemma) ? 1 : x;
		match[item->object] = fmax(match[item->object], x);
	}
}

/* How far things of a kind are for what a word says. */
static double kind_fits(struct vocabulary *v, size_t kind, const struct uses *word)
{
	struct vocabulary_kind *k = &v->kinds[kind];

	if (k->uses.n < 0)
		uses_of_thing(&k->uses, k->lemma);
	return uses_fit(&k->uses, word);
}

void vocabulary_use(struct vocabulary *v, const struct vocabulary_sentence *s, int w, double *match)
{
	const struct lifted *l = v->lifted;
	struct uses word;

	memset(match, 0, l->objects * sizeof *match);
	if (!v->has_knowledge)
		return;
	uses_of_word(&word, s->parse->words[w].lemma);
	for (size_t o = 0; o < l->objects && word.n && v->has_names; o++)
		match[o] = kind_fits(v, v->head_kinds[o], &word);
	for (size_t i = 0; i < v->n && word.n; i++) {
		const struct vocabulary_item *item = &v->items[i];
		if (item->role == VOCABULARY_NOUN && item->sentence != v->without && !item->is_general)
			match[item->object] = fmax(match[item->object], kind_fits(v, item->kind, &word));
	}
}

/* out (width), of length not 1: the mean of the words of a kind, as all sentences have it. */
static void kind_vector(const struct vocabulary *v, size_t kind, double *out)
{
	const size_t width = (size_t)v->lifted->width;
	double n = 0;

	memset(out, 0, width * sizeof *out);
	for (size_t i = 0; i < v->n; i++) {
		const struct vocabulary_item *item = &v->items[i];
		if (item->kind != kind || (item->role != VOCABULARY_NOUN && !item->is_of_name))
			continue;
		for (size_t d = 0; d < width; d++)
			out[d] += v->vectors[i * width + d];
		n++;
	}
	for (size_t d = 0; d < width; d++)
		out[d] /= fmax(n, 1);
}

void vocabulary_about(
	struct vocabulary *v, const struct vocabulary_sentence *s, const char *counts, double *match)
{
	const size_t width = (size_t)v->lifted->width;
	double *kind = v->about, *all = v->about + width;

	words_vector(v, s, counts, v->word);
	for (size_t o = 0; o < v->lifted->objects; o++) {
		double sum = 0, square = 0;
		memset(all, 0, width * sizeof *all);
		for (size_t i = 0; i < v->n; i++) {
			const struct vocabulary_item *item = &v->items[i];
			if (item->object != o || (item->role != VOCABULARY_NOUN && !item->is_of_name) ||
				item->is_general)
				continue;
			kind_vector(v, item->kind, kind);
			for (size_t d = 0; d < width; d++)
				all[d] += kind[d];
		}
		for (size_t d = 0; d < width; d++) {
			sum += all[d] * v->word[d];
			square += all[d] * all[d];
		}
		match[o] = square > 0 ? sum / sqrt(square) : 0;
	}
}

/* fit (O): how many of the training sentences that say a colour of an object say one like this: one of them
 * may have been misread. What is said of a part of it counts less. other (O): how many say another one. */
static void said_colours(const struct vocabulary *v, int colour, double *fit, double *other)
{
	const struct lifted *l = v->lifted;

	for (size_t o = 0; o < l->objects; o++) {
		double like = 0, all = 0, part = 0;
		for (size_t i = 0; i < v->n && v->has_said; i++) {
			const struct vocabulary_item *item = &v->items[i];
			const int said = item->object == o && item->sentence != v->without
						 ? colour_word(item->lemma)
						 : -1;
			if (said < 0)
				continue;
			const double alike = colour_words_alike(said, colour);
			if (item->role == VOCABULARY_ATTRIBUTE) {
				like += alike;
				all++;
			} else {
				part = fmax(part, PART_COLOUR * alike);
			}
		}
		fit[o] = fmax(all > 0 ? like / all : 0, part);
		other[o] = all > 0 ? 1 - like / all : 0;
	}
}

int vocabulary_colour(const struct vocabulary *v, const struct arrangement *a, const char *word, double *fit)
{
	const int colour = colour_word(word);

	if (colour < 0)
		return 0;
	said_colours(v, colour, fit, v->other);
	for (size_t o = 0; o < a->n; o++) {
		const double share = a->objects[o].colours[colour];
		const double looks = share / (share + COLOUR_SHARE);
		fit[o] = fmax(fit[o], looks * (1 - OTHER_COLOUR * v->other[o]));
	}
	return 1;
}

size_t vocabulary_whole(
	struct vocabulary *v, const char *text, const float *vectors, size_t pieces, double *match)
{
	const struct lifted *l = v->lifted;
	const size_t width = (size_t)l->width;
	size_t same = l->objects;

	sentence_vector(v, vectors, pieces, v->sentence_mean, v->word);
	for (size_t o = 0; o < l->objects; o++)
		match[o] = -1;
	for (size_t r = 0; r < l->sentences; r++) {
		const size_t o = (size_t)l->object[r];
		if (r == v->without)
			continue;
		match[o] = fmax(match[o], dot_float(v->word, v->sentences + r * width, width));
		if (text && same == l->objects && !strcmp(text, l->texts[r]))
			same = o;
	}
	return same;
}
