/* Paths as text. */
#pragma once

#include "base/err.h"

/* The path of `target` as seen from the folder `dir`: "../images/a.jpg". Both must exist; symbolic links of
 * the folders are followed, that of the target's last part is not. free() it; NULL with *e set. */
char *path_relative(const char *dir, const char *target, struct err *e);

/* dir/name where that exists, else with each part of name in the letters of the one file or folder that
 * differs from it in case alone. free() it; NULL with *e set when memory is out. */
char *path_alike(const char *dir, const char *name, struct err *e);

/* The last part of a path, which may end in slashes: where it begins, and its length without them. */
const char *path_last(const char *path, int *length);

/* 1 where a path, as text, is not of something in the folder that it begins in: an absolute one, or one whose
 * ".." lead above it. Symbolic links are not looked at. */
int path_leaves(const char *path);

/* Whether a name ends so, whatever the case of its letters, and has something before it. */
int path_ends(const char *name, const char *tail);

/* Where a chain of symbolic links leads, of which the last may be dangling: what a file of that name that is
 * made or replaced really is. The path itself where it is no link. free() it; NULL with *e: a circle, say. */
char *path_follow(const char *path, struct err *e);

/* 1 where both are one regular file or folder, under whichever names, or will be once they are made; else 0.
 * Devices and pipes are never the same. -1 with *e set (links in a circle, or memory is out). */
int path_is_same(const char *a, const char *b, struct err *e);
