/* Scores: what miou-score writes, as text, JSON or CSV. formats/records/scores.md. */
#ifndef FORMATS_SCORES_H
#define FORMATS_SCORES_H

#include "base/err.h"
#include "score/score_rows.h"

#include <stdio.h>

enum scores_form { SCORES_TEXT, SCORES_JSON, SCORES_CSV };

struct scores {
	struct score_row all;
	struct score_table objects;
	struct score_table relations, visibility; /* written where has_... */
	int has_relations, has_visibility;
	int is_compared;	     /* rows have their `other` */
	const struct bootstrap *how; /* rows have intervals; NULL: they have none */
};

/* Frees the tables. */
void scores_free(struct scores *s);

int scores_put(FILE *out, const struct scores *s, enum scores_form form, struct err *e);
/* The same into a file; "-" is stdout. */
int scores_write(const struct scores *s, const char *path, enum scores_form form, struct err *e);

#endif
