/* A run folder as one page of HTML: the text is report_page.html; what it shows stands in it as JSON. */
#pragma once

#include "base/err.h"
#include "base/jsontext.h"
#include "base/report.h"
#include "cmd/ask/asking.h"
#include "cmd/run/anymodel.h"
#include "cmd/score/score_masks.h"
#include "formats/scene/scene.h"
#include "formats/scene/text.h"
#include "score/score.h"

#include <stdint.h>
#include <stdio.h>

/* What a run folder of the pipelines holds, as refer-report reads it. */

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

/* Answers that a run folder has no file of: a scene of photographs that were painted has no test views. */

/* s->masks gets what r->lifted answers to the sentences of s->text in some training views, at the size of the
 * pictures. Returns 0, or -1 with *e set. */
int report_answer(const struct report_run *r, struct report_set *s, const struct report *to, struct err *e);

/* What a run folder says of how it was made: times, losses, settings. */

/* The steps that the pipelines logged, in the order in which they are done: a list of
 * {"step","seconds","mib","command"}; the numbers are absent where the log does not end with them. */
void report_steps(struct jsontext *to, const char *run);

/* The training logs (formats/records/trainlog.md): a list of
 * {"stage","lines":[[iteration,bce,contrast,loss],...], "held":[[iteration,bce,iou],...]}. */
int report_losses(struct jsontext *to, const char *run, struct err *e);

/* The metadata of the run's files: a list of {"file","metadata":{...}}, without checksums and long lists.
 * Both return 0, or -1 with *e set. */
int report_settings(struct jsontext *to, const char *run, struct err *e);

/* Outlines of masks as paths of SVG, each text once. */

struct report_outlines {
	size_t n, capacity;
	struct report_outline {
		char *path; /* "M3 4h2v1h-2z", in pixels; "" for an empty mask */
		uint64_t hash;
	} * items;
};

void report_outlines_free(struct report_outlines *o);

/* What sentences mean among the lifted objects, and why. */

struct report_reason {
	size_t count, *things; /* the objects that are meant, likeliest first; none: refused */
	char *explained;       /* JSON, of explain_meaning */
	char refusal[EXPLAIN_REASON];
	double there;		 /* P that anything is meant */
	const char *runner_up;	 /* the likeliest other object, the model's; NULL */
	double runner_up_chance; /* of it to be meant */
};

/* reasons (s->text.n), zeroed before: of each sentence of a set that the lifted model answered. Returns 0, or
 * -1 with *e set; after either report_reasons_free. */
int report_reasons(
	const struct report_run *r, const struct report_set *s, struct report_reason *reasons, struct err *e);
void report_reasons_free(struct report_reason *reasons, size_t n);

/* The sentences of a run, each with its answers, as the page has them. */

/* One object for each set: {"way","name","score":{...},"sentences":[...]}; "score" where there is truth. Of a
 * sentence: "ref", "text", "said" (the objects it means, where it says so), "answer", "runner_up", "there",
 * "sure", "iou", "pairs", "right" (null: not known), "refusal", "explained", and "views", a list of [view,
 * mask, truth or -1, iou or null], where mask and truth are places in the outlines. 0, or -1 with *e. */
int report_sentences(
	struct jsontext *to, const struct report_run *r, struct report_outlines *o, struct err *e);

/* The scene as splats in a page, with what shows them: Spark (sparkjs.dev, MIT) on three.js (MIT), which
 * `make viewer` fetches. */

/* Writes the scripts of the viewer, and nothing where there is none: r->options->is_plain, or no viewer is
 * named and none has been fetched, which is told. Returns 0, or -1 with *e set. */
int report_viewer_put(FILE *out, struct report_run *r, const struct report *to, struct err *e);

/* The Gaussians that a viewer shows. */
struct report_splats {
	size_t groups;	/* the rest, then each object of the lifted model */
	size_t *counts; /* (groups) */
	size_t n;	/* that are shown */
	uint8_t *bytes; /* (32,n): all first bytes of .splat (formats/splats/splat.md), then all second ones,
			   ... */
};

/* At most r->options->splats of them, those that cover most. Lengths keep 15 bits in positions and 7 in
 * sizes, as what is 0 packs well. Returns 0, or -1 with *e set; report_splats_free after either. */
int report_splats_make(struct report_splats *s, const struct report_run *r, struct err *e);
void report_splats_free(struct report_splats *s);

/* What the viewer is told of them, as members of an object: "count", "groups", "camera", ...; `viewer` is the
 * folder of its modules, NULL: none. The objects have places (anymodel_place). 0, or -1 with *e. */
int report_scene_put(struct jsontext *to, const struct report_run *r, const struct report_splats *s,
	const char *viewer, struct err *e);

/* The modules of the viewer by the names of their files, and where they are imported from. */
struct report_module {
	const char *name, *file;
};
enum { REPORT_MODULES = 5 };
extern const struct report_module report_modules[REPORT_MODULES];
extern const char report_viewer_begin[]; /* the script that shows them */

/* Small pictures of views, as they stand in a page. */

/* A list of {"name","split","width","height","photograph","picture"}, one for each view that is shown: its
 * photograph, or the scene rendered where there is none, as a data URI of a JPEG. Warns of photographs that
 * cannot be read. Returns 0, or -1 with *e set. */
int report_views(struct jsontext *to, const struct report_run *r, const struct report *told, struct err *e);

/* A JPEG of a view, as large as the camera: of its photograph, 1, or 0 where there is none that can be read,
 * which is told; of the scene, 0. -1 with *e set; free() the bytes. */
int report_photograph(const char *folder, const struct camera *c, uint8_t **bytes, size_t *n,
	const struct report *to, struct err *e);
int report_rendering(
	const struct scene *s, const struct camera *c, uint8_t **bytes, size_t *n, struct err *e);

/* Writes the page of a run to a file ("-": stdout). Returns 0, or -1 with *e set. */
int reporting_write(
	const struct report_options *options, const char *path, const struct report *to, struct err *e);
