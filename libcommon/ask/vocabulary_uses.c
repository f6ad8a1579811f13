/* What sentences as a whole say: the use of things, and what things are for. */
#include "ask/constants.h"
#include "ask/vocabulary_private.h"
#include "base/dot.h"
#include "base/mem.h"

#include <math.h>

void vocabulary_about(
	struct vocabulary *v, const struct vocabulary_sentence *s, const char *counts, double *match)
{
	const size_t width = (size_t)v->lifted->width;

	vocabulary_words_vector(v, s, counts, v->mean, v->word);
	for (size_t o = 0; o < v->lifted->objects; o++)
		match[o] = dot_float(v->word, v->about + o * width, width);
}

/* Adds lines of the table to an object's, each once. */
static int add_lines(struct vocabulary *v, size_t object, const struct things_rows *rows, struct err *e)
{
	for (int i = 0; i < rows->n; i++) {
		size_t k = v->line_begin[object];
		while (k < v->line_count && v->lines[k] != rows->row[i])
			k++;
		if (k < v->line_count)
			continue;
		if (mem_grow((void **)&v->lines, &v->line_capacity, v->line_count + 1, sizeof *v->lines,
			    "vocabulary", e))
			return -1;
		v->lines[v->line_count++] = rows->row[i];
	}
	return 0;
}

int vocabulary_find_lines(struct vocabulary *v, const struct parser *parser, struct err *e)
{
	const struct lifted *l = v->lifted;

	v->line_begin = mem_zalloc(l->objects + 1, sizeof *v->line_begin, "vocabulary", e);
	v->line_named = mem_zalloc(l->objects + 1, sizeof *v->line_named, "vocabulary", e);
	if (!v->line_begin || !v->line_named || things_vectors_open(&v->things, parser->encoder, l->width, e))
		return -1;
	v->cosine = mem_alloc((size_t)v->things.lines, sizeof *v->cosine, "vocabulary", e);
	for (size_t o = 0; o < l->objects; o++) {
		const struct things_rows *whole = &v->kinds[v->whole_kinds[o]].naming.things;
		v->line_begin[o] = v->line_count;
		for (size_t i = 0; i < v->n; i++) {
			const struct vocabulary_item *item = &v->items[i];
			if (item->object == o && item->role == VOCABULARY_NOUN && !item->is_general &&
				add_lines(v, o, &v->kinds[item->kind].naming.things, e))
				return -1;
		}
		v->line_named[o] = v->line_count;
		if (add_lines(v, o, whole->n ? whole : &v->kinds[v->head_kinds[o]].naming.things, e) ||
			(*v->contents[o] && add_lines(v, o, &v->kinds[v->content_kinds[o]].naming.things, e)))
			return -1;
	}
	v->line_begin[l->objects] = v->line_count;
	return v->cosine ? 0 : -1;
}

/* log of the sum over all things of exp(cosine / soft), times soft. */
static double any_thing(const struct vocabulary *v)
{
	double sum = 0;

	for (int i = 0; i < v->things.lines; i++)
		sum += exp((double)v->cosine[i] / USE_SOFT);
	return USE_SOFT * log(sum);
}

int vocabulary_for(struct vocabulary *v, const struct vocabulary_sentence *s, const char *counts,
	const double *about, double *match, double *any)
{
	if (!v->things.lines || !v->has_knowledge)
		return 0;
	vocabulary_words_vector(v, s, counts, NULL, v->word);
	things_vectors_cosines(&v->things, v->word, v->cosine);
	*any = any_thing(v);
	for (size_t o = 0; o < v->lifted->objects; o++) {
		const size_t begin = v->line_begin[o],
			     end = v->has_names ? v->line_begin[o + 1] : v->line_named[o];
		match[o] = begin < end ? -1 : USE_BY_NAME * about[o] + USE_OF_ANY;
		for (size_t k = begin; k < end; k++)
			match[o] = fmax(match[o], (double)v->cosine[v->lines[k]]);
	}
	return 1;
}

size_t vocabulary_whole(
	struct vocabulary *v, const char *text, const float *vectors, size_t pieces, double *match)
{
	const struct lifted *l = v->lifted;
	const size_t width = (size_t)l->width;
	size_t same = l->objects;

	vocabulary_sentence_vector(v, vectors, pieces, v->sentence_mean, v->word);
	for (size_t o = 0; o < l->objects; o++)
		match[o] = -1;
	for (size_t r = 0; r < l->sentences; r++) {
		const size_t o = (size_t)l->object[r];
		match[o] = fmax(match[o], dot_float(v->word, v->sentences + r * width, width));
		if (text && same == l->objects && !strcmp(text, l->texts[r]))
			same = o;
	}
	return same;
}

void vocabulary_at(struct vocabulary *v, const struct vocabulary_sentence *s, int w, double *match)
{
	const unsigned at = 1U << PARSE_NEAR | 1U << PARSE_ON | 1U << PARSE_INSIDE | 1U << PARSE_ABOVE |
			    1U << PARSE_BELOW | 1U << PARSE_FRONT | 1U << PARSE_BEHIND | 1U << PARSE_LEFT |
			    1U << PARSE_RIGHT | 1U << PARSE_BETWEEN;
	const char *lemma = s->parse->words[w].lemma;
	struct naming known = {0};

	if (v->has_knowledge)
		naming_of_word(&known, lemma);
	for (size_t o = 0; o < v->lifted->objects; o++)
		match[o] = v->has_names && v->has_said &&
			   vocabulary_in_name(lemma, v->lifted->names[o]) == 1 && wordnet_is_noun(lemma) &&
			   !wordnet_is_adjective(lemma);
	for (size_t i = 0; i < v->n && v->has_said; i++) {
		const struct vocabulary_item *item = &v->items[i];
		if (item->role == VOCABULARY_ANCHOR && at >> item->relation & 1 &&
			(!strcmp(lemma, item->lemma) ||
				(v->has_knowledge && !v->kinds[item->kind].is_thing &&
					naming_fits(&known, &v->kinds[item->kind].naming, 0) >= 0.5)))
			match[item->object] = 1;
	}
}
