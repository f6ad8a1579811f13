/* A sentence of a synthetic scene: what it says, as phrases and clauses like those of lang/parse.h, and its
 * words. It is first made as phrases and clauses, then judged by geometry, then put into words. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "synth/relations.h"
#include "synth/wordings.h"

#include <stdint.h>

enum { SYNTH_PHRASES = 10, SYNTH_CLAUSES = 8, SYNTH_LIST = 3, SYNTH_TEXT = 320 };

/* The words of a phrase, in the order in which they are written. */
enum synth_word {
	SYNTH_SIZE_WORD,
	SYNTH_FINISH_WORD,
	SYNTH_MATERIAL_WORD,
	SYNTH_COLOUR_WORD,
	SYNTH_NOUN,
	SYNTH_WORDS
};

/* As struct parse_phrase, with the words themselves and without spans. */
struct synth_phrase {
	/* NULL: not said. The noun is "" where the sentence says "one", and "other" stands for a finish. A
	 * parse has the size as a clause. */
	const char *words[SYNTH_WORDS];
	const char *plural;
	int clause_count, except_count, also_count;
	int clauses[SYNTH_LIST], except[SYNTH_LIST], also[SYNTH_LIST];
	int count, group, ordinal;
	enum parse_relation from;
	int viewer;
	int of_several;	 /* "of all the cups, the ..." */
	int is_anything; /* as an anchor: whatever there is */
	struct synth_sense sense;
};

/* As struct parse_clause. */
struct synth_clause {
	struct synth_relation is; /* its objects only where they were chosen before their words */
	int negated;
	int anchor_count, anchors[2];
	const struct synth_row *said, *kind; /* its wording; of RELATIONS */
};

struct synth_sentence {
	int kind;		   /* of unseen ones: enum synth_unseen_kind */
	enum camera_split split;   /* unseen ones test */
	int view;		   /* the camera whose picture it is said of; -1: the reference viewpoint */
	int object;		   /* that it was made for */
	uint64_t objects;	   /* those that it means, a bit each */
	char ref[SYNTH_NAME + 12]; /* "red-mug-1" */
	char text[SYNTH_TEXT];
	int phrase_count, clause_count;
	struct synth_phrase phrases[SYNTH_PHRASES]; /* the first is the target */
	struct synth_clause clauses[SYNTH_CLAUSES];
};

struct synth_sentences {
	size_t n, capacity;
	struct synth_sentence *items;	/* owned */
	struct synth_wordings wordings; /* that they point into */
};

void synth_sentences_free(struct synth_sentences *list);

/* Appends a copy; -1 with *e set (memory). */
int synth_sentences_add(struct synth_sentences *list, const struct synth_sentence *s, struct err *e);

/* A phrase more, that means one thing and anything yet: its number, or -1 where there is no room. */
int synth_add_phrase(struct synth_sentence *s);

/* A clause more of a phrase; likewise. */
int synth_add_clause(struct synth_sentence *s, int phrase, enum parse_relation r, enum parse_degree d);

/* Says the word in a phrase. */
void synth_say(struct synth_phrase *p, enum synth_word w, const struct synth_row *row);

/* The list that a phrase's words of a kind are drawn from. */
enum synth_list synth_words_of(enum synth_word w);

/* The objects that phrase p means: 0, or -1 where that could be argued. The number of objects is what the
 * phrase's count says; `may_be_none` 1: none is fine too. */
int synth_resolve(const struct synth_viewpoint *v, const struct synth_sentence *s, int p, int may_be_none,
	uint64_t *objects);

/* Writes s->text by the frame, in which %I is `inner`; -1 where the frame has no use for these clauses, or
 * the text is too long. */
int synth_write(struct synth_sentence *s, const char *frame, const char *inner, struct rng *r);

/* Sentences that each mean one object of the scene, as people would write them: attributes with synonyms, and
 * relations true from the reference viewpoint. */
enum {
	SYNTH_TRAIN_SENTENCES = 4,
	SYNTH_SENTENCES = 5, /* an object; the last is for testing */
	SYNTH_MIN_WORDS = 7,
	SYNTH_MAX_WORDS = 22,
};

/* Items (n objects, SYNTH_SENTENCES), of 13.6 words on average, with objects for a and b of their relations.
 * A test sentence has a frame and wordings of relations that no training sentence has, and no pair of colour
 * word and noun that a training sentence of its object has. Returns 0, or -1 with *e set (ERR_CHECK) where
 * some object cannot be told apart in words; another seed then helps. After either *list may be freed. Where
 * is_wording_seen, the frame of a test sentence is another than its object's, but frame and relations are
 * worded as in training. */
int synth_sentences_make(struct synth_sentences *list, const struct synth_viewpoint *v, uint64_t seed,
	int is_wording_seen, struct err *e);

int synth_count_words(const char *text);
