/* What sentences mean among the lifted objects, and why. */
#ifndef CMD_REPORT_REPORT_REASONS_H
#define CMD_REPORT_REPORT_REASONS_H

#include "base/err.h"
#include "cmd/ask/explain.h"
#include "cmd/report/report_run.h"

struct report_reason {
	cJSON *answer; /* the names of the objects that are meant, likeliest first; none: refused */
	cJSON *explained;
	char refusal[EXPLAIN_REASON];
	double there;		 /* P that anything is meant */
	const char *runner_up;	 /* the likeliest other object, the model's; NULL */
	double runner_up_chance; /* of it to be meant */
};

/* reasons (s->text.n), zeroed before: of each sentence of a set that the lifted model answered. Returns 0, or
 * -1 with *e set; after either report_reasons_free. */
int report_reasons(
	const struct report_run *r, const struct report_set *s, struct report_reason *reasons, struct err *e);
void report_reasons_free(struct report_reason *reasons, size_t n);

#endif
