/* Sentences (JSON Lines). formats/records/sentences.md. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"

struct sentence {
	char *ref;	     /* unique in the file */
	char *object;	     /* what the sentences of one target share; "" where several are meant, or none */
	int has_objects;     /* 1: it says which objects it means */
	size_t object_count; /* of those; 0: it means nothing that is there */
	char **objects;
	char *view;   /* the view whose picture it is said of; NULL: of no one picture */
	char *kind;   /* what is hard about it ("negation"); NULL: not said */
	char *text;   /* UTF-8 */
	int has_when; /* what it says is so from when[0] to when[1], in a scene that moves */
	double when[2];
	enum camera_split split; /* "train" (default) or "test" */
	size_t view_count;	 /* 0: every view */
	char **views;
};

struct sentences {
	size_t n;
	struct sentence *items;
};

/* "-" is stdin. Errors: "path:LINE: reason" (duplicate ref, missing key, bad split, bad UTF-8). */
int sentences_read(struct sentences *s, const char *path, struct err *e);
/* The same, or plain text: where the first byte begins no JSON, each line that is not blank is a test
 * sentence, and its number is its ref. */
int sentences_read_any(struct sentences *s, const char *path, struct err *e);
/* Appends a training sentence; copies. 0, or -1 with *e. */
int sentences_add(struct sentences *s, const char *ref, const char *object, const char *text, struct err *e);
void sentences_free(struct sentences *s);
