/* What refer-train reads, put together: scene, weights, text and masks, checked against each other.
 * formats/scene/training.md. */
#pragma once

#include "base/err.h"
#include "base/file.h"
#include "base/report.h"
#include "cmd/text/text_query.h"
#include "formats/arrays/precision.h"
#include "formats/records/trainlog.h"
#include "formats/scene/checkpoint.h"
#include "formats/scene/scene.h"
#include "formats/scene/text.h"
#include "formats/scene/weights.h"
#include "train/divergence.h"
#include "train/supervision.h"
#include "train/train.h"
#include "train/trainer.h"
#include "train/view_source.h"

#include <signal.h>
#include <stdint.h>

/* The weights of the views that refer-train learns from: each is in memory only while it is read, and known
 * by its sizes and its checksum. */

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
void training_views_free(struct training_views *t);

/* They as a source; *t stays where it is. */
struct view_source training_views_source(struct training_views *t);

struct training {
	struct scene scene;
	struct text text;
	struct query query;		   /* what stands for its sentences, where they are not its words */
	size_t sentences;		   /* R training sentences with words, packed from text */
	size_t left_out;		   /* training sentences without words */
	int64_t *offsets;		   /* (R+1) */
	int width;			   /* of a word */
	float *words;			   /* (offsets[R], width) */
	int *objects;			   /* (R) numbers of the objects */
	const char **refs, **object_names; /* (R) owned by text */
	struct training_views views;	   /* training views that have masks */
	struct supervision masks;
	size_t test_masks;    /* masks of test views, not used */
	size_t pairs;	      /* (view, sentence) pairs to learn from */
	struct lifted lifted; /* for a warm start; else empty */
	uint32_t checksum;    /* of everything that training depends on but its options */
};

/* What to read. */
struct training_files {
	const char *scene, *weights, *text, *masks;
	const char *lifted; /* NULL: no warm start */
};

/* Of the options: what stands for a sentence. */
int training_read(struct training *t, const struct training_files *from, const struct trainer_options *o,
	const struct report *to, struct err *e);
/* What a checkpoint of it is of. */
struct checkpoint_of training_identity(
	const struct training *t, const struct training_files *from, const struct trainer_options *o);
/* What a trainer learns from; referred to. */
struct trainer_source training_source(struct training *t, const struct row_views_room *room);
void training_free(struct training *t);

/* Writes the model that was learned. *options: how, but for the number of steps and the precision. */
int training_write(const struct training *t, const struct trainer *learned, const struct trainer_options *o,
	enum precision precision, const char *path, const char *options, long long seed, struct err *e);

/* The masks that a training learns from, and with them its views. formats/scene/training.md. */

/* Fills t->masks and, of the training views that they name, in the order in which they do, t->views,
 * t->weights and t->cameras. The scene has been read. Returns 0, or -1 with *e set. */
int training_read_masks(
	struct training *t, const char *weights, const char *path, const struct report *to, struct err *e);

/* One stage of training, from files to the model: reads, goes on from a checkpoint, takes the steps, logs
 * them, writes. refer-train. formats/scene/training.md. */

struct learning_options {
	struct training_files from;
	const char *output;		   /* the model; "-" is stdout */
	const char *log;		   /* NULL: none */
	const char *checkpoint_path;	   /* NULL: none */
	int is_resumed;			   /* go on from the checkpoint, if there is one */
	enum precision precision;	   /* of the model */
	long long iterations;		   /* steps */
	long long checkpoint;		   /* one every so many steps; 0: never */
	const volatile sig_atomic_t *stop; /* not 0: to be left after this step, with a checkpoint */
	long long memory;		   /* MiB for the views' weights */
	struct trainer_options trainer;
};

struct learning {
	const struct learning_options *options;
	struct training data;
	struct trainer trainer;
	struct file_out claim; /* of the model, as long as it is learnt */
	char *scratch;	       /* where weights go that memory has no room for: row_views_room's path */
	struct trainlog log;
	struct divergence divergence;
	struct checkpoint_of of;
	int is_stopped; /* by options->stop: *e of learn says after which step */
	int is_own;	/* the checkpoint is of this training */
	char note[64];	/* the latest losses */
};

/* *l is zeroed before. Returns 0, or -1 with *e set; after either learning_free is in order. The checkpoint
 * goes when the model is written. Where it is stopped it ends with -1 and a checkpoint, unless none is wanted
 * or the loss is too high for one. */
int learn(struct learning *l, const struct learning_options *options, const struct report *to, struct err *e);
void learning_free(struct learning *l);
