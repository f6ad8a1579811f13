/* The wordings of the sentences for testing (examples.h says how to read them). */
#include "lang/examples.h"

#define COUNT(a) ((int)(sizeof(a) / sizeof *(a)))

static const struct example_clause placed_test[] = {
	{PARSE_LEFT, 0, "^ immediately to the *left of @"},
	{PARSE_LEFT, 0, "on @ 's *left"},
	{PARSE_LEFT, 0, "a bit *left of @"},
	{PARSE_RIGHT, 0, "somewhere to the *right of @"},
	{PARSE_RIGHT, 0, "on the *right part of @"},
	{PARSE_FRONT, 0, "closer to the viewer , in *front of @"},
	{PARSE_FRONT, 0, "^ right in *front of @"},
	{PARSE_BEHIND, 0, "^ at the *back of @"},
	{PARSE_BEHIND, 0, "partly hidden *behind @"},
	{PARSE_ABOVE, 0, "up *above @"},
	{PARSE_BELOW, 0, "lying *underneath @"},
	{PARSE_ON, 0, "that somebody put *on @"},
	{PARSE_ON, 0, "that rests *on @"},
	{PARSE_INSIDE, 0, "kept *inside @"},
	{PARSE_NEAR, 0, "right by|beside the *side of @"},
	{PARSE_NEAR, 0, "a short way *from @"},
	{PARSE_NEAR, 0, "that stands *closest to @"},
	{PARSE_FAR, 0, "a long way *away from @"},
	{PARSE_FAR, 0, "the most *remote from @"},
	{PARSE_BETWEEN, 0, "somewhere in *between @ and @"},
	{PARSE_MIDDLE, 0, "dead *centre"},
	{PARSE_LARGER, 0, "a little *bigger than @"},
	{PARSE_TALLER, 0, "much *taller than @"},
	{PARSE_CORNER, 0, "over in the *corner"},
	{PARSE_FLOOR, 0, "lying on the *floor"},
	{PARSE_WALL, 0, "up on the *wall"},
	{PARSE_NEAR, 1, "nowhere *near @"},
	{PARSE_ON, 1, "that has not been put *on @"},
};
static const struct example_clause having_test[] = {
	{PARSE_RIGHT, 0, "$ @ just on its *left"},
	{PARSE_LEFT, 0, "$ @ somewhere to its *right"},
	{PARSE_BEHIND, 0, "$ @ standing in *front"},
	{PARSE_FRONT, 0, "$ @ right *behind it"},
	{PARSE_SUPPORTS, 0, "$ @ lying *on top"},
	{PARSE_SUPPORTS, 1, "without a thing *on it"},
	{PARSE_SUPPORTS, 1, "that has no 0 lying *on it"},
	{PARSE_WITH, 0, "$ 0 attached"},
	{PARSE_NEAR, 0, "$ @ close *by"},
};
static const struct example_clause turned_test[] = {
	{PARSE_SUPPORTS, 0, "which @ has been put *on"},
	{PARSE_NEAR, 0, "that @ stands *beside"},
	{PARSE_FRONT, 0, "which @ hides *behind"},
};
static const struct example_clause before_test[] = {
	{PARSE_LEFT, 0, "*lefthand"},
	{PARSE_RIGHT, 0, "*righthand"},
	{PARSE_LARGER, 0, "*massive|giant"},
	{PARSE_SMALLER, 0, "*mini|slim"},
	{PARSE_ABOVE, 0, "*topmost"},
	{PARSE_TALLER, 0, "*tallest"},
};
static const char *const sentences_test[] = {
	"T",
	"T",
	"T",
	"would you mind handing me T ?",
	"i am after T",
	"get hold of T",
	"let me have T , will you",
	"show T",
	"somebody left a N C , please bring it",
	"do we have a N ? one C",
	"U please , the N",
	"the N over there , C",
	"my choice is T",
	"the N i want is C",
	"the N i want H",
	"T if you are facing V",
	"looking from V , T",
	"T rather than X",
	"any N but X",
	"T as well as S",
	"each N C",
	"the fourth N from the right",
	"if one begins on the right , N number two",
	"what would i use F ?",
	"which one of the L is C ?",
	"the A of these L",
	"which N G ?",
	"over there you find B . hand me T D",
	"mind B and B . T P",
	"W you can see the N",
	"seen from above C : the N",
};
static const char *const functions_test[] = {
	"one *sweeps|mops with",
	"to *slice|toast 0",
	"you *wind|charge|fold",
	"for *playing|dancing|knitting",
};

static const struct example_clause back_test[] = {
	{PARSE_NEAR, 0, "a step *from it"},
	{PARSE_BEHIND, 0, "at the *back of it"},
};

static const struct example_clause back_to_two_test[] = {
	{PARSE_BETWEEN, 0, "with one on *either side"},
	{PARSE_BEHIND, 0, "further *back than the pair"},
};

static const struct example_clause inverted_test[] = {
	{PARSE_SUPPORTS, 0, "has @ been put *on"},
	{PARSE_NEAR, 0, "can @ be found *closest to"},
	{PARSE_FRONT, 0, "does @ hide *behind"},
};

#define CLAUSES(a)                                                                                           \
	{                                                                                                    \
		COUNT(a), a                                                                                  \
	}

static const struct example_list list_of_sentences = CLAUSES(sentences_test),
				 list_of_functions = CLAUSES(functions_test);

const struct example_wordings example_wordings_test = {CLAUSES(placed_test), CLAUSES(having_test),
	CLAUSES(turned_test), CLAUSES(back_test), CLAUSES(back_to_two_test), {0, NULL},
	CLAUSES(inverted_test), CLAUSES(before_test), &list_of_sentences, &list_of_functions, NULL};
