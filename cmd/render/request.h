/* What refer-render and refer-locate have in common: a scene, encoded sentences about it, a model, and what
 * the model answers to the sentences that were chosen. */
#pragma once

#include "answer/responses.h"
#include "base/err.h"
#include "cmd/run/anymodel.h"
#include "formats/scene/scene.h"
#include "formats/scene/text.h"
#include "lift/lifted_model.h"
#include "places/viewpoint.h"

#include <cjson/cJSON.h>

/* Beside SPLIT_TRAIN and SPLIT_TEST. */
enum { REQUEST_ALL = 2 };

struct request_options {
	const char *scene, *text, *model; /* files */
	int sentences;			  /* of which split; REQUEST_ALL */
	const char *refs;		  /* NAME,...: these sentences instead; NULL: of the split */
	int is_plain;			  /* trained models: responses as they are, not calibrated */
	double least;			  /* lifted models: see answer/responses.h, */
	const char *without;		  /* and PART,... as choose_without takes it; may be NULL */
	int wants_parts;		  /* and answer/responses.h */
	const char *viewpoint;		  /* VIEW or x,y,z; NULL: each sentence's own */
	const double *time; /* of a scene that moves; NULL: its first, or that of what is drawn */
};

#define REQUEST_DEFAULTS                                                                                     \
	{                                                                                                    \
		.sentences = REQUEST_ALL, .least = RESPONSES_LEAST                                           \
	}

/* Rows of a tool's table of options (cli/cli.h), for a struct request_options o. */
#define REQUEST_FILES(o)                                                                                     \
	CLI_TEXT("scene", &(o).scene, "SCENE", "scene folder of gs-import (required)"),                      \
		CLI_TEXT("text", &(o).text, "TEXT", "sentences encoded by text-encode (required)"),          \
		CLI_TEXT("model", &(o).model, "MODEL", "model of refer-train or refer-lift (required)")
#define REQUEST_SENTENCES(o)                                                                                 \
	CLI_ONE_OF("sentences", &(o).sentences, "train|test|all", "which sentences (default all)"),          \
		CLI_TEXT("refs", &(o).refs, "REF,...", "these sentences instead of a split")

struct request {
	const struct request_options *options;
	struct scene scene;
	struct text text;
	struct anymodel model;
	size_t count, *refs; /* (count) the sentences, as indices in text */
	unsigned parts;	     /* of choose() */
	struct responses responses;
	struct parser_memo memo; /* for views of other times */
};

/* Reads the files. *r is zeroed before; options stay the caller's. All return 0, or -1 with *e set, ERR_USAGE
 * where an option is at fault; after any request_free is in order. */
int request_read(struct request *r, const struct request_options *options, struct err *e);

/* Which sentences: r->refs. There may be none. */
int request_choose(struct request *r, struct err *e);

/* --viewpoint, which must have been given. */
int request_viewpoint(const struct request *r, struct viewpoint *from, struct err *e);

/* The answers to the sentences, in place of earlier ones. from: where all are said; NULL: each at its own
 * view, or the usual one. */
int request_answer(struct request *r, const struct viewpoint *from, struct err *e);

void request_free(struct request *r);

/* What a sentence's record says that it means, and whether an answer is that. */

/* The names that a sentence's record has for what it means; cJSON_Delete. NULL where it says nothing. */
cJSON *meant_names(const struct text *t, size_t sentence);

/* 1 where things, objects of a model, are called what is meant, and no others are among them, 0 where they
 * are not, -1 where nothing is said (meant is NULL) or the model does not have all that is meant. */
int meant_is(const cJSON *meant, const struct lifted *l, const size_t *things, size_t count);

/* out: of the request's sentence i, with the score that its mask has, what was answered: the names of a
 * lifted model's things, and whether they are the ones that the sentence's record names, where the model
 * knows these. What has no room is cut. */
void overlay_words(const struct request *r, size_t i, double score, char *out, size_t size);
