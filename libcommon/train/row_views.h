/* The training views with weights over rows (field/rows.h): in memory as far as they have room there, the
 * others in a file without a name. What is learned does not depend on where they are. */
#pragma once

#include "base/err.h"
#include "base/scratch.h"
#include "field/rows.h"
#include "train/train.h"
#include "train/view_source.h"

#include <omp.h>

/* Room for the weights, and where they go that have none. */
struct row_views_room {
	size_t bytes;	  /* of memory; the weights that are in use are there in any case */
	const char *path; /* scratch's */
};

struct row_views {
	size_t n;
	struct train_view *views;   /* (n) the source's; those in the file have no arrays */
	struct scratch_part *parts; /* (n) of the file */
	struct file_map *maps;	    /* (n) */
	size_t kept, filed;	    /* bytes in memory; how many views are in the file */
	double weights;		    /* of all views */
	struct scratch file;
	omp_lock_t lock; /* of the one view of the file that is in memory */
};

/* Reads each view of the source once, some of them at a time. Returns 0, or -1 with *e set; free after
 * either. */
int row_views_make(struct row_views *r, const struct rows *rows, const struct view_source *from,
	const struct row_views_room *room, struct err *e);
void row_views_free(struct row_views *r);

/* They as a source. One view of the file is open at a time, others wait for it: a thread that has one open
 * must not open another. */
struct view_source row_views_source(struct row_views *r);

/* Has the system read a view that is needed soon. */
void row_views_ahead(const struct row_views *r, size_t view);
