/* Which relations a sentence speaks of, by its words alone: "the mug right by the bowl on the wooden table"
 * is of next to and on, not of right. English; capitals do not matter. */
#ifndef LANG_RELATION_WORDS_H
#define LANG_RELATION_WORDS_H

#include <stdint.h>

/* Places on a table or in a picture count as the relation of their side: "the front edge" is front, "the
 * leftmost cup" left. So do comparatives: "larger" is largest. */
enum relation {
	RELATION_LEFT,
	RELATION_RIGHT,
	RELATION_FRONT,
	RELATION_BEHIND, /* and the back of a place */
	RELATION_BETWEEN,
	RELATION_NEXT_TO, /* and near */
	RELATION_ON,	  /* something, but not a side: "on the left" is left alone */
	RELATION_UNDER,
	RELATION_ABOVE,
	RELATION_INSIDE,
	RELATION_NEAREST,
	RELATION_FARTHEST,
	RELATION_LARGEST,
	RELATION_SMALLEST,
	RELATION_MIDDLE,
	RELATIONS
};

/* "left" ... "next to" ... "middle". */
extern const char *const relation_name[RELATIONS];

/* The relations of a text, each as the bit 1 << relation; 0 where it has none. Phrases do not go on across
 * commas and full stops, and of two phrases that begin with one word the longer one counts. */
uint32_t relations_of(const char *text);

#endif
