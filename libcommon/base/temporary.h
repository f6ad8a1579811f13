/* Temporary files beside outputs that are not whole yet: PATH.tmp.refersplat0, or with a higher number where
 * another run is writing the same output. Each is locked (flock(2)) as long as its run is alive, which is how
 * the leftover of a killed run is told from the file of a living one. */
#pragma once

#include "base/err.h"

struct temporary;

/* Makes an empty one beside path, for its owner only, and removes those that killed runs left beside it. As
 * many can be open at a time as the system lets a process open. Returns the descriptor, or -1 with *e, which
 * names `called`. */
int temporary_make(struct temporary **t, const char *path, const char *called, struct err *e);

/* 1 where a living run had one of its own beside the same path when this was made. Where the file system has
 * no locks that is not known. */
int temporary_is_shared(const struct temporary *t);

/* Puts it in the place of path: 0, or -1 with errno. It is still there then. Close its descriptor afterwards:
 * the lock ends with it. */
int temporary_rename(struct temporary *t, const char *path);

/* Removes it where it was not renamed, and forgets it. t may be NULL. */
void temporary_end(struct temporary *t);

/* Removes all, for a signal's handler, after which the process ends: from then on threads that make, rename
 * or remove one wait for that end. */
void temporary_remove_all(void);
