/* Paths as text. */
#ifndef BASE_PATH_H
#define BASE_PATH_H

#include "base/err.h"

/* The path of `target` as seen from the folder `dir`: "../images/a.jpg". Both must exist; symbolic links of
 * the folders are followed, that of the target's last part is not. free() it; NULL with *e set. */
char *path_relative(const char *dir, const char *target, struct err *e);

/* The last part of a path, which may end in slashes: where it begins, and its length without them. */
const char *path_last(const char *path, int *length);

#endif
