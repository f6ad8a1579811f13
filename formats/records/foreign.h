/* Files of other programs that are given in place of ours: what they are, and the way out.
 * formats/records/foreign.md has all of them. Each function returns 0 where it does not know the file, or -1
 * with *e set (ERR_FORMAT). */
#pragma once

#include "base/err.h"

#include <cjson/cJSON.h>

/* JSON that is not what was wanted; name is the file's, for the message. */
int foreign_json(const cJSON *root, const char *name, struct err *e);

/* A file that is none of those read there, by its name or how it begins. */
enum foreign_place { FOREIGN_SPLATS, FOREIGN_CAMERAS, FOREIGN_MASKS };
int foreign_file(const char *name, enum foreign_place place, const void *data, size_t len, struct err *e);

/* ERR_FORMAT, "NAME: WHAT: WAY OUT", in which %s is the name, and %b that without its ending: -1. */
int foreign_say(const char *name, const char *what, const char *way_out, struct err *e);
#define FOREIGN_TRAIN "give a scene that 3D Gaussian Splatting trained"
