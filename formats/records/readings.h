/* Readings of sentences to learn a parser from (JSON Lines). formats/records/readings.md. */
#ifndef FORMATS_READINGS_H
#define FORMATS_READINGS_H

#include "lang/reading_align.h"

#include <stddef.h>

struct reading_record {
	char *ref, *room; /* room may be NULL */
	struct reading reading;
};

struct reading_set {
	size_t n;
	struct reading_record *records;
};

int readings_read(struct reading_set *s, const char *path, struct err *e);
void readings_free(struct reading_set *s);
const struct reading_record *readings_find(const struct reading_set *s, const char *ref);

/* Which of `folds` parts a record is held out with: a room's all together. 0 where there are no folds. */
int readings_fold(const struct reading_record *r, long long folds);

#endif
