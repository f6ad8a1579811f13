/* Which colour is what in a painted photograph: the file of names of mask-import. */
#ifndef CMD_MASKS_PAINTING_NAMES_H
#define CMD_MASKS_PAINTING_NAMES_H

#include "base/err.h"

#include <stddef.h>
#include <stdint.h>

/* One line of the file of names: "#c81e1e kettle", or "3 kettle" for the grey or the number of 16 bits. */
struct painting_name {
	uint32_t colour; /* as png_read_paint has it */
	char *name;
	int is_seen; /* in a picture */
};

struct painting_names {
	size_t n, capacity;
	struct painting_name *items;
};

/* Errors: "path:LINE: reason". No colour and no name twice. Returns 0, or -1 with *e; free after
 * either. */
int painting_names_read(struct painting_names *names, const char *path, struct err *e);
void painting_names_free(struct painting_names *names);

/* The name of a colour, or NULL. */
const struct painting_name *painting_names_find(const struct painting_names *names, uint32_t colour);

#endif
