/* A scene with the things of a sentence or a question painted, alone, or taken away: refer-locate. */
#ifndef CMD_RENDER_SHOWING_H
#define CMD_RENDER_SHOWING_H

#include "answer/locate.h"
#include "base/err.h"
#include "base/report.h"
#include "cmd/ask/asking.h"
#include "cmd/render/locating.h"

#include <stdio.h>

/* What the request's only sentence means, as .ply and .splat; NULL: not. */
int showing_write(
	const struct locating *r, enum locate_show show, const char *ply, const char *splat, struct err *e);

/* The things of a lifted model, by their numbers: showing_open once, showing_things for each scene, which
 * splats_free releases. */
struct showing {
	const struct scene *scene;
	const struct lifted *lifted;
	const struct extent *extents;
	float *most; /* splat/visibility.h */
	char *of;
};
int showing_open(struct showing *w, const struct scene *scene, const struct lifted *lifted,
	const struct extent *extents, struct err *e);
int showing_things(struct splats *to, const struct showing *w, const size_t *things, size_t count,
	enum locate_show show, struct err *e);
void showing_free(struct showing *w);

/* Asks a question and writes the scene to `path`, in the format that it is named by; a line of `out` says
 * what was meant. ERR_CHECK where nothing is meant: nothing is written. All return 0, or -1 with *e set. */
int showing_ask(const struct asking_options *o, const char *question, enum locate_show show, const char *path,
	FILE *out, const struct report *to, struct err *e);

#endif
