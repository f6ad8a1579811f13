/* Photographs that a person painted over, a colour for each thing, or labelled, as masks: mask-import. */
#pragma once

#include "base/err.h"
#include "base/report.h"
#include "cmd/import/warping.h"
#include "formats/records/annotations.h"
#include "formats/records/masks.h"

#include <stdint.h>

/* Which colour is what in a painted photograph: the file of names of mask-import. */

/* One line of the file of names: "#c81e1e kettle", or "3 kettle" for the grey or the number of 16 bits. */
struct painting_name {
	uint32_t colour; /* as png_read_paint has it */
	char *name;
	int is_seen; /* in a picture */
};

struct painting_names {
	size_t n, capacity;
	struct painting_name *items;
	size_t written, nothing; /* masks that were, and those left out, whose names are of no thing */
};

/* Errors: "path:LINE: reason". No colour and no name twice. Returns 0, or -1 with *e; free after either. */
int painting_names_read(struct painting_names *names, const char *path, struct err *e);
void painting_names_free(struct painting_names *names);

/* Whether what is read is a painted picture, whose colours need names: neither labels nor records, by their
 * endings, nor a folder (formats/records/annotations.md). */
int painting_needs_names(const char *path);

/* A mask record for each label of a JSON file, for each record of a file of them, for each picture of a
 * folder of masks, and for each picture and name that has a pixel in it, pictures in their order, names in
 * the file's. The view is the picture's file name without its ending. Other colours are of nothing; warns of
 * those that cover much, and of names that no picture has. ERR_FORMAT where none has any. Masks are warped as
 * *w says. Writes to a file ("-": stdout). Returns 0, or -1 with *e set. */
int painting_write(struct painting_names *names, const char *const *pictures, size_t count, struct warping *w,
	const char *path, const struct report *to, struct err *e);

/* A folder of masks as pictures, DIR/VIEW/NAME.png, as mask-export --png writes it and as 3D-OVS has its
 * segmentations, or DIR/NAME/VIEW.png where names say so. formats/records/annotations.md. */

/* Called for each picture: its file, its view and what it is of, or NULL for both where colours say what.
 * Returns 0, or -1 with *e set. */
typedef int mask_tree_put(void *to, const char *path, const char *view, const char *name, struct err *e);

/* All pictures, by the names of folders and then of files; where the folder has a classes.txt, those of its
 * classes only. scene: whose views they are, or NULL. Warns of folders that are things', and of pictures
 * that are no PNG. Returns 0, or -1 with *e set: ERR_FORMAT where there is no picture. */
int mask_tree_each(const char *dir, const struct cameras *scene, mask_tree_put *put, void *to,
	const struct report *report, struct err *e);

/* What the parts of cmd/masks/painting.h share: painting_colours.c has pictures of colours. */

/* The record of a mask, which is freed. Where it goes: the lens's photograph to the view. What is called
 * "background" or the like is left out. */
int painting_put(struct painting_names *names, struct mask *mask, struct warping *w, const char *path,
	FILE *out, struct err *e);

/* A mask record for each colour of a picture that has a name. */
int painting_put_colours(struct painting_names *names, const char *path, struct warping *w, FILE *out,
	const struct report *to, struct err *e);

/* Takes the pixels of outlines that lie on larger ones away from these. */
int painting_layers(struct annotations *a, struct err *e);

/* ERR_FORMAT where pictures that are called the same in different folders are of one view. */
int painting_check_shared(const char *const *pictures, size_t count, struct err *e);

/* That error, of two files; always -1. */
int painting_two_pictures(const char *earlier, const char *later, const char *view, struct err *e);
