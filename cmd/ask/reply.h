/* The reply to a question, to a question about a distance, or to a place in a view: refer-ask. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "cmd/ask/asking.h"
#include "lang/question_kinds.h"
#include "talk/talk.h"

#include <stdio.h>

/* A picture of an answer: the scene in the view that shows it best, the things tinted and outlined, and words
 * below. */

struct answer_drawn {
	const struct camera *view; /* which to draw; NULL: it is found */
	int low[2], high[2]; /* column and row: the rectangle around the things, where high > low; high is
				outside */
};

/* Writes a PNG that appears whole, with two lines of words. The view that is found is the one in which the
 * things cover most, where things that the picture's edge cuts count half. Returns 0, or -1 with *e set. */
int answer_picture(const struct asking *a, const struct asking_answer *answer, const char *const words[2],
	const char *path, struct answer_drawn *drawn, struct err *e);

/* The mask of things, seen as one, in a view, where they are at its time: answer_all of that view. */
struct answer_calls;
int answer_mask(const struct asking *a, const size_t *things, size_t count, const struct camera *view,
	const struct answer_calls *calls, struct err *e);

/* How a thing could be called: the shortest description by which the scene's own choice finds it again. */

enum { CALLING_TEXT = 256 };

struct calling {
	char text[CALLING_TEXT]; /* "the red mug to the left of the plate"; "": none is found again */
	double probability;	 /* that it means the thing */
};

/* Tries, and asks each as a question: the noun; the name; with a colour or a size; superlatives; the position
 * beside a neighbour whose name no other thing has; both. Of the first of these kinds with a description that
 * means this object alone, at least as likely as not, the likeliest. centres (objects), which may be NULL,
 * gets where all objects are as seen from the viewpoint. Returns 0, or -1 with *e set. */
int calling_find(struct asking *a, size_t object, struct calling *to, double (*centres)[3],
	const struct report *report, struct err *e);

/* How far two things are apart. */
struct distance {
	double gap, centres; /* between the boxes, 0 where they touch, and between their centres */
};

/* Answers of refer-ask for a person or a program to read. */

struct answer_told {
	const struct asking *asking;
	const char *question;		/* or the place in a view where a thing was picked */
	char understood[QUESTION_TEXT]; /* the question, with what its words point back to */
	struct question_asked asked;
	const struct asking_answer *answer;
	int is_yes, is_unsure; /* of a question of yes or no; where another thing is as likely */
	long number;	       /* of kinds that count */
	char value[256];       /* the answer of kinds that do not ask for a thing: "two", "black and grey" */
	int is_verbose;	       /* words say where and how large the things are */
	int is_picked;
	struct calling calling;	   /* of what was picked */
	struct distance distance;  /* of QUESTION_DISTANCE */
	const char *picture;	   /* that was made of it; NULL: none */
	struct answer_drawn drawn; /* what is in the picture */
};

/* Answers t->asked: t->is_yes, t->is_unsure, t->value and t->distance, and the things as `found`, which
 * t->answer is. Returns 0, or -1 with *e set; asking_answer_free after either. */
int kinds_answer(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e);

/* What the things of an answer look like, in words: "black and grey", "steel, shiny", "not known". Cut
 * to fit. */
void answer_looks(const struct answer_told *t, int is_colour, char *to, size_t room);

/* Whether a thing has the one look that the second part of the question asks of it: a colour
 * (lang/colours.h), or what sentences say that it is made of. */
enum answer_look { LOOK_NONE /* asks for no such look */, LOOK_NO, LOOK_YES, LOOK_UNTOLD };
enum answer_look answer_look(const struct answer_told *t, size_t thing);

/* A line for each thing, or for a distance, or one that says why there is none; after the explanation, where
 * there is one. */
int answer_put_words(const struct answer_told *t, FILE *out, struct err *e);

/* A JSON object on one line. refer-ask(1) lists its keys. Both return 0, or -1 with *e. */
int answer_put_json(const struct answer_told *t, FILE *out, struct err *e);

/* Whether the answer is no, none, or that nothing is meant. */
int answer_is_no(const struct answer_told *t);

/* A length of the scene as a person says it: "21 cm", "1.35 m", or, where nobody said what a unit is, its
 * number. Returns text. */
enum { LENGTH_TEXT = 32 };
const char *answer_length(const struct asking *a, double x, char text[LENGTH_TEXT]);

/* The shortest answer, for a caption: "kettle 97%, bottle 92%", or "nothing here". Cut to fit. */
void answer_caption(const struct answer_told *t, char *to, size_t room);

/* The thing under a pixel, or in a box, of a view: refer-ask --point and --box. */

/* Answers "VIEW:x,y" or, with is_box, "VIEW:x0,y0,x1,y1", in pixels of the view at its full size from the
 * left and the top: *view gets the view. Of a pixel, an object's probability is its share of the pixel's
 * blend weight; of a box, how much of the box is the object times how much of the object is in it, as a part
 * of the sum over all objects. One object is meant, or none where no object's mask is there. ERR_USAGE where
 * text names no place in a view. Returns 0, or -1 with *e set; asking_answer_free after either. */
int picking_find(const struct asking *a, const char *text, int is_box, struct asking_answer *answer,
	const struct camera **view, struct err *e);

struct reply_options {
	const char *point, *box; /* places in views that are asked about in place of a question; NULL */
	const char *picture;	 /* file to draw to; NULL: none */
	int is_verbose;
};

/* *told becomes the reply to what is asked, with found as its answer, and is drawn where anything is found.
 * talk may be NULL: nothing was spoken of. Returns 0, or -1 with *e set (ERR_USAGE: a place is at fault);
 * asking_answer_free(found) after either. */
int reply_make(struct answer_told *told, struct asking_answer *found, struct asking *a, const char *question,
	struct talk *talk, const struct reply_options *o, const struct report *to, struct err *e);
