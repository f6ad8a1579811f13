/* Answers that a run folder has no file of: a scene of photographs that were painted has no test views. */
#ifndef CMD_REPORT_REPORT_ANSWERS_H
#define CMD_REPORT_REPORT_ANSWERS_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/report/report_run.h"

/* s->masks gets what r->lifted answers to the sentences of s->text in some training views, at the size of the
 * pictures. Returns 0, or -1 with *e set. */
int report_answer(const struct report_run *r, struct report_set *s, const struct report *to, struct err *e);

#endif
