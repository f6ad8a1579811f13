/* Scores of answers to sentences, what miou-score --answers writes. formats/records/scores.md. */
#ifndef CMD_SCORE_ANSWER_SCORES_H
#define CMD_SCORE_ANSWER_SCORES_H

#include "base/err.h"
#include "cmd/score/score_masks.h"
#include "formats/records/sentences.h"
#include "score/score_answers.h"

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

#endif
