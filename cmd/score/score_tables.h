/* The tables of miou-score that need other files beside the masks: by what sentences say, and by how much of
 * an object is seen. formats/records/scores.md. */
#ifndef CMD_SCORE_SCORE_TABLES_H
#define CMD_SCORE_SCORE_TABLES_H

#include "base/err.h"
#include "cmd/score/score_masks.h"
#include "cmd/score/scores.h"
#include "formats/records/parses.h"
#include "score/score_rows.h"

#include <stddef.h>

/* Make the table of relations, or of visibility, of a sample of pairs; *unknown gets how many pairs have no
 * sentence, or masks of the truth no whole. Return 0, or -1 with *e set. */
int score_relations(struct scores *s, const struct score_sample *sample, const struct parses *sentences,
	size_t *unknown, struct err *e);
int score_visibility(struct scores *s, const struct score_sample *sample, const struct score_masks *truth,
	const struct score_masks *whole, size_t *unknown, struct err *e);

#endif
