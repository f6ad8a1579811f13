/* Scores of boxes, what miou-score --boxes writes. formats/records/boxes.md. */
#ifndef CMD_SCORE_BOX_SCORES_H
#define CMD_SCORE_BOX_SCORES_H

#include "base/err.h"
#include "formats/records/boxes.h"
#include "score/box_score.h"

struct box_scores {
	struct box_set truth;
	size_t empty_truth; /* left out: there is nothing to be found */
	size_t unmatched;   /* predictions of nothing in the truth: left out */
	size_t n;
	struct box_pair *pairs; /* (n) by the object's name; names are the truth's */
	struct box_score all;
};

/* Reads both files and pairs their boxes. A prediction belongs to the truth of its ref, else to that of its
 * object: one without ref, else the first. A truth that none belongs to is missing. ERR_FORMAT where the
 * truth has no box at all. */
int box_scores_read(struct box_scores *s, const char *truth, const char *predictions, struct err *e);
void box_scores_free(struct box_scores *s);

/* As text, or as JSON; "-" is stdout. Returns 0, or -1 with *e set. */
int box_scores_write(const struct box_scores *s, const char *path, int is_json, struct err *e);

#endif
