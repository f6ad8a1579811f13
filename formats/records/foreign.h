/* Files of other programs that are given in place of ours: what they are, and the way out.
 * formats/records/foreign.md has all of them. Each function returns 0 where it does not know the file, or -1
 * with *e set (ERR_FORMAT).
 */
#ifndef FORMATS_FOREIGN_H
#define FORMATS_FOREIGN_H

#include "base/err.h"
#include "formats/splats/plyfile.h"

#include <cjson/cJSON.h>

/* JSON that is not what was wanted; name is the file's, for the message. */
int foreign_json(const cJSON *root, const char *name, struct err *e);

/* A file that is none of those read there, by its name or how it begins. */
enum foreign_place { FOREIGN_SPLATS, FOREIGN_CAMERAS };
int foreign_file(const char *name, enum foreign_place place, const void *data, size_t len, struct err *e);

/* A .ply whose rows are not those of a 3DGS scene that can be rendered. */
int foreign_vertices(const struct plyfile *f, const struct plyfile_element *vertex, struct err *e);

#endif
