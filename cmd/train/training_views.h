/* The weights of the views that refer-train learns from: each is in memory only while it is read, and known
 * by its sizes and its checksum. */
#ifndef CMD_TRAIN_TRAINING_VIEWS_H
#define CMD_TRAIN_TRAINING_VIEWS_H

#include "base/err.h"
#include "formats/scene/scene.h"
#include "formats/scene/weights.h"
#include "train/train.h"
#include "train/view_source.h"

#include <stddef.h>
#include <stdint.h>

struct training_view {
	struct weights file; /* open as long as it is read */
	size_t at;	     /* of the scene's cameras */
	size_t bytes;	     /* of the arrays of its weights */
	uint32_t sum;	     /* their crc32 */
};

struct training_views {
	const struct scene *scene;
	const char *folder;
	size_t n;
	struct train_view *views;   /* (n) without the arrays of their weights */
	struct training_view *read; /* (n) */
	struct camera *cameras;	    /* (n) at the size of their weights; names belong to scene */
	double *weight;		    /* (the scene's Gaussians) over all views */
	size_t pixels;		    /* of the largest view */
};

/* Room for every view of the scene, none of them yet. Returns 0, or -1 with *e set; free after either. */
int training_views_init(
	struct training_views *t, const struct scene *scene, const char *folder, struct err *e);
void training_views_free(struct training_views *t);

/* Reads a view of the scene's, the next one. Returns as training_views_init. */
int training_views_add(struct training_views *t, size_t camera, struct err *e);

/* They as a source; *t stays where it is. */
struct view_source training_views_source(struct training_views *t);

#endif
