/* The masks of a request's sentences in views of the scene, and pictures of them: refer-render.
 * formats/records/masks.md, formats/images/pictures.md. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "cmd/masks/pictures.h"
#include "cmd/render/request.h"
#include "geom/camera.h"
#include "mask/mask.h"

struct draw_options {
	int split;	   /* the views of which split; REQUEST_ALL */
	const char *views; /* NAME,...: these views instead; NULL: of the split */
	int size[2];	   /* of the masks: width and height; 0: the view's times scale (0: 1) */
	double scale;
	int is_amodal;	  /* outlines of whole objects */
	long long peak;	  /* the window of answer/peak.h where records have peaks; 0: they have none */
	int is_each;	  /* all sentences are said in the view that is drawn */
	int is_all_times; /* each view at every stored time, as VIEW.tNNNNN */
	int is_when;	  /* nothing is shown in views of a time that a sentence of motion does not mean */
	struct pictures pictures;
};

struct drawing {
	const struct draw_options *options;
	struct request *request;
	size_t view_count;
	struct camera *views; /* (view_count) at the size of the masks; names are the scene's, or: */
	char **names;	      /* (view_count), NULL where they are the scene's */
	/* While it goes on: */
	const struct report *to;
	/* gets the record of a sentence in a view, and of its parts (n), which are not its own */
	int (*put)(void *data, const struct mask *m, const struct mask *parts, size_t n, struct err *e);
	void *data;
	size_t first;	       /* of the views: the first that is rendered now */
	struct splats *wholes; /* (answers) for outlines, else without Gaussians */
	struct mask *shown;    /* (views that are rendered now, answers) unnamed, until they are written; each
				  with its place */
};

/* Chooses the views of a request that has been read: d->views; there may be none. *d is zeroed before, and
 * both others stay the caller's. Returns 0, or -1 with *e set (ERR_USAGE: an option is at fault); after
 * either drawing_free is in order. */
int draw_choose(
	struct drawing *d, const struct draw_options *options, struct request *request, struct err *e);

/* Asks the model, and hands each mask to d->put, view after view in the order of the sentences. from: where
 * sentences are said, as request_answer takes it. */
int draw_each(struct drawing *d, const struct viewpoint *from, const struct report *to, struct err *e);

/* Asks the model and writes the masks to a file ("-": stdout), and the pictures. */
int draw(struct drawing *d, const struct viewpoint *from, const char *path, const struct report *to,
	struct err *e);

void drawing_free(struct drawing *d);
