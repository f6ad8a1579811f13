/* proposed.safetensors (refer.regions): the tree of regions of a scene. formats/scene/proposed.md. */
#pragma once

#include "base/err.h"
#include "formats/arrays/fingerprint.h"
#include "propose/region_tree.h"

struct regions_file {
	struct region_tree tree;
	float *score; /* (tree.n) finite, at least 0 */
	size_t chosen_count;
	int32_t *chosen; /* (chosen_count) the regions that are likely things, the best first */
	size_t class_count;
	char **classes; /* (class_count) a detector's words */
	float *votes;	/* (chosen_count,class_count) how far it finds each chosen region to be that, in [0,1]
			 */
	struct fingerprint scene;
};

/* Returns 0, or -1 with *e set and nothing to free. */
int regions_file_read(struct regions_file *r, const char *path, struct err *e);
void regions_file_free(struct regions_file *r);

int regions_file_write(const struct regions_file *r, const char *path, const char *options, struct err *e);
