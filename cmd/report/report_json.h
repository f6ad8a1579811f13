/* JSON in a page. */
#ifndef CMD_REPORT_REPORT_JSON_H
#define CMD_REPORT_REPORT_JSON_H

#include "base/err.h"

#include <cjson/cJSON.h>
#include <stdio.h>

/* Adds a member, which is the object's then. 0 where memory is out, for the value too, which is freed. */
int report_add(cJSON *to, const char *key, cJSON *value);

/* Writes it inside a script: what could end the script, or begin a comment, is escaped. Returns 0, or -1 with
 * *e set. */
int report_json_put(FILE *out, const cJSON *value, struct err *e);

#endif
