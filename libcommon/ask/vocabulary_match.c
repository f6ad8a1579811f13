/* How words match what objects are called and said to be. */
#include "ask/constants.h"
#include "ask/vocabulary_private.h"
#include "base/dot.h"
#include "base/largest.h"
#include "base/logistic.h"
#include "lang/colours.h"
#include "lang/finish.h"
#include "lang/kinds.h"
#include "lang/naming.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

int vocabulary_in_name(const char *word, const char *name)
{
	const size_t length = strlen(word);
	const char *joined = word;
	int is = 0;

	for (const char *p = name; joined && (*p || *joined); p++)
		if (!*p || !strchr(" -_", *p))
			joined = *joined && *joined == vocabulary_lower(*p) ? joined + 1 : NULL;
	if (joined)
		return 2;
	for (const char *p = name; *p; p += strspn(p, " -_")) {
		size_t n = strcspn(p, " -_"), same = 0;
		while (same < n && same < length && vocabulary_lower(p[same]) == word[same])
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
	return logistic((cosine - half) / soft);
}

/* What is known besides of a noun and the one of this kind that a thing is called by. */
static double knowledge(const struct vocabulary *v, const struct naming *word, size_t kind, int is_general)
{
	return v->has_knowledge ? naming_fits(word, &v->kinds[kind].naming, is_general) : 0;
}

/* The same of what a thing is called by its name. */
static double knowledge_of_name(const struct vocabulary *v, const struct naming *word, size_t object)
{
	return fmax(
		knowledge(v, word, v->head_kinds[object], 0), knowledge(v, word, v->whole_kinds[object], 0));
}

int vocabulary_is_above(const struct vocabulary *v, const char *lemma, size_t object)
{
	const struct naming *head = &v->kinds[v->head_kinds[object]].naming,
			    *content = &v->kinds[v->content_kinds[object]].naming;
	struct naming above;

	if (!v->has_names || !v->has_knowledge)
		return 0;
	naming_of_word(&above, lemma);
	return wordnet_is_above(&above.noun, &head->noun) || kinds_are_of(&above.kinds, &head->kinds) ||
	       (kinds_listed("gathering", v->heads[object]) && wordnet_is_above(&above.noun, &content->noun));
}

int vocabulary_is_furniture(const struct vocabulary *v, size_t object)
{
	return vocabulary_is_above(v, "furniture", object);
}

/* What one mug is called, another may be called too; of several it has to have that name. match (O) in and
 * out; own (O) is scratch. */
static void share_kin(const struct vocabulary *v, int is_name, double *own, double *match)
{
	const size_t n = v->lifted->objects;

	memcpy(own, match, n * sizeof *own);
	for (size_t o = 0; o < n; o++)
		for (size_t k = 0; k < n && own[o] > KIN_LEAST; k++)
			if (v->kin[o * n + k] > !v->has_names &&
				(!is_name || v->head_kinds[o] == v->head_kinds[k]))
				match[k] = fmax(match[k], KIN_WORTH * own[o]);
}

/* How far a word is of what a thing holds by its name: the eraser of an "eraser box". */
static double holds(const struct vocabulary *v, const struct naming *word, size_t object)
{
	const char *content = v->contents[object];

	if (!*content || colour_word(content) >= 0)
		return 0;
	const double x =
		strcmp(word->lemma, content) != 0 ? knowledge(v, word, v->content_kinds[object], 0) : 1;
	return (kinds_listed("gathering", v->heads[object]) ? KIN_WORTH : CONTENT_WORTH) * x;
}

/* The first word of a noun of two that ends at word w and that is known as one, such as "tea bag"; or -1. */
static int find_compound(const struct parse *p, int w, struct naming *to, char *lemma, size_t size)
{
	for (int i = 0; i < p->phrase_count; i++) {
		const struct parse_list *noun = &p->phrases[i].noun;
		if (noun->n < 2 || noun->item[noun->n - 1] != w)
			continue;
		const int first = noun->item[noun->n - 2];
		snprintf(lemma, size, "%s %s", p->words[first].lemma, p->words[w].lemma);
		naming_of_word(to, lemma);
		return naming_is_known(to) ? first : -1;
	}
	return -1;
}

/* Whether a word is said of an object: in its name, or of it in a sentence. */
static int is_said_of(const struct vocabulary *v, const char *lemma, size_t object)
{
	if (v->has_names && vocabulary_in_name(lemma, v->lifted->names[object]))
		return 1;
	for (size_t i = 0; i < v->n; i++)
		if (v->items[i].object == object && v->items[i].role <= VOCABULARY_ATTRIBUTE &&
			!strcmp(v->items[i].lemma, lemma))
			return 1;
	return 0;
}

/* Whether a kind that has a name of two words is one that people call by its second word alone: it is for the
 * same as the object, as a gift bag is, and less so where WordNet has it as a kind of that. */
static int is_sort_of(
	const struct vocabulary *v, const struct naming *two, const struct naming *second, size_t object)
{
	const size_t begin = v->line_begin[object];
	const size_t end = v->has_names ? v->line_begin[object + 1] : v->line_named[object];
	const double alike = things_vectors_between(
		&v->things, two->things.row, (size_t)two->things.n, v->lines + begin, end - begin);
	const int is_kind = wordnet_is_above(&second->noun, &two->noun);

	return alike < 0 ? is_kind : alike > (is_kind ? USES_ALIKE_KIND : USES_ALIKE);
}

/* A kind that has a name of two words is another thing than what its second word alone names, a tea bag in a
 * room with a red bag, unless it is a sort of that, as a water bottle is. */
static void judge_compound(struct vocabulary *v, const struct parse *p, int w, double *match)
{
	char lemma[80];
	struct naming known, second;
	const int first = v->has_knowledge ? find_compound(p, w, &known, lemma, sizeof lemma) : -1;

	if (first < 0)
		return;
	naming_of_word(&second, p->words[w].lemma);
	for (size_t o = 0; o < v->lifted->objects; o++) {
		const char *content = v->contents[o];
		const int is_plain = !*content || colour_word(content) >= 0;
		if (!is_said_of(v, p->words[first].lemma, o))
			match[o] *=
				is_plain && is_sort_of(v, &known, &second, o) ? KIND_WORTH : COMPOUND_WORTH;
		if (v->has_names)
			match[o] = fmax(match[o], knowledge_of_name(v, &known, o));
		for (size_t i = 0; i < v->n; i++)
			if (v->items[i].object == o && v->items[i].role == VOCABULARY_NOUN)
				match[o] = fmax(match[o],
					knowledge(v, &known, v->items[i].kind, v->items[i].is_general));
	}
}

/* What a noun is worth of several things, by which sentences call this one: hardly of a case that one of them
 * calls a box, where others are boxes. */
static double worth_of_share(const struct vocabulary *v, const struct vocabulary_item *item)
{
	double same = 0, all = 0;

	for (size_t i = 0; i < v->n; i++)
		if (v->items[i].object == item->object && v->items[i].role == VOCABULARY_NOUN) {
			all++;
			same += v->items[i].kind == item->kind;
		}
	return all > 0 ? CALLED_LEAST + (1 - CALLED_LEAST) * fmin(1, same / (CALLED_SHARE * all)) : 1;
}

void vocabulary_noun(struct vocabulary *v, const struct vocabulary_sentence *s, int w, double *match)
{
	const struct lifted *l = v->lifted;
	const struct parse_word *word = &s->parse->words[w];
	const size_t width = (size_t)l->width, objects = l->objects;
	struct naming known = {0};
	int is_name = 0; /* something has that name: of several, those that have it are meant */

	vocabulary_word_vector(v, word, s->vectors, v->word);
	if (v->has_knowledge)
		naming_of_word(&known, word->lemma);
	for (size_t o = 0; o < objects; o++) {
		const int named = v->has_names ? vocabulary_in_name(word->lemma, l->names[o]) : 0;
		match[o] = named == 2;
		is_name |= named == 2 && v->of_several;
		if (v->has_names && named < 2)
			match[o] = fmax(fmax(match[o], holds(v, &known, o)), knowledge_of_name(v, &known, o));
	}
	for (size_t i = 0; i < v->n; i++) {
		const struct vocabulary_item *item = &v->items[i];
		if (item->role != VOCABULARY_NOUN)
			continue;
		const int is_same = !strcmp(word->lemma, item->lemma);
		double x = !is_same ? 0 : is_name ? worth_of_share(v, item) : 1;
		if (!is_same) {
			x = worth(dot_float(v->word, v->vectors + i * width, width), NOUN_HALF, NOUN_SOFT);
			x = fmax(x * (known.noun.n ? VECTOR_WORTH : 1),
				knowledge(v, &known, item->kind, item->is_general));
		}
		match[item->object] = fmax(match[item->object], x);
	}
	share_kin(v, is_name, v->other, match);
	judge_compound(v, s->parse, w, match);
}

/* The match of an object that is called by a kind's name, where such things usually have what a word says. */
static void take_usual(struct vocabulary *v, size_t kind, const struct parts *word, double *match)
{
	struct vocabulary_kind *k = &v->kinds[kind];

	if (k->parts.n < 0)
		parts_usual(&k->parts, k->lemma);
	if (*match >= 0)
		*match = fmax(*match, USUAL_WORTH * parts_share(&k->parts, word));
}

/* What is known to be usual of things that are called so: a laptop has a battery. */
static void add_usual(struct vocabulary *v, const char *lemma, double *match)
{
	struct parts word;

	if (!v->has_knowledge)
		return;
	parts_of_word(&word, lemma);
	for (size_t o = 0; o < v->lifted->objects && word.n && v->has_names; o++) {
		take_usual(v, v->head_kinds[o], &word, &match[o]);
		if (word.n > 1 && *v->contents[o]) /* the case of an electronic thing */
			take_usual(v, v->content_kinds[o], &word, &match[o]);
	}
	for (size_t i = 0; i < v->n && word.n; i++) {
		const struct vocabulary_item *item = &v->items[i];
		if (item->role == VOCABULARY_NOUN && !item->is_general)
			take_usual(v, item->kind, &word, &match[item->object]);
	}
}

/* Words that say where a thing is are of other things. */
static int says_place(const struct vocabulary_item *item)
{
	return item->role > VOCABULARY_ATTRIBUTE && item->relation != PARSE_WITH &&
	       item->relation != PARSE_OTHER;
}

void vocabulary_attribute(struct vocabulary *v, const struct vocabulary_sentence *s, int w, double *match)
{
	const struct lifted *l = v->lifted;
	const struct parse_word *word = &s->parse->words[w];
	const size_t width = (size_t)l->width;
	const int finish = v->has_knowledge ? finish_of(word->lemma) : -1;

	vocabulary_word_vector(v, word, s->vectors, v->word);
	for (size_t o = 0; o < l->objects; o++)
		match[o] = v->has_names && vocabulary_in_name(word->lemma, l->names[o]) ? 1 : 0;
	for (size_t i = 0; i < v->n; i++) {
		const struct vocabulary_item *item = &v->items[i];
		double *to = &match[item->object], x;
		if (says_place(item))
			continue;
		x = item->role == VOCABULARY_ATTRIBUTE ? finish_fits(finish, v->kinds[item->kind].finish) : 0;
		if (x == 0)
			x = worth(dot_float(v->word, v->vectors + i * width, width), ATTRIBUTE_HALF,
				ATTRIBUTE_SOFT);
		x = !strcmp(word->lemma, item->lemma) ? 1 : x;
		/* what is said to be so once is so, whatever else is said */
		if (x > 0 ? x > *to && x > -*to : -x > fabs(*to))
			*to = x;
	}
	add_usual(v, word->lemma, match);
}

void vocabulary_has(struct vocabulary *v, const struct vocabulary_sentence *s, int w,
	enum parse_relation place, double *match)
{
	const struct parse_word *word = &s->parse->words[w];
	const size_t width = (size_t)v->lifted->width;
	struct naming known = {0};

	vocabulary_word_vector(v, word, s->vectors, v->word);
	if (v->has_knowledge)
		naming_of_word(&known, word->lemma);
	memset(match, 0, v->lifted->objects * sizeof *match);
	for (size_t i = 0; i < v->n && v->has_said; i++) {
		const struct vocabulary_item *item = &v->items[i];
		if (item->role != VOCABULARY_ANCHOR || (says_place(item) && place == PARSE_OTHER))
			continue;
		double x = worth(dot_float(v->word, v->vectors + i * width, width), NOUN_HALF, NOUN_SOFT);
		if (!v->kinds[item->kind].is_thing)
			x = fmax(x, knowledge(v, &known, item->kind, 0));
		x = !strcmp(word->lemma, item->lemma) ? 1 : x;
		x *= says_place(item) && item->relation != place ? OTHER_PLACE : 1;
		match[item->object] = fmax(match[item->object], x);
	}
	if (place == PARSE_OTHER)
		add_usual(v, word->lemma, match);
}

/* A colour that an object's name begins with, as "red bag" does, is said as often as NAME_COLOUR sentences
 * say it. Returns how often a colour is said so, and adds to *like how often one like this. */
static double name_says(const char *name, int colour, double *like)
{
	char word[32];
	const size_t n = strcspn(name, " -_");

	if (n >= sizeof word || !name[n])
		return 0;
	for (size_t i = 0; i <= n; i++)
		word[i] = i < n ? vocabulary_lower(name[i]) : 0;
	const int said = colour_word(word);
	*like += said < 0 ? 0 : NAME_COLOUR * colour_words_alike(said, colour);
	return said < 0 ? 0 : NAME_COLOUR;
}

/* fit (O): how many of the training sentences that say a colour of an object say one like this: one of them
 * may have been misread. other (O): how many say another one. */
static void said_colours(const struct vocabulary *v, int colour, double *fit, double *other)
{
	const struct lifted *l = v->lifted;

	for (size_t o = 0; o < l->objects; o++) {
		double like = 0;
		double all = v->has_names && v->has_said ? name_says(l->names[o], colour, &like) : 0;
		for (size_t i = 0; i < v->n && v->has_said; i++) {
			const struct vocabulary_item *item = &v->items[i];
			const int said = item->object == o && item->role == VOCABULARY_ATTRIBUTE
						 ? colour_word(item->lemma)
						 : -1;
			like += said < 0 ? 0 : colour_words_alike(said, colour);
			all += said >= 0;
		}
		fit[o] = all > 0 ? like / all : 0;
		other[o] = all > 0 ? 1 - like / all : 0;
	}
}

int vocabulary_colour(struct vocabulary *v, const struct arrangement *a, const char *word, double *fit)
{
	const int colour = colour_word(word);
	struct parts usual; /* of a thing whose colour nobody says: a plant is green */

	if (colour < 0)
		return 0;
	parts_of_word(&usual, word);
	said_colours(v, colour, fit, v->other);
	/* of several, where another thing is called so, what it is called itself counts more, and what is
	 * only like the colour is meant less */
	const int is_there = v->of_several && largest(fit, a->n) > COLOUR_SAID;
	const double less = is_there ? OTHER_COLOUR_THERE : OTHER_COLOUR;
	for (size_t o = 0; o < a->n; o++) {
		const double share = a->objects[o].colours[colour];
		const double looks = share / (share + COLOUR_SHARE);
		if (!(fit[o] > 0 || v->other[o] > 0) && v->has_names && v->has_knowledge)
			take_usual(v, v->head_kinds[o], &usual, &fit[o]);
		fit[o] = fmax(fit[o], looks * (1 - less * v->other[o]));
		if (is_there && fit[o] < COLOUR_UNLIKE)
			fit[o] *= fit[o] / COLOUR_UNLIKE;
	}
	return 1;
}

/* Whether any sentence of an object says a colour of it or of a part of it. */
static double says_colour(const struct vocabulary *v, size_t object, int colour)
{
	double most = 0;

	for (size_t i = 0; i < v->n && v->has_said; i++) {
		const struct vocabulary_item *item = &v->items[i];
		const int said = item->object == object && !says_place(item) ? colour_word(item->lemma) : -1;
		most = said < 0 ? most : fmax(most, colour_words_alike(said, colour));
	}
	return most;
}

int vocabulary_part_colour(
	const struct vocabulary *v, const struct arrangement *a, const char *word, double *fit)
{
	const int colour = colour_word(word);

	for (size_t o = 0; o < a->n && colour >= 0; o++) {
		const double share = a->objects[o].colours[colour];
		fit[o] = fmax(share / (share + PART_COLOUR_SHARE), says_colour(v, o, colour));
	}
	return colour >= 0;
}
