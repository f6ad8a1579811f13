/* The files of a view that feature_maps reads: their tables of features, and which row each pixel has. */
#ifndef CMD_FEATURE_FEATURE_TABLES_H
#define CMD_FEATURE_FEATURE_TABLES_H

#include "cmd/feature/feature_maps.h"

/* How many channels the view's features have; 0 for labels. Returns 0, or -1 with *e. */
int feature_tables_channels(const struct feature_maps *m, size_t view, size_t *channels, struct err *e);

/* Opens s->table, and s->raw (height,width) gets the row of each pixel, of *rows. Returns 0, or -1 with *e.
 */
int feature_tables_open(const struct feature_maps *m, size_t view, int height, int width,
	struct feature_sources *s, size_t *rows, struct err *e);

#endif
