/* Photographs that a person painted over, a colour for each thing, or labelled, as mask records: mask-import.
 */
#ifndef CMD_MASKS_PAINTING_H
#define CMD_MASKS_PAINTING_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/masks/painting_names.h"
#include "cmd/import/warping.h"

#include <stddef.h>

/* Whether what is read is a painted picture, whose colours need names: neither labels nor records, by their
 * endings, nor a folder (formats/records/annotations.md). */
int painting_needs_names(const char *path);

/* A mask record for each label of a JSON file, for each record of a file of them, for each picture of a
 * folder of masks, and for each picture and name that has a pixel in it, pictures in their order, names in
 * the file's. The view is the picture's file name without its ending. Other colours are of nothing; warns of
 * those that cover much, and of names that no picture has. ERR_FORMAT where none has any. Masks are warped as
 * *w says. Writes to a file ("-": stdout). Returns 0, or -1 with *e set. */
int painting_write(struct painting_names *names, const char *const *pictures, size_t count, struct warping *w,
	const char *path, const struct report *to, struct err *e);

#endif
