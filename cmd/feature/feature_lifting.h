/* Features or labels of a scene's views, lifted onto its Gaussians (formats/scene/features.md). */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "formats/arrays/npy.h"
#include "formats/arrays/npz.h"
#include "formats/records/masks.h"
#include "formats/scene/features.h"
#include "formats/scene/scene.h"
#include "formats/scene/text.h"
#include "lift/lift_features.h"
#include "lift/lift_labels.h"
#include "mask/mask_index.h"

#include <stdint.h>

/* What 2D models say of a scene's training views: maps of features, segments with a feature each, labels, or
 * masks with the vector of a text each; and which pixel has which. formats/scene/features.md. */

struct feature_maps_options {
	const char *folder;	  /* VIEW.npy or .npz, VIEW_f.npy and VIEW_s.npy, or VIEW.png, or an .npz of
				     such arrays; NULL: masks */
	const char *masks, *text; /* text NULL: the masks' objects are labels */
	long long level;	  /* of segments */
	int is_zero;		  /* pixels without a feature count as zero, else not at all */
};

enum feature_maps_kind { MAPS_NONE, MAPS_CELLS, MAPS_SEGMENTS, MAPS_LABELS, MAPS_MASKS, MAPS_MASK_LABELS };

struct feature_maps {
	const struct feature_maps_options *options;
	const struct scene *scene;
	enum feature_maps_kind kind;
	char *is_there;	 /* (views) the view has files of this kind, or masks */
	size_t channels; /* 0: labels */
	int is_npz;	 /* one file of all views; else there is a folder */
	struct npz npz;
	/* of masks */
	struct masks set;
	struct mask_index index;
	struct text text;
	int32_t *row; /* (set.n) of the text, or the label of the object; -1: none */
};

/* A view's sources (lift/source_weights.h): one for each feature or label that a pixel has. */
struct feature_sources {
	int32_t *source; /* (P) */
	size_t count;
	size_t *row; /* (count) of the table; FEATURES_ZERO: zero */
	int32_t *label;
	struct npy table; /* of features, open until the next view; not of masks and labels */
	/* room that views share */
	size_t pixel_room, row_room, label_room, place_room;
	int32_t *place;
	int32_t *raw; /* (P) the row of each pixel, -1: none */
	size_t raw_room;
	uint8_t *mask;
	size_t mask_room;
};
#define FEATURES_ZERO SIZE_MAX

/* Reads the masks, or looks for files of the training views. Warns of what does not count. *m is zeroed
 * before, and the others stay the caller's. Returns 0, or -1 with *e; feature_maps_free in any case. */
int feature_maps_find(struct feature_maps *m, const struct feature_maps_options *options,
	const struct scene *scene, const struct report *to, struct err *e);
void feature_maps_free(struct feature_maps *m);

/* The sources of a view that is there, for weights of that size. Of a struct that is zeroed, or has another
 * view. Returns 0, or -1 with *e; feature_sources_free in any case. */
int feature_maps_view(
	struct feature_maps *m, size_t view, int height, int width, struct feature_sources *s, struct err *e);
void feature_sources_free(struct feature_sources *s);

/* features (count,n): the channels from `first` on of each source; factor (count): 1 over the length with all
 * channels, or 0. ERR_FORMAT where a number is not finite. Returns 0, or -1 with *e. */
int feature_maps_features(const struct feature_maps *m, const struct feature_sources *s, size_t first,
	size_t n, float *features, double *factor, struct err *e);

/* The files of a view that feature_maps reads: their tables of features, and which row each pixel has. */

/* How many channels the view's features have; 0 for labels. Returns 0, or -1 with *e. */
int feature_tables_channels(const struct feature_maps *m, size_t view, size_t *channels, struct err *e);

/* Opens s->table, and s->raw (height,width) gets the row of each pixel, of *rows. 0, or -1 with *e. */
int feature_tables_open(const struct feature_maps *m, size_t view, int height, int width,
	struct feature_sources *s, size_t *rows, struct err *e);

struct feature_lifting_options {
	const char *scene, *weights;
	struct feature_maps_options maps;
	int is_single;	  /* float32, else half floats */
	long long memory; /* MiB that sums of features may take */
	double prune;	  /* Gaussians of less reliability become unseen */
};

struct feature_lifting {
	const struct feature_lifting_options *options;
	struct scene scene;
	struct feature_maps maps;
	/* What comes of it. */
	void *values;
	int32_t *labels;
	float *reliability, *weight;
	size_t seen, pruned; /* Gaussians */
	/* While it goes on. */
	const struct report *to;
	struct feature_sources sources;
	struct source_weights weights;
	struct lift_features features;
	struct lift_labels votes;
	float *table;
	double *factor;
	size_t table_room, factor_room, first, block, done;
};

/* Reads the scene, looks at all views, and has what comes of it. Warns of what is left out. *l is zeroed
 * before; *options stays the caller's. Returns 0, or -1 with *e set; feature_lifting_free in any case. */
int feature_lifting_make(struct feature_lifting *l, const struct feature_lifting_options *options,
	const struct report *to, struct err *e);
int feature_lifting_write(const struct feature_lifting *l, const char *path, struct err *e);
void feature_lifting_free(struct feature_lifting *l);
