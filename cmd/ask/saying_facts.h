/* Of which objects of a lifted scene looks and relations hold, as its choice answers when asked of each. */
#pragma once

#include "base/rng.h"
#include "cmd/ask/asking.h"
#include "synth/wordings.h"

/* A look, or a relation to other objects. */
struct fact {
	const char *look;	      /* "red"; NULL: a relation */
	const struct synth_row *kind; /* of the relation */
	size_t anchors[2];	      /* the number of objects: none */
};

struct facts {
	struct asking *asking;
	size_t objects, looks, n, room, holds_room;
	struct fact *items;   /* (n) the looks first */
	double *holds;	      /* (n, objects) */
	double (*centres)[3]; /* (objects) to the right, away and up */
};

/* Returns 0, or -1 with *e set (memory); facts_free after either. */
int facts_make(struct facts *f, struct asking *a, struct err *e);
void facts_free(struct facts *f);

/* n facts more, each asked by its sentence ("the red thing"). Returns 0, or -1 with *e set. */
int facts_learn(struct facts *f, const struct fact *more, const char *const *texts, size_t n, struct err *e);

/* How far a fact holds of an object; a relation of its own anchors never. */
double facts_hold(const struct facts *f, const struct fact *one, size_t object);

/* A random relation that holds of an object, or plainly does not; NULL where none was met. */
const struct fact *facts_draw(const struct facts *f, size_t object, int is_true, struct rng *r);

/* The fact of a look; NULL where there is none. */
const struct fact *facts_look(const struct facts *f, const char *text);
