/* Small pictures of views, as they stand in a page. */
#ifndef CMD_REPORT_REPORT_VIEWS_H
#define CMD_REPORT_REPORT_VIEWS_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/report/report_run.h"

#include <cjson/cJSON.h>

/* A list of {"name","split","width","height","photograph","picture"}, one for each view that is shown: its
 * photograph, or the scene rendered where there is none, as a data URI of a JPEG. Warns of photographs that
 * cannot be read. NULL with *e set. */
cJSON *report_views(const struct report_run *r, const struct report *to, struct err *e);

#endif
