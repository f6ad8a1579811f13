/* A folder of masks as pictures, DIR/VIEW/NAME.png, as mask-export --png writes it and as 3D-OVS has its
 * segmentations. formats/records/annotations.md. */
#ifndef CMD_MASKS_MASK_TREE_H
#define CMD_MASKS_MASK_TREE_H

#include "base/err.h"

/* Called for each picture: its file, its view and what it is of. Returns 0, or -1 with *e set. */
typedef int mask_tree_put(void *to, const char *path, const char *view, const char *name, struct err *e);

/* All pictures, by the names of views and then of files; where the folder has a classes.txt, those of its
 * classes only. Returns 0, or -1 with *e set: ERR_FORMAT where there is none. */
int mask_tree_each(const char *dir, mask_tree_put *put, void *to, struct err *e);

#endif
