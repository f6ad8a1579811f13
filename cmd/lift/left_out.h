/* Whether masks show one scene, told to who runs the tool. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "lift/lift_objects.h"

/* lift_left_out of the first `named` objects: masks that show no one scene are an error, for nothing that is
 * learned of them is right, and those that hardly do a warning. `masks` is the file of them, and `scene` the
 * folder. Returns 0, or -1 with *e set. */
int left_out_check(struct lift_objects *l, size_t named, const char *masks, const char *scene,
	const struct report *to, struct err *e);
