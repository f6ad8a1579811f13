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
#define NEXT_TO 0.3	/* the gap at which "next to" is half true */
#define FAR_FROM 0.8	/* the distance at which "far from" is half true */
#define SIDE_LEAST 0.15 /* of half the objects' extent: where the left side begins */
#define SIDE_SOFT 0.1
#define BEST_SOFT 0.04 /* differences that are told apart: of lengths, and of logarithms of sizes */
#define BEST_SOFT_SIZE 0.06

/* What parts of a phrase say when they do not hold. */
#define RELATION_LEAST 0.02
#define COLOUR_LEAST 0.05

#endif
