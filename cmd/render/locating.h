/* Where the answers to sentences are, and of several things each by itself. */
#pragma once

#include "answer/locate.h"
#include "base/err.h"
#include "base/report.h"
#include "cmd/ask/asking.h"
#include "cmd/render/request.h"
#include "cmd/run/anymodel.h"
#include "formats/scene/scene.h"

#include <stdint.h>
#include <stdio.h>

struct locating {
	struct request request;	 /* answered by the caller */
	struct located *answers; /* (answers) */
};

/* up gets the direction that was taken for it. 0, or -1 with *e; locating_free is then in order. */
int locating_find(struct locating *r, double up[3], struct err *e);

/* A line for each sentence, formats/records/boxes.md; "-" is stdout. */
int locating_write(const struct locating *r, const char *path, struct err *e);

/* The same at every stored time of a scene that moves, without finding it before: boxes of what is meant now.
 */
int locating_track(struct locating *r, const char *path, struct err *e);

/* With its request. */
void locating_free(struct locating *r);

/* Every object of a lifted scene at once: the scene with a label for each Gaussian, each object alone, and a
 * line of names, colours and boxes for each. */

struct labelling {
	struct scene scene;
	struct anymodel model;
	int32_t *labels; /* (N) as lift/labels.h has them */
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

/* A scene with the things of a sentence or a question painted, alone, or taken away: refer-locate. */

/* What the request's only sentence means, as .ply and .splat; NULL: not. */
int showing_write(
	struct locating *r, enum locate_show show, const char *ply, const char *splat, struct err *e);

/* The things of a lifted model that is placed, by their numbers: showing_open once, showing_things for each
 * scene, which splats_free releases. */
struct showing {
	const struct scene *scene;
	const struct anymodel *model;
	float *most; /* splat/visibility.h */
	char *of;
};
int showing_open(struct showing *w, const struct scene *scene, const struct anymodel *model, struct err *e);
int showing_things(struct splats *to, const struct showing *w, const size_t *things, size_t count,
	enum locate_show show, struct err *e);
void showing_free(struct showing *w);

/* Asks a question and writes the scene to `path`, in the format that it is named by; a line of `out` says
 * what was meant. ERR_CHECK where nothing is meant: nothing is written. All return 0, or -1 with *e set. */
int showing_ask(const struct asking_options *o, const char *question, enum locate_show show, const char *path,
	FILE *out, const struct report *to, struct err *e);
