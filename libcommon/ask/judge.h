/* What a parsed sentence means among a scene's objects: for each of its phrases, how well each object fits
 * it.
 *
 * A phrase is judged part by part: its noun, its attributes, its clauses, what it leaves out, what it is one
 * of, and then what orders the things that fit so far: superlatives, comparatives, ordinals. A clause's
 * anchors are phrases themselves and are judged first. Each part gives every object a number in [0,1], and a
 * phrase's fit is their product. How far the best object fits at all, where parts that nothing speaks for or
 * against are left aside, is what the presence of the thing goes by. */
#pragma once

#include "ask/meaning.h"

/* Judges a sentence: fills in what m has of the one that was judged last. Returns 0, or -1 with *e set. */
int judge_sentence(struct meaning *m, const struct vocabulary_sentence *s, struct err *e);
