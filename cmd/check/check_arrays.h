/* What cmd/check/check.h says of files of arrays and of cameras: each reads a whole file with its format's
 * reader, and adds what it counted. Return 0, or -1 with *e. */
#ifndef CMD_CHECK_CHECK_ARRAYS_H
#define CMD_CHECK_CHECK_ARRAYS_H

#include "cmd/check/check.h"
#include "formats/scene/scene.h"

/* Those of ours, whose kind is known already. */
int check_splats(struct check *c, const char *path, struct err *e);
int check_text(struct check *c, const char *path, struct err *e);
int check_weights(struct check *c, const char *path, struct err *e);
int check_model(struct check *c, const char *path, struct err *e);
int check_lifted(struct check *c, const char *path, struct err *e);
int check_features(struct check *c, const char *path, struct err *e);
int check_selection(struct check *c, const char *path, struct err *e);
int check_parser(struct check *c, const char *path, struct err *e);

/* The others. */
int check_anysplats(struct check *c, const char *path, const char *kind, struct err *e);
int check_npy(struct check *c, const char *path, struct err *e);
int check_npz(struct check *c, const char *path, struct err *e);
int check_image(struct check *c, const char *path, struct err *e);
int check_scene_cameras(struct check *c, const char *path, struct err *e);
int check_cameras(struct check *c, const char *path, const char *kind, struct err *e);

void check_add_splats(struct check *c, const struct splats *s);
/* The views and, where they have one size, that. */
void check_add_views(struct check *c, const struct cameras *views);

#endif
