/* A scene that moves, from frames in files of their own or from one file and displacements: gs-import.
 * formats/scene/motion.md. */
#pragma once

#include "base/err.h"
#include "formats/arrays/npz.h"
#include "formats/scene/scene.h"
#include "splat/gaussian_rows.h"

struct moving {
	size_t n;	    /* times; 0: the scene is still */
	const char *from;   /* the folder or archive, for messages */
	char **paths;	    /* (n) the files of frames, in the order of their numbers; else NULL */
	double *times;	    /* (n) rising */
	struct npz archive; /* else */
	struct npy means, quats;
	int is_displaced; /* means are added to those of SPLATS */
	float *canonical; /* (N,3) these */
	double offset[3]; /* of the first frame */
};

/* Finds the frames of a folder (motion NULL), or opens the archive `motion`, and takes the times: a file of
 * numbers, "T0:T1", "Nfps", or NULL. *m is zeroed before; after it moving_free is in order. */
int moving_open(struct moving *m, const char *splats, const char *motion, const char *times, struct err *e);

/* Views have all a time or none, and a time that there is. */
int moving_check_views(const struct moving *m, const struct cameras *c, const char *cameras, struct err *e);

/* The Gaussians of the first time, in place of those of SPLATS where these are displaced. */
int moving_first(
	struct moving *m, struct scene *s, const struct rows_report *rows, const char *splats, struct err *e);

/* Reads all frames and writes FOLDER/motion.safetensors; *moved: how many Gaussians ever move. */
int moving_write(
	const struct moving *m, const struct scene *s, const char *folder, size_t *moved, struct err *e);
void moving_free(struct moving *m);
