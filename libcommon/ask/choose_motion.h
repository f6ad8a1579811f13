/* What a sentence about a scene that moves says of motion: lang/motion_said.h, and the time that another
 * thing's motion tells, "before the cup falls". */
#pragma once

#include "ask/choose.h"
#include "ask/judge_motion.h"

/* p: the parse of the sentence, which becomes that of what it says besides. m->motion gets the rest, as the
 * judging of p takes it; m is judged, but of nothing that is of use. Returns 0, or -1 with *e set. */
int choose_motion(struct meaning *m, const struct choose_scene *scene, const struct parser *parser,
	const struct choose_sentence *s, struct parse *p, struct err *e);

/* The time of the motion of the objects that are chosen (O), from the first to the last: when. */
void choose_when(const struct motion_meaning *m, const char *chosen, double when[2]);
