/* What a parsed sentence means among a scene's objects: for each of its phrases, how well each object fits
 * it.
 *
 * A phrase is judged part by part: its noun, its attributes, its clauses, what it leaves out, what it is one
 * of, and then what orders the things that fit so far: superlatives, comparatives, ordinals. A clause's
 * anchors are phrases themselves and are judged first. Each part gives every object a number in [0,1], and a
 * phrase's fit is their product. How far the best object fits at all, where parts that nothing speaks for or
 * against are left aside, is what the presence of the thing goes by. */
#ifndef ASK_MEANING_H
#define ASK_MEANING_H

#include "places/arrangement.h"
#include "ask/vocabulary.h"

enum meaning_kind {
	MEANING_NOUN,
	MEANING_ATTRIBUTE,
	MEANING_COLOUR,
	MEANING_SURFACE, /* what is seen of an attribute, where words hardly count (naming) */
	MEANING_CLAUSE,
	MEANING_SIZE, /* a clause too: "large" */
	MEANING_EXCEPT,
	MEANING_AMONG, /* one of several that are named */
	MEANING_ORDINAL,
	MEANING_KINDS
};

/* What a part of a phrase gave: value (O). */
struct meaning_part {
	int phrase;
	enum meaning_kind kind;
	int index; /* of the word or clause, or the phrase that is left out; -1 */
	double *value;
};

struct meaning {
	const struct arrangement *arrangement;
	struct vocabulary *vocabulary;
	unsigned without; /* a bit 1 << meaning_kind for each kind of part that counts for nothing */
	int has_surfaces; /* whether what Gaussians show of a look counts */
	double naming;	  /* the power of nouns and attributes that are no colours; 1 */

	/* Of the sentence that was judged last. */
	const struct vocabulary_sentence *sentence;
	size_t phrases, part_count;
	double *fit;   /* (phrases, O + 1): the last is the viewer */
	double *there; /* (phrases, O): how far the object is what the phrase says, by what is known */
	double *known; /* (phrases) whether its noun is of anything in the scene */
	char *done;    /* (phrases) */
	struct meaning_part *parts;
	size_t unknown; /* words that say something, and nothing of any object */

	size_t phrase_room, fit_room, there_room, known_room, part_room, value_room;
	double *values, *scratch; /* of the parts; (9 O + 9) */
};

/* Judges a sentence. Returns 0, or -1 with *e set. */
int meaning_judge(struct meaning *m, const struct vocabulary_sentence *s, struct err *e);

/* Frees what it made for itself. */
void meaning_free(struct meaning *m);

/* Whether nothing at all was said of what a phrase means: "where is it?" */
int meaning_is_empty(const struct meaning *m, int phrase);

#endif
