/* Where make puts what it fetches. */
#ifndef CMD_TEXT_CACHE_FOLDER_H
#define CMD_TEXT_CACHE_FOLDER_H

#include "base/err.h"

/* refersplat/NAME in $XDG_CACHE_HOME or ~/.cache, whether it is there or not. free() it; NULL with *e set
 * (ERR_USAGE: HOME is not set). */
char *cache_folder(const char *name, struct err *e);

#endif
