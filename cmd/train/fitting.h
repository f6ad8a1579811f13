/* A 3DGS scene trained from photographs and their cameras: gs-train. */
#pragma once

#include "base/err.h"
#include "base/report.h"

#include <stdint.h>

struct fitting_options {
	const char *cameras; /* a file, or a folder that has one */
	const char *images;  /* the photographs' folder */
	const char *points;  /* COLMAP model with the first Gaussians' places; NULL: the cameras', where it is
				one */
	const char *init;    /* a scene to go on from; NULL: the points */
	const char *test_views;	     /* as import_split has it; NULL: the camera file's */
	const char *ignore;	     /* folder of masks NAME.png of what does not count; NULL: none */
	const char *exposure;	     /* "auto", "always" or "never" learned */
	const char *preview;	     /* folder for a picture at each evaluation; NULL: none */
	const char *log;	     /* NULL: none */
	const char *checkpoint_path; /* NULL: none */
	int is_resumed;		     /* go on from the checkpoint, if there is one */
	long long checkpoint;	     /* one every so many steps; 0: never */
	const char *output;
	long long iterations, degree, seed;
	long long gaussians; /* 0: start_number */
	double scale;	     /* of the photographs */
	double minutes;	     /* > 0: as many steps as they give */
};

/* Trains and writes the scene. Returns 0, or -1 with *e set. */
int fit_scene(const struct fitting_options *o, const struct report *to, struct err *e);

/* Whether a training, of either kind, goes on from its checkpoint: where there is one and that is wanted.
 * Warns of one that will be replaced. */
int fitting_resumes(const char *checkpoint, int is_wanted, int is_replaced, const struct report *to);
