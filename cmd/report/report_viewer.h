/* The scene as splats in a page, with what shows them: Spark (sparkjs.dev, MIT) on three.js (MIT), which
 * `make viewer` fetches. */
#ifndef CMD_REPORT_REPORT_VIEWER_H
#define CMD_REPORT_REPORT_VIEWER_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/report/report_run.h"

#include <stdio.h>

/* Writes the scripts of the viewer, and nothing where there is none: r->options->is_plain, or no viewer is
 * named and none has been fetched, which is told. Returns 0, or -1 with *e set. */
int report_viewer_put(FILE *out, const struct report_run *r, const struct report *to, struct err *e);

#endif
