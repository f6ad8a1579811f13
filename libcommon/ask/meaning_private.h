/* What the parts of ask/meaning.h share: meaning.c has phrases, meaning_clauses.c how they stand to one
 * another, meaning_nouns.c, meaning_colours.c and meaning_words.c their words, meaning_sets.c what is left
 * out or chosen from, meaning_compared.c looks that are compared.
 */
#ifndef ASK_MEANING_PRIVATE_H
#define ASK_MEANING_PRIVATE_H

#include "ask/meaning.h"

#include "base/largest.h"

#include <math.h>

static inline size_t objects_of(const struct meaning *m)
{
	return m->arrangement->n;
}

static inline double *fit_of(const struct meaning *m, int phrase)
{
	return m->fit + (size_t)phrase * (objects_of(m) + 1);
}

static inline double *there_of(const struct meaning *m, int phrase)
{
	return m->there + (size_t)phrase * objects_of(m);
}

/* The next part's values (O). meaning_judge has made room. */
double *meaning_add_part(struct meaning *m, int phrase, enum meaning_kind kind, int index);

/* The phrase's fit takes in a part's values. */
void meaning_take_part(struct meaning *m, const struct meaning_part *p);

int meaning_word_is(const struct parse_word *w, const char *const *list);

/* The word that names the kind of thing, or -1: "something", "the red one". */
int meaning_head_of(const struct parse *p, const struct parse_phrase *f);

/* Whether a word of the phrase is in a list that ends in NULL. */
int meaning_has_word(const struct parse *p, const struct parse_phrase *f, const char *const *list);

/* "the other cups", "anything else". */
int meaning_is_other(const struct parse *p, const struct parse_phrase *f);

void meaning_judge_noun(struct meaning *m, int phrase);

/* How far objects are of the colour of a word, and of those right after it that are colours too: "salmon
 * pink" and "black and white" are either. Nothing where the word before it has done so. */
void meaning_judge_colour(struct meaning *m, int phrase, int word);

void meaning_judge_attribute(struct meaning *m, int phrase, int word, double least);

/* A part that is, or fits, no object, but that training sentences may tell of: "with a handle", "on the
 * shelf". */
void meaning_judge_said(struct meaning *m, const struct parse_clause *c, double *said);

/* value (O) takes in the colours of parts that are no objects: "with a black cap". */
void meaning_judge_part_colours(struct meaning *m, int phrase, const struct parse_clause *c, double *value);

/* The place as a whole, unless something is called so. */
int meaning_is_scene(const struct meaning *m, int phrase);

/* When a clause is judged: what compares with all else that fits has to wait for it. */
enum meaning_turn { AT_ONCE, BY_PLACE, BY_DEGREE };

/* The clauses of that turn. fit: what is compared. */
void meaning_judge_clauses(struct meaning *m, int phrase, const struct parse_phrase *f, const double *fit,
	enum meaning_turn turn);

/* What orders those that fit so far, each by itself. */
void meaning_judge_order(struct meaning *m, int phrase);

/* What a thing does, is for, or has: any word of it may be said of an object. Returns how far something is
 * known to be so. */
double meaning_judge_predicate(struct meaning *m, const struct parse_clause *c, double *value);

/* Whether a clause compares looks: "darkest", "shinier than the kettle". */
int meaning_compares_looks(const struct parse *p, const struct parse_clause *c);

/* value (O) of such a clause among those that fit, the place-th of them. Its anchors are judged. */
void meaning_judge_compared(
	struct meaning *m, const struct parse_clause *c, int place, const double *fit, double *value);

/* The phrase's fit takes in a phrase that is left out. */
void meaning_judge_except(struct meaning *m, int phrase, int except);

/* And that it is one of several that are named: "of the jar, the tin and the box the tallest". */
void meaning_judge_among(struct meaning *m, int phrase);

#endif
