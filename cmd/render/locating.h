/* Where the answers to sentences are, and of several things each by itself. */
#ifndef CMD_RENDER_LOCATING_H
#define CMD_RENDER_LOCATING_H

#include "answer/locate.h"
#include "cmd/render/request.h"

struct locating {
	struct request request;	 /* answered by the caller */
	struct located *answers; /* (answers) */
	struct extent *objects;	 /* of a lifted model, (O); NULL where no answer is of several */
};

/* up gets the direction that was taken for it. Returns 0, or -1 with *e set; locating_free is then in order.
 */
int locating_find(struct locating *r, double up[3], struct err *e);

/* A line for each sentence, formats/records/boxes.md; "-" is stdout. */
int locating_write(const struct locating *r, const char *path, struct err *e);

/* With its request. */
void locating_free(struct locating *r);

#endif
