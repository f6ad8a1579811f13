/* What a run folder says of how it was made: times, losses, settings. */
#ifndef CMD_REPORT_REPORT_LOGS_H
#define CMD_REPORT_REPORT_LOGS_H

#include "base/err.h"

#include <cjson/cJSON.h>

/* The steps that the pipelines logged, in the order in which they are done: a list of
 * {"step","seconds","mib","command"}; the numbers are absent where the log does not end with them. */
cJSON *report_steps(const char *run, struct err *e);

/* The training logs (formats/records/trainlog.md): a list of
 * {"stage","lines":[[iteration,bce,contrast,loss],...], "held":[[iteration,bce,iou],...]}. */
cJSON *report_losses(const char *run, struct err *e);

/* The metadata of the run's files: a list of {"file","metadata":{...}}, without checksums and long lists. All
 * return NULL with *e set. */
cJSON *report_settings(const char *run, struct err *e);

#endif
