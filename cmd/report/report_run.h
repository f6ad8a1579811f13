/* What a run folder of the pipelines holds, as refer-report reads it. */
#ifndef CMD_REPORT_REPORT_RUN_H
#define CMD_REPORT_REPORT_RUN_H

#include "base/err.h"
#include "base/report.h"
#include "cmd/run/anymodel.h"
#include "cmd/score/score_masks.h"
#include "formats/scene/scene.h"
#include "formats/scene/text.h"
#include "score/score.h"

#include <stddef.h>

struct report_options {
	const char *run;    /* the folder */
	const char *truth;  /* NULL: what the pipeline scored against, if anything */
	const char *viewer; /* folder of the viewer's modules; NULL: the usual one, if it is there */
	int is_plain;	    /* no viewer */
	long long views;    /* of so many views a picture at most */
	long long width;    /* of a picture in pixels at most */
	long long splats;   /* Gaussians in the viewer at most */
};

/* One way of answering, and the sentences of one kind that it answered. */
struct report_set {
	const char *way, *name; /* "lifted", "stage1", "stage2"; "test", "train", "asked" */
	struct text text;
	struct score_masks masks; /* the predictions */
	struct mask *truth;	  /* of the views that they are of; pairs have their index here */
	struct score_pairs pairs; /* none without truth */
	struct score sum;	  /* of the pairs */
};

enum { REPORT_SETS = 7 };

struct report_run {
	const struct report_options *options;
	struct scene scene;
	int has_lifted;
	struct anymodel lifted;
	char *lifted_path;
	char *truth_path; /* NULL: no truth */
	struct score_masks truth;
	size_t set_count;
	struct report_set sets[REPORT_SETS];
	size_t shown_count;
	struct camera *shown; /* the views of which there are pictures, at the size of these */
};

/* Reads the folder. *r is zeroed before, and options stay the caller's. Returns 0, or -1 with *e set
 * (ERR_SYSTEM where it is no such folder); after either report_run_free. */
int report_run_read(
	struct report_run *r, const struct report_options *options, const struct report *to, struct err *e);
void report_run_free(struct report_run *r);

#endif
