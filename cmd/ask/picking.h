/* The thing under a pixel, or in a box, of a view: refer-ask --point and --box. */
#ifndef CMD_ASK_PICKING_H
#define CMD_ASK_PICKING_H

#include "base/err.h"
#include "cmd/ask/asking.h"

/* Answers "VIEW:x,y" or, with is_box, "VIEW:x0,y0,x1,y1", in pixels of the view at its full size from the
 * left and the top: *view gets the view. Of a pixel, an object's probability is its share of the pixel's
 * blend weight; of a box, how much of the box is the object times how much of the object is in it, as a part
 * of the sum over all objects. One object is meant, or none where no object's mask is there. ERR_USAGE where
 * text names no place in a view. Returns 0, or -1 with *e set; asking_answer_free after success. */
int picking_find(const struct asking *a, const char *text, int is_box, struct asking_answer *answer,
	const struct camera **view, struct err *e);

#endif
