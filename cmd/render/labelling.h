/* Every object of a lifted scene at once: the scene with a label for each Gaussian, each object alone, and a
 * line of names, colours and boxes for each. */
#ifndef CMD_RENDER_LABELLING_H
#define CMD_RENDER_LABELLING_H

#include "base/err.h"
#include "cmd/run/anymodel.h"
#include "formats/scene/scene.h"
#include "lift/extent.h"

#include <stdint.h>

struct labelling {
	struct scene scene;
	struct anymodel model;
	struct extent *extents; /* (objects) */
	int32_t *labels;	/* (N) as lift/labels.h has them */
};

/* Reads both files; *r is zeroed before. ERR_FORMAT where the model is not lifted, or not of the scene.
 * Returns 0, or -1 with *e set; after either labelling_free. */
int labelling_open(struct labelling *r, const char *scene, const char *model, struct err *e);
void labelling_free(struct labelling *r);

/* All return 0, or -1 with *e set. The scene as a .ply with the property label, formats/splats/ply.md. */
int labelling_write_scene(const struct labelling *r, const char *path, struct err *e);
/* DIR/OBJECT.ply for each object, with `/` and the like in names escaped (base/name.h). */
int labelling_write_each(const struct labelling *r, const char *dir, struct err *e);
/* A line for each object, formats/records/boxes.md; "-" is stdout. */
int labelling_write(const struct labelling *r, const char *path, struct err *e);

#endif
