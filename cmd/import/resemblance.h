/* Whether a scene looks as its photographs do, through its cameras: gs-import. */
#ifndef CMD_IMPORT_RESEMBLANCE_H
#define CMD_IMPORT_RESEMBLANCE_H

#include "base/err.h"
#include "base/report.h"
#include "formats/scene/scene.h"

#include <stddef.h>

/* Splats and cameras of one frame give renders that look like the photographs. Of a view, small and grey,
 * what is left of render and photograph without their blurred selves is correlated; the middle value over
 * some views counts. gs-import(1) has what was measured. */
#define RESEMBLANCE_LEAST 0.4

struct resemblance {
	size_t views;	   /* that were compared */
	double typical;	   /* the middle correlation, -1 to 1, of photographs that are turned upright */
	size_t turned;	   /* views whose photograph is alike only when it is turned */
	const char *first; /* the first of them, of the scene's names, and its way, clockwise */
	int degrees;
	size_t unread; /* views whose photograph cannot be read, and why the first cannot */
	struct err why;
};

/* Compares views that are spread over the scene, whose photographs lie relative to the folder. Returns 0, or
 * -1 with *e set. */
int resemblance_find(struct resemblance *r, const struct scene *s, const char *folder,
	const struct report *to, struct err *e);

#endif
