/* From the cameras of a foreign file to the views of a scene: checked, named and in order. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"

enum { VIEW_SIZE_MAX = 65536 };

/* Why a camera cannot be a view ("its size is not within 1 to 65536", ...), or NULL. */
const char *view_fault(const struct camera *c);

/* Sets the size where both are whole numbers from 1 to VIEW_SIZE_MAX; else -1. */
int view_set_size(struct camera *c, double width, double height);

/* A photograph's path as a foreign file has it, written one way: slashes for backslashes and no letter of a
 * drive, as Windows has them, no ".", no ".." after a folder and no slash twice, in Unicode's composed form.
 * free() it; NULL with *e set when memory is out. */
char *view_image(const char *path, struct err *e);

/* Takes cameras whose `image` is that path and whose `name` is NULL.
 * Checks each (view_fault), names it and sorts by name (byte order).
 *
 * A view's name is its image's file name without folder and without an image extension (.jpg .jpeg .png .bmp
 * .tif .tiff .webp .exr, any case), as name_to_view writes it. Views that would share a name keep their
 * folders; those that still share one keep the extension too; those that share even that are the whole path
 * as name_to_file writes it. Two of the same path are an error. `path` is for messages. */
int views_finish(struct cameras *c, const char *path, struct err *e);

/* 1 where a photograph's path gives a view this name, with as many folders as tell it from others, as
 * views_name does: *part is that end of the path; 0 where not; -1 with *e. */
int view_part(const char *image, const char *view, const char **part, struct err *e);

/* The names (n) of views that views_finish gives to images of these paths, in their order: free() each.
 * Returns 0, or -1 with *e and no names. */
int views_name(const char *const *images, size_t n, char **names, const char *path, struct err *e);

/* Length of an image path without its extension, where it has one of the above; else its whole length. */
size_t view_stem(const char *image);

/* The part after the last '/'. */
const char *view_base(const char *image);
