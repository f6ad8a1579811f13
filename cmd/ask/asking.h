/* A lifted scene that is asked one question after the other, with everything loaded once: refer-ask. */
#pragma once

#include "ask/choose.h"
#include "base/err.h"
#include "base/report.h"
#include "cmd/ask/explain.h"
#include "cmd/run/anymodel.h"
#include "cmd/text/encode.h"
#include "formats/scene/scene.h"

/* The files of a folder that pipelines/lift.mk made, by their usual places. */

struct run_folder {
	char *scene, *model, *encoder;
	char *labels; /* a model of what a person named, beside `model`; NULL: none */
};

/* The scene, RUN/scene; the lifted models, RUN/lifted/model.safetensors and, of refer-serve,
 * RUN/lifted/labels.safetensors, of which one may be missing; and the encoder, encoder_default's; but for
 * those of `given` that are not NULL. Copies. ERR_SYSTEM where the folder or one of them is not there: the
 * message says what makes it. With may_be_nameless no model is fine: NULL. Returns 0, or -1 with *e set;
 * run_folder_free after either. */
int run_folder_find(struct run_folder *f, const char *run, const struct run_folder *given,
	int may_be_nameless, struct err *e);
void run_folder_free(struct run_folder *f);

struct asking_options {
	const char *run;	   /* the folder */
	struct run_folder given;   /* files in place of the folder's */
	const char *viewpoint;	   /* VIEW or x,y,z; NULL: the usual one */
	const char *camera;	   /* a file of one camera that is not in the scene; NULL: none */
	const double *time;	   /* of a scene that moves; NULL: its first */
	const char *without;	   /* PART,... as choose_without takes it; may be NULL */
	double least;		   /* a question less likely to mean anything is refused ... */
	int is_always;		   /* ... or, of one thing that is not asked to be there, guessed */
	int is_explained, is_json; /* explanations are JSON, else lines of text */
	int may_be_nameless;	   /* no lifted model is a model of no objects */
};

struct asking {
	const struct asking_options *options;
	struct run_folder files;
	struct scene scene;
	struct anymodel model;
	struct encoder encoder;
	struct parser parser;
	struct choose_scene of;
	struct chooser *chooser;
	struct viewpoint from;
	struct cameras given;  /* the one of options->camera; else none */
	struct encoding ahead; /* questions that were encoded before they are asked; asking_expect */
};

/* Reads all; *a is zeroed before and may not move after. Returns 0, or -1 with *e set (ERR_USAGE: an option
 * is at fault); after either asking_close. */
int asking_open(struct asking *a, const struct asking_options *options, struct err *e);
void asking_close(struct asking *a);

/* A file of one camera that is not in the scene, brought into its frame: a->given, in place of an earlier
 * one. Returns 0, or -1 with *e set and a->given as it was. */
int asking_read_camera(struct asking *a, const char *path, struct err *e);

/* Sentence r of a text as the choice takes it, said from there. */
struct choose_sentence asking_sentence(const struct text *t, size_t r, struct viewpoint from);

#define ASKING_NONE ((size_t)-1)

struct asking_answer {
	size_t count, *things; /* the objects that are meant, likeliest first; 0: refused */
	size_t runner_up;      /* the likeliest other object; ASKING_NONE */
	size_t unclear[2];     /* two things of which the question's one anchor may be either; ASKING_NONE */
	int is_anchor_unknown; /* nothing here is known as what a place is told by */
	size_t unknown;	       /* words of it that say something, and nothing of any object */
	int is_motion;	       /* it says something of motion: */
	enum motion_kind motion;     /* how the thing moves; MOTION_NONE: not said */
	double when[2];		     /* from when to when things move so */
	double there;		     /* P that the question means anything that is here */
	int is_by_purpose;	     /* what the thing is for told */
	int is_guess;		     /* it would be refused but for is_always */
	double *probability;	     /* (objects) that each is meant, or one of those meant */
	char reason[EXPLAIN_REASON]; /* of a refusal */
	double (*centres)[3];	     /* (objects) to the right, away and up, as seen from the viewpoint */
	double *holds; /* (objects) the least that any part of the question but its noun gives the object, in
			  [0,1] */
	/* What the choice knows of the objects; gone with the asking. NULL: nothing was asked */
	const struct arrangement *places;
	const struct vocabulary *words;
	char *explained; /* of explain_meaning; NULL where it was not asked for */
};

/* Encodes what questions that are about to be answered ask for, all at once, which takes less time than one
 * by one. No answer changes, and nothing is said: what goes wrong is said when the question is asked. */
void asking_expect(struct asking *a, const char *const *questions, size_t n);

/* Answers a question; warns where it is too long for the encoder. With is_all, of one thing that is asked for
 * all that fit are meant. asking_answer_free after either. */
int asking_ask(struct asking *a, const char *question, int is_all, struct asking_answer *answer,
	const struct report *to, struct err *e);
/* An answer of nothing, as asking_ask begins with: 0, or -1 with *e set. asking_answer_free after either. */
int asking_answer_make(struct asking_answer *answer, size_t objects, struct err *e);
void asking_answer_free(struct asking_answer *answer);

/* The view of that name, the given camera among them; NULL where there is none. */
const struct camera *asking_view(const struct asking *a, const char *name);
