/* Views to learn from whose weights are in memory, or are read when they are needed. */
#pragma once

#include "base/err.h"
#include "train/train.h"

struct view_source {
	const struct train_view *views; /* (n) weights that are read have their sizes here, and no arrays */
	size_t n;
	/* Gives a view's weights, which stay until close. By many threads at a time, each with another view.
	 * NULL where all are in memory. */
	int (*open)(void *context, size_t view, struct view_weights *w, struct err *e);
	void (*close)(void *context, size_t view);
	void *context;
	size_t largest; /* bytes of the largest view that is read */
};

/* A view's weights, until view_source_close. Returns 0, or -1 with *e set. */
int view_source_open(const struct view_source *s, size_t view, struct view_weights *w, struct err *e);
void view_source_close(const struct view_source *s, size_t view);
