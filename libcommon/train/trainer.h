/* A training in progress: the Gaussians that learn, the step over them, the order of the views and the state.
 */
#pragma once

#include "base/err.h"
#include "field/octree.h"
#include "field/rows.h"
#include "geom/camera.h"
#include "train/row_views.h"
#include "train/train.h"
#include "train/warm_start.h"

struct trainer_options {
	enum refer_interaction interaction;
	enum refer_similarity similarity;
	enum refer_contrast contrast;
	enum refer_query query;	    /* what the source's words are */
	long long feature_width;    /* d_r, 1 to REFER_MAX_X */
	double temperature, lambda; /* of the contrast */
	double tolerance;	    /* train_active_set's */
	double share;	 /* octree_build's price, in pixels a view; 0: every Gaussian has its own feature */
	long long batch; /* most sentences in a step */
	long long negatives; /* train_order's */
	long long warm;	     /* steps of a warm start; 0: none */
	struct train_rates rates;
	long long seed;
};

/* pcmi, dot and the rest as refer-train has them where nothing is said. */
#define TRAINER_DEFAULTS                                                                                     \
	{                                                                                                    \
		.interaction = REFER_PCMI, .contrast = REFER_CONTRAST_COSINE, .feature_width = 16,           \
		.temperature = 0.1, .lambda = 0.02, .share = 0.04, .batch = 1, .negatives = 12, .rates = {   \
			0.0025,                                                                              \
			0.0001                                                                               \
		}                                                                                            \
	}

/* What is learned from. Referred to, not copied. */
struct trainer_source {
	const float *means;	      /* (scene_gaussians,3) */
	const struct camera *cameras; /* (view_count) of the views, at the size of their weights */
	size_t scene_gaussians;	      /* N */
	int text_width;
	size_t sentences;	/* R */
	const int64_t *offsets; /* (R+1) into words */
	const float *words;	/* (offsets[R], text_width) */
	const int *objects;	/* (R) */
	struct view_source views;
	size_t pixels;			 /* of the largest view */
	const double *weight;		 /* (scene_gaussians) over all views */
	struct row_views_room room;	 /* for the views' weights over rows */
	const struct lifted *lifted;	 /* what a warm start is fitted to; NULL without one */
	const char *const *object_names; /* (R) for it */
};

struct trainer {
	struct refer_layout layout;
	struct train_rates rates;
	size_t learning;      /* Gaussians that learn */
	int32_t *ids;	      /* (learning) */
	struct octree octree; /* no leaves: a row for each of ids */
	struct rows rows;
	double low[3], high[3];
	float *position;	/* (rows,3) */
	uint32_t *counts;	/* (rows) Gaussians of each */
	struct row_views views; /* the source's */
	struct step *step;
	struct train_order order;
	struct train_state state;
	long warm_steps; /* the first of all */
	struct warm_start warm;
};

/* ERR_FORMAT, without a file name, where no Gaussian has weight. */
int trainer_init(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e);
void trainer_free(struct trainer *t);

/* Weights over rows that a pixel has on average. */
double trainer_weights(const struct trainer *t);

/* (rows.n, d_r) the features of a slab (train_state's values), row-major; free() them. NULL with *e when
 * memory is out. */
float *trainer_features(const struct trainer *t, const float *values, struct err *e);

/* The next step, train_step's. Returns 0, or -1 with *e set where a view cannot be read. */
int trainer_step(struct trainer *t, struct step_losses *losses, struct err *e);
