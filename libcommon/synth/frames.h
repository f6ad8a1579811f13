/* The forms of sentences, and how each relation is said. Those of test sentences are never in training ones.
 */
#ifndef SYNTH_FRAMES_H
#define SYNTH_FRAMES_H

#include "base/rng.h"
#include "synth/relations.h"

enum { SYNTH_MAX_FRAMES = 32 };

/* Slots: %S size, %F finish, %C colour, %N noun, %P noun in the plural, %G group, %M material, %K how many
 * fit the noun phrase in words, %Z a comparison ("largest"), %R a relation. */
int synth_frame_count(int is_test);
const char *synth_frame(int is_test, int i);

/* A random wording of a relation, with %A and %B for the other objects; of a comparison an adjective. */
const char *synth_wording(enum synth_relation relation, int is_test, struct rng *r);

/* A random relation for a slot %R or %Z, as often as people use it; it need not hold. */
enum synth_relation synth_relation_choose(char slot, struct rng *r);

#endif
