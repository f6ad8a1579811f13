/* The words of the unseen split: wordings of relations, and frames around them. None of them is taken
 * from synth/frames.h or synth/words.h, and no author of a parser should read unseen_frames.c. */
#ifndef SYNTH_UNSEEN_FRAMES_H
#define SYNTH_UNSEEN_FRAMES_H

#include "base/rng.h"
#include "synth/unseen.h"

/* What a frame is built on. */
enum synth_unseen_build {
	SYNTH_BUILD_PLAIN,    /* a phrase and its clauses, written down */
	SYNTH_BUILD_CHATTY,   /* the same, spoken */
	SYNTH_BUILD_NOT,      /* a negated clause */
	SYNTH_BUILD_OTHER,    /* one is left out, the other is meant */
	SYNTH_BUILD_NOTHING,  /* nothing stands on it */
	SYNTH_BUILD_NEITHER,  /* two are left out */
	SYNTH_BUILD_ORDINAL,  /* second from the left */
	SYNTH_BUILD_EXTREME,  /* leftmost */
	SYNTH_BUILD_GROUP,    /* the left one of the two */
	SYNTH_BUILD_MOST,     /* biggest */
	SYNTH_BUILD_PAIR,     /* the bigger of the two */
	SYNTH_BUILD_THAN,     /* bigger than something */
	SYNTH_BUILD_ALL,      /* all of a kind */
	SYNTH_BUILD_COUNT,    /* the three */
	SYNTH_BUILD_ALSO,     /* this one and that one */
	SYNTH_BUILD_EXCEPT,   /* all but one */
	SYNTH_BUILD_FUNCTION, /* by what one does with it */
	SYNTH_BUILD_VIEW,     /* goes around a sentence (%Z) that is said of a picture */
	SYNTH_BUILDS
};

/* Slots of a frame: %T the target without an article, %P the same in the plural, %R its clauses after it, %V
 * the first clause as a predicate ("is left of the cup", "has the cup on its right"), %L the same without a
 * verb ("left of the cup"), %A the clause's first anchor, which the clause then calls "it", %N the target's
 * noun alone, %M its plural, %X and %Y phrases that are left out or meant too, %K how many, %O "second", %E
 * "left", %C "biggest", %F what one does with it. An article "a" becomes "an" by itself. */
int synth_unseen_frame_count(enum synth_unseen_build b);
const char *synth_unseen_frame(enum synth_unseen_build b, int i);

/* A wording of a relation, with %A and %B for its anchors. Forms: 'p' goes after "is" ("left of %A"), 'h' is
 * a predicate of its own ("has %A on its right"), 'w' only goes after a noun ("with %A on its right"), 'c' is
 * an adjective ("biggest"). */
struct synth_unseen_wording {
	enum parse_relation relation;
	enum parse_degree degree;
	int anchors; /* 0, 1, 2; -1: whoever looks, named in %A */
	char form;
	const char *text;
};

/* A random one with that relation, degree and number of anchors, of a form in `forms`; NULL where there is
 * none. */
const struct synth_unseen_wording *synth_unseen_wording(
	enum parse_relation r, enum parse_degree d, int anchors, const char *forms, struct rng *rng);

#endif
