/* A referring sentence taken apart: "the small mug on the plate, to the left of the red book" is a target
 * ("small mug") with two clauses, on (plate) and left (red book). English, by a list of phrases. */
#ifndef LANG_SENTENCE_H
#define LANG_SENTENCE_H

enum {
	LANG_WORDS = 128, /* of a sentence; what comes after them is not looked at */
	LANG_LENGTH = 24, /* bytes of a word, with the 0; longer ones are cut */
	LANG_CLAUSES = 8,
	LANG_ANCHORS = 3, /* of a clause */
};

/* As seen by who looks at the scene, unless it says otherwise. */
enum lang_relation {
	/* of each of its anchors */
	LANG_LEFT,
	LANG_RIGHT,
	LANG_FRONT,
	LANG_BEHIND,
	LANG_NEAR,
	LANG_ON,
	LANG_UNDER,
	LANG_ABOVE,
	LANG_NEAREST,
	LANG_FARTHEST,
	/* of two anchors */
	LANG_BETWEEN,
	/* of the whole scene: its left half, and so on */
	LANG_LEFT_SIDE,
	LANG_RIGHT_SIDE,
	LANG_FRONT_SIDE,
	LANG_BACK_SIDE,
	LANG_MIDDLE_SIDE,
	/* of the objects that the target's words fit */
	LANG_LEFTMOST,
	LANG_RIGHTMOST,
	LANG_NEAREST_US,
	LANG_FARTHEST_US,
	LANG_MIDDLE_ONE,
	LANG_LARGEST,
	LANG_SMALLEST,
	LANG_TALLEST,
	LANG_HIGHEST,
	LANG_LOWEST,
	LANG_RELATIONS
};

/* Relations before LANG_BETWEEN have anchors, one or more; those after it none. */

struct lang_word {
	char text[LANG_LENGTH];
	int first, count; /* its word pieces */
};

/* Words that say something of a thing: no articles, no "thing" or "object", no "standing" or "placed". */
struct lang_phrase {
	int n;
	unsigned char
		words[LANG_WORDS]; /* (n) indices of words, rising but for what was put after a clause */
};

struct lang_clause {
	enum lang_relation relation;
	int anchor_count;
	struct lang_phrase anchors[LANG_ANCHORS];
};

struct lang_sentence {
	int word_count;
	struct lang_word words[LANG_WORDS];
	struct lang_phrase target, all; /* all: every word that says something, in target and clauses */
	int head; /* the word of the target that names the thing: the last of its first noun phrase; -1: none
		   */
	int clause_count;
	struct lang_clause clauses[LANG_CLAUSES];
};

/* pieces: word pieces with single spaces between ("ear ##bud case"), lower case, as text-encode has them. */
void lang_sentence_read(struct lang_sentence *s, const char *pieces);

/* "left" ... "lowest". */
const char *lang_relation_name(enum lang_relation r);

#endif
