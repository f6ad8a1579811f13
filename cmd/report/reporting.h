/* A run folder as one page of HTML: refer-report. The page's text is report_page.html; what it shows stands
 * in it as JSON. */
#ifndef CMD_REPORT_REPORTING_H
#define CMD_REPORT_REPORTING_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/report/report_run.h"

/* Writes the page of a run to a file ("-": stdout). Returns 0, or -1 with *e set. */
int reporting_write(
	const struct report_options *options, const char *path, const struct report *to, struct err *e);

#endif
