/* Which objects a sentence means, by what it means among the scene's objects (ask/meaning.h).
 *
 * One thing is meant: score_o = log fit_o + SENTENCE_WEIGHT S_o, S_o the best cosine of the sentence's mean
 * with a training sentence's, and the probability is the softmax of SCORE_WEIGHT score_o. Several are meant:
 * each that fits at least SEVERAL_SHARE as well as the best; as many as are said, the best. A training
 * sentence means what it meant.
 *
 * The sentence means nothing that was lifted with the probability 1 - P: P goes by how far the thing that
 * fits best is known to be what is said (its noun, its colours, its relations), and by how many words say
 * something that is said of nothing. A sentence that says only what the thing is for means the one that
 * ask/usage.h finds. All constants are in ask/constants.def. */
#pragma once

#include "ask/meaning.h"
#include "base/err.h"
#include "base/list.h"
#include "geom/camera.h"
#include "lang/motion_said.h"
#include "lang/parser.h"
#include "lift/lifted_model.h"
#include "splat/splats.h"

enum choose_part {
	CHOOSE_WORDS,	  /* nouns and attributes */
	CHOOSE_NAMES,	  /* the objects' names are nouns too */
	CHOOSE_KNOWLEDGE, /* what words mean besides: WordNet, and lang/kinds.h */
	CHOOSE_COLOURS,
	CHOOSE_SURFACES,  /* "striped", "shiny": what the Gaussians show of that (places/object_surface.h) */
	CHOOSE_SIZES,	  /* "large" */
	CHOOSE_RELATIONS, /* other clauses, and ordinals */
	CHOOSE_EXCEPT,	  /* "but not the red one", "of the jar and the tin" */
	CHOOSE_SENTENCE,
	CHOOSE_PURPOSE, /* what a thing is for, of sentences that say that */
	CHOOSE_PARTS
};
enum { CHOOSE_ALL = (1 << CHOOSE_PARTS) - 1 };

/* All parts but those in a comma-separated list of "words" ... "purpose" (NULL: all). 0, or -1 and *unknown
 * the first name that is no part's. */
int choose_without(const char *list, unsigned *parts, struct list_name *unknown);

struct choose_sentence {
	const char *text;
	const char *pieces;   /* word pieces with single spaces between; NULL: not known, and only the part
				 `sentence` counts */
	const float *vectors; /* (words, the model's width) */
	const float *middle;  /* the same of the encoder's middle layer; NULL: not known */
	size_t words;
	struct viewpoint from;	   /* unless it says itself from where: "when facing the kettle" */
	const struct parse *parse; /* NULL: not known, the text is parsed */
	int is_all;		   /* with no parse: of one thing that is said all that fit are meant */
};

struct choose_scene {
	const struct lifted *lifted;
	const struct splats *splats;
	const struct cameras *cameras;
	const struct parser *parser;
	double naming; /* how much words for the thing itself count, 1 but where it is in doubt which lifted
			  object has which name: colours and relations then tell */
	const struct tracks *tracks; /* of the objects of a scene that moves; NULL: it is still */
};

struct choice {
	double there;		 /* P that the sentence means anything that was lifted */
	int is_several;		 /* it may mean more than one object */
	int is_by_purpose;	 /* what the thing is for told (CHOOSE_PURPOSE) */
	int is_motion;		 /* it says something of motion (lang/motion_said.h), and: */
	enum motion_kind motion; /* of the target, first; MOTION_NONE */
	double when[2];		 /* from when to when what is chosen moves so */
};

/* What is known of a sentence once it is judged, to explain it; good until the call returns. */
struct choose_watch {
	void *data;
	void (*each)(void *data, size_t i, const struct meaning *m);
};

/* probability (n,O): of each object to be meant, or one of those meant, where anything is; with one meant a
 * row sums to 1. chosen (n,O) 0 or 1: those that are meant. A sentence without words means nothing. parts: a
 * bit 1 << part for each part that counts. watch may be NULL. Returns 0, or -1 with *e set. */
int choose(const struct choose_scene *s, const struct choose_sentence *sentences, size_t n, unsigned parts,
	struct choice *choices, float *probability, char *chosen, const struct choose_watch *watch,
	struct err *e);

/* What all sentences about a scene share, kept for those that come one after the other. Refers to *s, which
 * must outlive it. NULL with *e set; a NULL may be freed. */
struct chooser;
struct chooser *chooser_make(const struct choose_scene *s, unsigned parts, struct err *e);
void chooser_free(struct chooser *c);

/* From now on what a phrase calls by the set's noun is one of the set; NULL: of all that is there. */
void chooser_within(struct chooser *c, const struct meaning_set *set);

/* Two objects change places: all that is seen of them, not what they are called. */
void chooser_swap(struct chooser *c, size_t i, size_t k);

/* What a sentence of the model was taken apart into. */
const struct parse *chooser_parse(const struct chooser *c, size_t sentence);

/* choose() with what is kept. */
int choose_with(struct chooser *c, const struct choose_sentence *sentences, size_t n, struct choice *choices,
	float *probability, char *chosen, const struct choose_watch *watch, struct err *e);
