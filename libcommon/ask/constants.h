/* The constants of the choice, in one place. Lengths are shares of the arrangement's spacing, logarithms of
 * sizes natural. Geometry was found on synthetic scenes (seeds 1 to 9). */
#ifndef ASK_CONSTANTS_H
#define ASK_CONSTANTS_H

/* Where things are. */
#define SIDEWAYS_LEAST 0.65 /* cosine of the angle to the direction that people mean ... */
#define SIDEWAYS_SOFT 0.1
#define SIDEWAYS_ELSE 0.35 /* ... and what is left to a thing that is that way at all */
#define APART_LEAST 0.04   /* how far that way at least */
#define APART_SOFT 0.03
#define NEARBY 0.3	/* e-folds by which what is near is preferred */
#define LOW_IS_NEAR 0.7 /* a thing's foot this much higher looks as if it were 1 farther */
#define TOUCHING 0.05	/* a gap that is none: the undersides of things are seen badly */
#define NEXT_TO 0.3	/* the gap at which "next to" is half true */
#define FAR_FROM 0.8	/* the distance at which "far from" is half true */
#define SIDE_LEAST 0.15 /* of half the objects' extent: where the left side begins */
#define SIDE_SOFT 0.1
#define ON_THE_REST 0.5 /* how wrong it is to say of a thing on another that it is on the table */
#define BEST_SOFT 0.04	/* differences that are told apart: of lengths, and of logarithms of sizes */
#define BEST_SOFT_SIZE 0.06

/* What parts of a phrase leave to an object for which they do not hold. A noun that is contradicted weighs
 * more than a colour, and a colour more than another attribute. */
#define NOUN_LEAST 0.005
#define COLOUR_LEAST 0.03
#define ATTRIBUTE_LEAST 0.4
#define MODIFIER_LEAST 0.6  /* "soup" of "soup dish" */
#define OPPOSITE 0.2	    /* of it, where the opposite is said */
#define PREDICATE_LEAST 0.3 /* what a thing does or is for */
#define RELATION_LEAST 0.02
#define SIZE_LEAST 0.4 /* "large" */
#define EXCEPT_LEAST 0.01
#define GROUP_ELSE 0.02	  /* "of the two cups", and it is neither */
#define OUT_OF_SIGHT 0.02 /* a picture is spoken of, and it is not in it */

#define NOUN_ELSEWHERE 0.7   /* the power of what a noun fits one thing less well than another */
#define GENERIC_THERE 0.95   /* how known a thing is that is called "thing" */
#define UNKNOWN_RELATION 0.5 /* how true a relation to something unknown is */
#define SAID_WORTH 0.85	     /* a relation that a training sentence has */
#define RELATION_THERE 0.1   /* how true a relation has to be for its thing to be there */
#define PART_COLOUR 0.12     /* "a bottle with a green base" is called green */
#define OTHER_COLOUR 0.6     /* what a shade is worth less where sentences call the thing by another colour */
#define COLOUR_SHARE 0.15    /* the share of a thing's colours at which it half has a colour */
#define LOOKS_WORTH 1	     /* how fast look-alikes share fewer words as they look less alike */

/* What words are worth: cosines of word vectors at which two words are as likely the same thing as not. */
#define NOUN_HALF 0.65
#define NOUN_SOFT 0.04
#define ATTRIBUTE_HALF 0.55
#define ATTRIBUTE_SOFT 0.08
#define WORDNET_WORTH 0.95
#define USE_WORTH 0.8	 /* a thing that WordNet's glosses say is for what a word says */
#define KINDS_WORTH 0.85 /* two nouns of one group of lang/kinds.h */
#define NAME_PART 0.3	 /* a word of a name that is not its last */

/* The answer. */
#define SENTENCE_WEIGHT 0.3 /* of the sentences' cosine, beside the logarithm of the fit */
#define SCORE_WEIGHT 1
#define SEVERAL_SHARE 0.35 /* of the best fit: what is one of several meant */
#define COUNTED_SHARE 0.05 /* the same where their number is said */
/* P that the thing is there: the weights of a logistic function, set by hand. */
#define PRESENCE_BASE 2.6
#define PRESENCE_OWN 2
#define PRESENCE_ANCHORS 1.0
#define PRESENCE_UNKNOWN 0.3
#define UNKNOWN_ANCHOR 0.6

/* The wording alone (ask/wording.h). The weights, to COLOUR, HEAD, ALL and PLAIN, are those that an older
 * choice without a parser had by logistic regression on synthetic scenes (seeds 1 to 9); the limits below
 * were set by hand on the desk and made scenes. Of sentences about what is not there, p is distributed as
 * p^(shape-1); of five sentences, four are about what is. */
#define WORDING_UNLIKE 0.07
#define WORDING_NAME 0.95
#define WORDING_SHARP 3.5
#define WORDING_COLOUR 0.6
#define WORDING_HEAD 3.2
#define WORDING_ALL 8.9
#define WORDING_PLAIN 1.7
#define PARSE_LEAST 0.65 /* below this P the parse has found nothing */
/* It counts where the sentence fits as well as 0.35 of the training sentences, and its noun is this known. */
#define WORDING_LEAST 0.88
#define WORDING_NOUN 0.3
#define WORDING_COLOUR_SO 0.5 /* what a colour and a clause leave to that of which they are so */
#define WORDING_CLAUSE 0.25
#define COLOUR_FLOOR 0.05
#define COLOUR_USUAL 0.2
#define PRESENT_ODDS 4.0
#define ABSENT_SHAPE 0.25

#endif
