/* What sentences of motion say, and whether that is so: judged for all objects by their ways in three values,
 * as synth/relations.h does. Inside synth/moves.h. */
#pragma once

#include "synth/moves.h"

struct teller {
	const struct synth_moves *m;
	int n;
	struct synth_wordings words, said; /* nouns and colours; of motion */
	struct rng rng;
	double centre[3], right[2], away[2]; /* the reference viewpoint */
};

/* What is said of one thing: 1 plainly true, -1 plainly false, 0 arguable; and when. */
struct finding {
	int is, first, last;
};

struct phrase {
	struct synth_sense sense;
	const struct synth_row *noun, *colour; /* NULL: not said */
};

struct draft {
	enum synth_list kind, event; /* event: of "while" and the like */
	int other;		     /* the object that is spoken of besides; -1 */
	struct phrase thing, about;
	int fits[SYNTH_MAX_OBJECTS]; /* verdicts on the words for the thing */
};

/* Whether object i does it, whatever the words for the thing. */
struct finding moves_judge(const struct teller *t, const struct draft *d, enum synth_list kind, int i);
