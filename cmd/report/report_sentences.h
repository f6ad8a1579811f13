/* The sentences of a run, each with its answers, as the page has them. */
#ifndef CMD_REPORT_REPORT_SENTENCES_H
#define CMD_REPORT_REPORT_SENTENCES_H

#include "base/err.h"
#include "cmd/report/report_outlines.h"
#include "cmd/report/report_run.h"

/* One object for each set: {"way","name","score":{...},"sentences":[...]}; "score" where there is truth. Of a
 * sentence: "ref", "text", "said" (the objects it means, where it says so), "answer", "runner_up", "there",
 * "sure", "iou", "pairs", "right" (null: not known), "refusal", "explained", and "views", a list of
 * [view, mask, truth or -1, iou or null], where mask and truth are places in the outlines. NULL with *e set.
 */
cJSON *report_sentences(const struct report_run *r, struct report_outlines *o, struct err *e);

#endif
