/* A 3DGS scene trained from photographs and their cameras: gs-train. */
#ifndef CMD_TRAIN_FITTING_H
#define CMD_TRAIN_FITTING_H

#include "base/err.h"
#include "base/report.h"

#include <stddef.h>
#include <stdint.h>

struct fitting_options {
	const char *cameras; /* a file, or a folder that has one */
	const char *images;  /* the photographs' folder */
	const char *points;  /* COLMAP model with the first Gaussians' places; NULL: the cameras', where it is
				one */
	const char *init;    /* a scene to go on from; NULL: the points */
	const char *test_views; /* as import_split has it; NULL: the camera file's */
	const char *log;	/* NULL: none */
	const char *output;
	long long iterations, degree, seed;
	long long gaussians; /* 0: start_number */
	double scale;	     /* of the photographs */
	double minutes;	     /* > 0: as many steps as they give */
};

/* Trains and writes the scene. Returns 0, or -1 with *e set. */
int fit_scene(const struct fitting_options *o, const struct report *to, struct err *e);

#endif
