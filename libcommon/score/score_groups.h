/* Groups that pairs belong to: by what their sentence says, and by how much of their object is seen. A pair's
 * set has the bit 1 << group; for score_table_groups. */
#pragma once

#include "lang/parse.h"
#include "score/score.h"

/* After the relations themselves. */
enum {
	SCORE_SAYS_NONE = PARSE_RELATIONS, /* a sentence without any */
	SCORE_SAYS_UNKNOWN,		   /* no ref, or none that the sentences have */
	SCORE_SAYINGS
};
void score_saying_names(const char *names[SCORE_SAYINGS]);

struct score_sentence {
	const char *ref;    /* unique */
	uint32_t relations; /* a bit 1 << enum parse_relation for each that it speaks of */
};

/* Fills sets (pair_n) by the sentence of the prediction's ref, else of the truth's; 0 for pairs with nothing
 * in their truth. *unknown counts the other pairs that have no sentence. The pairs are measured. */
int score_sayings(uint32_t *sets, const struct score_pair *pairs, size_t pair_n,
	const struct score_sentence *sentences, size_t n, size_t *unknown, struct err *e);

/* The share of an object that is seen: |truth| / |whole|, whole being its mask if nothing hid it. */
enum {
	SCORE_SEEN_LITTLE,  /* below 0.15 */
	SCORE_SEEN_PARTLY,  /* from 0.15, below 0.5 */
	SCORE_SEEN_MOSTLY,  /* from 0.5, below 0.85 */
	SCORE_SEEN_WELL,    /* from 0.85; also where truth goes beyond the whole */
	SCORE_SEEN_UNKNOWN, /* no whole, or nothing in it */
	SCORE_SEEN
};
extern const char *const score_seen_name[SCORE_SEEN];

/* Fills sets (pair_n); 0 for pairs with nothing in their truth. The whole of a truth is that of its view and
 * ref, else of its view and object, one without ref first; another size is brought to the truth's by
 * rle_resize. `truth` (truth_n) is what was matched; *unknown counts the records in it that have something in
 * them, but no whole. */
int score_seen(uint32_t *sets, const struct score_pair *pairs, size_t pair_n, const struct mask *truth,
	size_t truth_n, const struct mask *wholes, size_t n, size_t *unknown, struct err *e);
