/* What was judged of a sentence among a scene's objects: how well each object fits each phrase, by parts. */
#pragma once

#include "places/arrangement.h"
#include "ask/vocabulary.h"
#include "base/largest.h"

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
	MEANING_MOTION, /* what is said of its motion */
	MEANING_KINDS
};

/* What a part of a phrase gave: value (O). */
struct meaning_part {
	int phrase;
	enum meaning_kind kind;
	int index; /* of the word or clause, the phrase that is left out, the kind of motion; -1 */
	double *value;
};

/* What "those" are, which a conversation has spoken of: objects, and the noun that phrases call them by. */
enum { MEANING_SET = 1024 /* objects, of which one of them may be in it */ };
struct meaning_set {
	char noun[TOKEN_LENGTH]; /* its lemma; "": things */
	size_t n;		 /* how many they are; 0: none were spoken of */
	unsigned char is[MEANING_SET];
};

struct meaning {
	const struct arrangement *arrangement;
	const struct meaning_set *set; /* "of those"; NULL: of all that is there */
	struct vocabulary *vocabulary;
	struct motion_meaning *motion; /* ask/judge_motion.h; NULL: the scene is still */
	unsigned without; /* a bit 1 << meaning_kind for each kind of part that counts for nothing */
	int has_surfaces; /* whether what Gaussians show of a look counts */
	double naming; /* the power of nouns and attributes that are no colours; 1; 0 for those of the thing
			  itself alone */

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

/* Room for what is judged of a sentence, of which nothing is judged yet. Returns 0, or -1 with *e set. */
int meaning_begin(struct meaning *m, const struct vocabulary_sentence *s, struct err *e);

/* Frees what it made for itself. */
void meaning_free(struct meaning *m);

/* The next part's values (O). */
double *meaning_add_part(struct meaning *m, int phrase, enum meaning_kind kind, int index);

/* The phrase's fit takes in the values of the part that was added last. */
void meaning_take_part(struct meaning *m);

/* Whether nothing at all was said of what a phrase means: "where is it?" */
int meaning_is_empty(const struct meaning *m, int phrase);

/* Whether a word, or its lemma, is one of "this|that"; whether a word of the phrase is. */
int meaning_word_is(const struct parse_word *w, const char *words);
int meaning_has_word(const struct parse *p, const struct parse_phrase *f, const char *words);

/* The word that names the kind of thing, or -1: "something", "the red one". */
int meaning_head_of(const struct parse *p, const struct parse_phrase *f);

/* "the other cups", "anything else". */
int meaning_is_other(const struct parse *p, const struct parse_phrase *f);

/* The place as a whole, unless something is called so. */
int meaning_is_scene(const struct meaning *m, int phrase);
