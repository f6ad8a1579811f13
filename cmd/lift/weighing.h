/* The blend weights of a scene's views, rendered, pruned and written: gs-weigh. formats/scene/weights.md. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "formats/arrays/precision.h"
#include "formats/scene/scene.h"

enum { WEIGHING_TRAIN, WEIGHING_TEST, WEIGHING_ALL };

struct weighing_options {
	const char *scene, *folder; /* the scene's name for messages, and where to write to */
	int split;		    /* the views: WEIGHING_... */
	enum precision precision;
	int is_packed;	  /* with PRECISION_U8 */
	double scale;	  /* of the image, as a share of the view's */
	double tolerance; /* the share of a pixel's weight that may be left out */
};

/* A scene that covers less of every view than this part of its pixels, more scene than background, is not
 * seen. The desk covers all of each; a lone thing of a thirtieth of its width still does. */
#define WEIGHING_COVERED 1e-3

/* Writes a file for each view, and a note of it. ERR_FORMAT where no view is of the split. ERR_FORMAT also,
 * and nothing is left, where the scene is seen in none of the views. Returns 0, or -1 with *e set. */
int weigh(const struct scene *s, const struct weighing_options *o, const struct report *to, struct err *e);
