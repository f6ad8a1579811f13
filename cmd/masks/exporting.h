/* Mask records as other programs have them: COCO's JSON, and a PNG for each mask.
 * formats/records/annotations.md. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"
#include "mask/mask.h"

#include <stdio.h>

struct exporting {
	const char *path; /* of the masks, for messages */
	struct masks masks;
	struct cameras cameras;	     /* of the scene that names photographs; or none */
	size_t views, objects;	     /* different ones */
	size_t *view_of, *object_of; /* (masks.n) the number of each, in the order of their first mask */
	const struct mask **first_of_view;   /* (views) */
	const struct mask **first_of_object; /* (objects) */
};

/* Reads masks ("-" is stdin) and, where scene is not NULL, its cameras; *x is zeroed before. With `distort`
 * masks of views become those of their photographs. ERR_FORMAT where masks of one view differ in size.
 * Returns 0, or -1 with *e set; exporting_free after either. */
int exporting_read(struct exporting *x, const char *masks, const char *scene, int distort, struct err *e);
void exporting_free(struct exporting *x);

/* Both return 0, or -1 with *e set. The JSON, on one line. */
int exporting_put_coco(const struct exporting *x, FILE *out, struct err *e);
/* DIR/VIEW/NAME.png of each, white on black; its sentence's name, else its object's. ERR_FORMAT, before
 * anything is written, where two would be one file. */
int exporting_write_pngs(const struct exporting *x, const char *dir, struct err *e);
