/* What refer-train reads, put together: scene, weights, text and masks, checked against each other.
 * formats/training.md. */
#ifndef FORMATS_TRAINING_H
#define FORMATS_TRAINING_H

#include "base/err.h"
#include "formats/scene.h"
#include "formats/text.h"
#include "formats/weights.h"
#include "refer/supervision.h"
#include "refer/trainer.h"

struct training {
	struct scene scene;
	struct text text;
	size_t sentences;		   /* R training sentences with words, packed from text */
	size_t left_out;		   /* training sentences without words */
	int64_t *offsets;		   /* (R+1) */
	float *words;			   /* (offsets[R], text.width) */
	int *objects;			   /* (R) numbers of the objects */
	const char **refs, **object_names; /* (R) owned by text */
	size_t view_count;		   /* training views that have masks */
	struct weights *weights;
	struct train_view *views;
	struct camera *cameras; /* of the views, at the size of their weights; names belong to scene */
	struct supervision masks;
	size_t test_masks; /* masks of test views, not used */
	size_t pairs;	   /* (view, sentence) pairs to learn from */
	size_t pixels;	   /* of the largest view */
	uint32_t checksum; /* of everything that training depends on but its options */
};

int training_read(struct training *t, const char *scene, const char *weights, const char *text,
	const char *masks, struct err *e);
/* What a trainer learns from; referred to. */
struct trainer_source training_source(const struct training *t);
void training_free(struct training *t);

#endif
