/* What answers by the kind of question share. */
#pragma once

#include "cmd/ask/reply.h"

/* Adds to t->value. */
__attribute__((format(printf, 2, 3))) void answering_say(struct answer_told *t, const char *format, ...);

/* The same of a number: "none", "two". */
void answering_say_number(struct answer_told *t, size_t n);

/* All things of a phrase, as they are counted. Returns 0, or -1 with *e set. */
int answering_all(const struct answer_told *t, const char *phrase, struct asking_answer *found,
	struct asking *a, const struct report *to, struct err *e);

/* How many nouns the things' names have. */
size_t answering_count_kinds(const struct answer_told *t);

/* Of how many there are of two kinds of things, t->asked's: t->is_yes, t->number and t->value, and the things
 * as `found`. Returns 0, or -1 with *e set. */
int answering_counts(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e);

/* A question for a colour: of a thing, or of a part of it, where a sentence says what colour that has. */
int answering_colour(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e);

/* Whether the things are alike in t->asked's size or colour: t->is_yes. Likewise. */
int answering_same(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e);

/* The length that a kind of question is about: the height of a box, its longer side, or their mean; and its
 * name. */
double answering_length(const struct answer_told *t, size_t object, enum question_kind kind);
const char *answering_length_name(enum question_kind kind);

/* How large the thing is, and beside the other thing that is most like it in that. */
void answering_say_size(struct answer_told *t);

/* Nothing is measured of a thing that has no Gaussians. */
void answering_need_boxes(const struct answer_told *t, struct asking_answer *found);

/* Whether the one thing of an answer is no more likely than not, or another is nearly as likely. */
int answering_is_unsure(const struct asking_answer *a);

/* The two things of t->asked as `found`: of the ways to read it by the one in which both are likeliest. With
 * is_compared the one that is more so comes first and stays alone, and t->is_yes says whether it was the
 * first. */
int answering_pair(struct answer_told *t, struct asking_answer *found, struct asking *a, int is_compared,
	const struct report *to, struct err *e);

/* Whether a word of size or place is one that two things are compared by. */
int answering_is_comparable(int relation);

/* t->distance, of the two things that were found. */
void answering_measure_distance(struct answer_told *t);

/* The object whose box is nearest to that of an object, by their centres, and how far away that is;
 * ASKING_NONE where there is no other. */
size_t answering_nearest(const struct asking *a, size_t object, double *distance);

/* Where a thing is, seen from another: "behind", by the axis along which their centres, of an answer, are
 * farthest apart. */
const char *answering_side(const double centre[3], const double other[3]);
