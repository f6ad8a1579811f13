/* Clauses: how what a phrase means stands to its anchors, and in which order of all that fits. The anchors
 * are judged before. */
#pragma once

#include "ask/meaning.h"

/* The clauses that need no order. */
void judge_clauses(struct meaning *m, int phrase);

/* What orders those that fit so far: superlatives, comparatives, sides, ordinals. */
void judge_order(struct meaning *m, int phrase);
