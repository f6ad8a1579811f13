/* The objects that sentences name, lifted onto the Gaussians from their masks: what refer-lift reads, which
 * mask is of which object, and the model that comes of it. formats/scene/lifted.md. */
#pragma once

#include "ask/disambiguate.h"
#include "base/err.h"
#include "base/names.h"
#include "base/report.h"
#include "formats/records/masks.h"
#include "formats/encoders/parser_weights.h"
#include "formats/scene/proposed.h"
#include "formats/scene/scene.h"
#include "formats/scene/text.h"
#include "lift/lift_objects.h"
#include "mask/mask_index.h"

struct lifting_files {
	const char *scene, *weights, *text, *masks;
	const char *spare;   /* masks of regions that an object may have in place of its own; NULL: none */
	const char *regions; /* of pseudomask-propose, in place of weights and masks; NULL: those are given */
};

#define LIFTING_NONE ((size_t)-1)

struct lifting {
	const struct lifting_files *files;
	struct scene scene;
	struct text text;
	struct masks set;
	size_t own;			       /* the first of them; the others are of spare regions */
	struct mask_index index;	       /* by object */
	size_t *views, view_capacity;	       /* (set.n) of each mask */
	size_t *sentence_object, *mask_object; /* (text.n), (set.n) in names; LIFTING_NONE: does not count */
	struct names refs, objects_of;	       /* of the sentences; of `trained` */
	const char **trained;		       /* (text.n) objects of the training sentences, else NULL */
	char *is_fixed;			       /* (objects + spare) a person named it, or all are as masked */
	struct disambiguated *found;	       /* (objects) what the sentences say of each */
	char *is_shown;	       /* (text.n) by a mask, at the first training sentence of an object */
	size_t objects, spare; /* spare regions are the objects after the others */
	/* (objects + spare) of the sentences, in the order in which these name them, then ""; not owned */
	const char **names;
	char *is_there; /* (scene.cameras.n) the view has weights */
	struct lift_objects lift;
	struct lifted model; /* what comes of it */
	struct regions_file regions;
	struct parser_weights weights;
};

/* Reads the files, and finds the objects: those that a training sentence names and a mask of a training view
 * shows. Warns of what is left out. *l is zeroed before; *files stays the caller's. Returns 0, or -1 with *e
 * set; after either lifting_free is in order. */
int lifting_read(
	struct lifting *l, const struct lifting_files *files, const struct report *to, struct err *e);

/* Lifts them: l->model. Objects with a mask without a score, which a person drew, and with is_as_masked all,
 * are where their masks are, and warnings tell which sentences say otherwise. Of the others that look alike,
 * each is where its sentences say; a warning tells which changed places for that, and *moved how many. */
int lifting_make(struct lifting *l, int is_as_masked, size_t *moved, const struct report *to, struct err *e);

/* In place of it where files have regions: each object is one of these, which all sentences together say. */
int lifting_name(struct lifting *l, const struct report *to, struct err *e);

/* Gives l->model, which has `objects` and its Gaussians, the names and training sentences. */
int lifting_add_sentences(struct lifting *l, struct err *e);

void lifting_free(struct lifting *l);
