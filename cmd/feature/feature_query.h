/* Which Gaussians of lifted features sentences select, by the rules of several systems: feature-query.
 * formats/scene/selection.md. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "formats/scene/features.h"
#include "formats/scene/lifted.h"
#include "formats/scene/scene.h"
#include "formats/scene/text.h"
#include "mask/mask.h"

#include <stdint.h>
#include <stdio.h>

/* Vectors of texts, as any encoder makes them: rows of a file. formats/scene/selection.md. */

struct query_vectors {
	size_t n, channels;
	float *values; /* (n,channels), brought to length 1; owned */
};

/* The vectors of the sentences in a file of text-encode, else of the one two-dimensional tensor of floats in
 * a safetensors file, or those of a .npy file, or of the array vectors, else arr_0, of a .npz file.
 * ERR_FORMAT where there are other than `channels` of them for each. 0, or -1 with *e; query_vectors_free
 * after either. */
int query_vectors_read(struct query_vectors *v, const char *path, size_t channels, struct err *e);
/* The same of the sentences of a text that was read from a path. */
int query_vectors_of_text(
	struct query_vectors *v, const struct text *text, const char *path, size_t channels, struct err *e);
void query_vectors_free(struct query_vectors *v);

enum query_rule { RULE_COSINE, RULE_RELEVANCY, RULE_HYPERPLANE, RULE_IDENTITY };

/* Beside SPLIT_TRAIN and SPLIT_TEST. */
enum { QUERY_ALL = 2, QUERY_MAX_LEVELS = 8 };

/* Thresholds as published: LERF's and LangSplat's on relevancies, Gaussian Grouping's on groups. */
#define QUERY_RELEVANT 0.5
#define QUERY_RELEVANT_RELATIVE 0.4
#define QUERY_INSIDE 0.7

/* Examples of either kind that a hyperplane is fitted to, at most; evenly taken. */
enum { QUERY_POSITIVES = 1000, QUERY_NEGATIVES = 2000 };

struct feature_query_options {
	const char *const *features; /* files: the levels of a field */
	size_t levels;
	const char *text, *vectors, *canonical, *against, *positives; /* all but the text may be NULL */
	int sentences;						      /* of which split; QUERY_ALL */
	int rule;
	double threshold; /* NaN: as published */
	int is_relative;  /* the threshold is on LangSplat's scale */
	const char
		*pixels;  /* a scene, in whose test views the rule is for pixels; NULL: it is for Gaussians */
	double least;	  /* pixels whose feature is shorter have none */
	long long smooth; /* window of the mean of relevancies in pixels; 1: as they are */
};

struct feature_query {
	const struct feature_query_options *options;
	double threshold;
	struct features features[QUERY_MAX_LEVELS];
	size_t levels;
	struct text text;
	size_t count, *which; /* (count) the sentences, as indices in text */
	uint64_t **marks;     /* (count) of Gaussians that are selected (lift/marks.h) */
	/* of rules by vectors: those of the sentences, then rivals or canonical phrases */
	struct query_vectors vectors;
	size_t *group; /* (vectors.n) sentences of one object are a group */
	size_t *level; /* (count) that was chosen */
	/* of rules by examples */
	struct lifted lifted;
	size_t *object; /* (count) of lifted */
	/* of rules for pixels: the scene, and what each of its test views shows of each sentence */
	struct scene scene;
	size_t view_count, *views; /* (view_count) of scene.cameras */
	struct mask *shown;	   /* (view_count,count) without names */
};

/* Reads the files, and selects. *q is zeroed before; *options stays the caller's. Returns 0, or -1 with *e
 * set; feature_query_free in any case. */
int feature_query_make(struct feature_query *q, const struct feature_query_options *options,
	const struct report *to, struct err *e);
/* The selection, or the masks. */
int feature_query_write(const struct feature_query *q, const char *path, struct err *e);
void feature_query_free(struct feature_query *q);

/* Rules by the cosines of vectors of texts, and rules by examples of what is meant. */

/* Each reads what else its rules need, and fills q->marks. Returns 0, or -1 with *e set. */
int query_by_vectors(struct feature_query *q, struct err *e);
int query_by_examples(struct feature_query *q, const struct report *to, struct err *e);

/* q->vectors and q->group of the rules by vectors. Returns 0, or -1 with *e set. */
int query_read_vectors(struct feature_query *q, struct err *e);

/* The same by vectors for the pixels of rendered features: q->shown. */
int query_by_pixels(struct feature_query *q, const struct report *to, struct err *e);
/* Its mask records, view after view. */
int query_put_masks(FILE *out, const struct feature_query *q, struct err *e);
