/* What miou-score reads, and the scores of masks, answers and boxes (formats/records/scores.md). */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "cmd/score/score_masks.h"
#include "formats/records/boxes.h"
#include "formats/records/parses.h"
#include "formats/records/sentences.h"
#include "score/box_score.h"
#include "score/score_answers.h"
#include "score/score_rows.h"

/* Scores: what miou-score writes, as text, JSON or CSV. formats/records/scores.md. */

enum scores_form { SCORES_TEXT, SCORES_JSON, SCORES_CSV };

struct scores {
	struct score_row all;
	struct score_table objects;
	struct score_table relations, visibility; /* written where has_... */
	int has_relations, has_visibility;
	int is_compared;	     /* rows have their `other` */
	const struct bootstrap *how; /* rows have intervals; NULL: they have none */
};

/* Frees the tables. */
void scores_free(struct scores *s);

/* The same into a file; "-" is stdout. */
int scores_write(const struct scores *s, const char *path, enum scores_form form, struct err *e);

/* Scores of answers to sentences, what miou-score --answers writes. formats/records/scores.md. */

struct answer_scores {
	struct answers answers;
	struct answer_sentence *sentences; /* owned; their strings are the caller's */
	size_t kind_count;
	const char **kinds; /* in byte order, "" for sentences that have none; owned */
};

/* ERR_FORMAT where no sentence has anything to be scored in any view. */
int answer_scores_make(struct answer_scores *s, const struct sentences *sentences,
	const struct score_masks *truth, const struct score_masks *predictions, struct err *e);
void answer_scores_free(struct answer_scores *s);

/* As text, or as JSON; "-" is stdout. Returns 0, or -1 with *e set. */
int answer_scores_write(const struct answer_scores *s, const char *path, int is_json, struct err *e);

/* Scores of boxes, what miou-score --boxes writes. formats/records/boxes.md. */

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

/* The tables of miou-score that need other files beside the masks: by what sentences say, and by how much of
 * an object is seen. formats/records/scores.md. */

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

/* Of each thing of the truth the predictions are its best object's from here on: score_best. The lines of the
 * predictions no longer count. */
int scoring_take_best(struct scoring *in, struct err *e);

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
