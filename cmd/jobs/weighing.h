/* The blend weights of a scene's views, rendered, pruned and written: gs-weigh. formats/weights.md. */
#ifndef CMD_JOBS_WEIGHING_H
#define CMD_JOBS_WEIGHING_H

#include "base/err.h"
#include "base/report.h"
#include "formats/precision.h"
#include "formats/scene.h"

enum { WEIGHING_TRAIN, WEIGHING_TEST, WEIGHING_ALL };

struct weighing_options {
	const char *scene, *folder; /* the scene's name for messages, and where to write to */
	int split;		    /* the views: WEIGHING_... */
	enum precision precision;
	double scale;	  /* of the image, as a share of the view's */
	double tolerance; /* the share of a pixel's weight that may be left out */
};

/* Writes a file for each view, and a note of it. ERR_FORMAT where no view is of the split. Returns 0, or -1
 * with *e set. */
int weigh(const struct scene *s, const struct weighing_options *o, const struct report *to, struct err *e);

#endif
