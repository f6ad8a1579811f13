/* Features or labels of a scene's views, lifted onto its Gaussians: feature-lift. formats/scene/features.md.
 */
#ifndef CMD_FEATURE_FEATURE_LIFTING_H
#define CMD_FEATURE_FEATURE_LIFTING_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/feature/feature_components.h"
#include "cmd/feature/feature_maps.h"
#include "formats/scene/scene.h"
#include "lift/lift_features.h"
#include "lift/lift_labels.h"

struct feature_lifting_options {
	const char *scene, *weights;
	struct feature_maps_options maps;
	int is_single;	      /* float32, else half floats */
	long long memory;     /* MiB that sums of features may take */
	double prune;	      /* Gaussians of less reliability become unseen */
	long long components; /* that features are told by; 0: they are written as they are */
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
	struct feature_components components;
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

#endif
