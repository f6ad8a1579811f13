/* What cmd/check/check.h says of folders: a scene, a COLMAP model, the weights of gs-weigh. */
#ifndef CMD_CHECK_CHECK_FOLDER_H
#define CMD_CHECK_CHECK_FOLDER_H

#include "cmd/check/check.h"

/* Checks all that is in it. Returns 0, or -1 with *e. */
int check_folder(struct check *c, const char *path, struct err *e);

#endif
