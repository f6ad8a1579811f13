/* What cmd/check/check.h says of JSON Lines (formats/records/jsonl.md): each reads a whole file with its
 * format's reader, and adds the kind and what it counted. Return 0, or -1 with *e. */
#ifndef CMD_CHECK_CHECK_RECORDS_H
#define CMD_CHECK_CHECK_RECORDS_H

#include "cmd/check/check.h"

/* Adds one fact; there is room for CHECK_MAX_FACTS. */
void check_add(struct check *c, const char *name, long long value);

int check_sentences(struct check *c, const char *path, struct err *e);
int check_masks(struct check *c, const char *path, struct err *e);
int check_boxes(struct check *c, const char *path, struct err *e);

#endif
