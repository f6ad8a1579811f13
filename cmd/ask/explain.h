/* Why a sentence means what it means among a scene's objects: refer-ask. */
#pragma once

#include "ask/refusal.h"

/* {"parse":"the mug, left of (the
 * bowl)","confidence":0.9,"unexplained":["..."],"candidates":[{"name":"mug","fit":0.8,
 * "parts":[{"part":"noun","words":"mug","value":1}]}],"anchors":[{"words":"the
 * bowl","name":"bowl","there":0.9}]}; the best EXPLAIN_MOST candidates come first. Or the same as
 * lines of text, where is_json is 0. free() it; NULL where memory is out. */
char *explain_meaning(const struct explained *x, int is_json);
