/* What miou-score reads, put together, and the scores that come of it: of masks, of answers, of boxes.
 * formats/records/scores.md. */
#ifndef CMD_SCORE_SCORING_H
#define CMD_SCORE_SCORING_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/score/score_masks.h"
#include "cmd/score/scores.h"
#include "formats/records/parses.h"
#include "formats/records/sentences.h"

/* NULL where one was not named; the first two always are. */
struct scoring_files {
	const char *predictions, *truth, *other, *sentences, *parses, *whole;
};

struct scoring {
	const struct scoring_files *files;
	struct score_masks predictions, truth, other, whole;
	struct sentences sentences;
	struct parses parses;
};

/* Reads the files of masks and sentences. is_partial: views without a prediction do not count. *in is zeroed
 * before. Returns, as all do, 0, or -1 with *e set; after either scoring_free is in order. */
int scoring_read(struct scoring *in, const struct scoring_files *files, int is_partial, struct err *e);
void scoring_free(struct scoring *in);

/* Scores masks: s->all and those tables that s->has_... asks for, beside the other predictions where
 * s->is_compared. Tells of what was left out. */
int scoring_pairs(const struct scoring *in, struct scores *s, const struct report *to, struct err *e);

/* Scores the answers to the sentences, and writes that to a file ("-": stdout); *right gets the share of all
 * that is right. */
int scoring_answers(const struct scoring *in, const char *path, int is_json, double *right,
	const struct report *to, struct err *e);

/* The same for files of boxes; *miou gets the mean IoU of aligned boxes. */
int scoring_boxes(const struct scoring_files *files, const char *path, int is_json, double *miou,
	const struct report *to, struct err *e);

#endif
