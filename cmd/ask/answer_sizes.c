/* How large a thing is. */
#include "cmd/ask/answering.h"

#include <math.h>

static const struct box *box_of(const struct answer_told *t, size_t object)
{
	return &t->asking->model.extents[object].turned;
}

/* The part of a thing's height that may be hidden at its foot, of what is seen of it. */
static const double hidden = 0.4;

static double foot_of(const struct answer_told *t, size_t object)
{
	return box_of(t, object)->centre[2] - box_of(t, object)->half[2];
}

/* What all stand on, *ground, which the lowest foot tells; and where a thing's own foot is: on that, or on
 * the top of what is below it, as what is close to it hides the lowest Gaussians. */
static double find_foot(const struct answer_told *t, size_t object, double *ground)
{
	const struct box *own = box_of(t, object);
	const double foot = foot_of(t, object);
	double under = -INFINITY;

	*ground = foot;
	for (size_t o = 0; o < t->asking->model.lifted.objects; o++) {
		const struct box *b = box_of(t, o);
		const double top = b->centre[2] + b->half[2];
		if (!t->asking->model.extents[o].n)
			continue;
		*ground = fmin(*ground, foot_of(t, o));
		if (o != object && top < own->centre[2] &&
			hypot(own->centre[0] - b->centre[0], own->centre[1] - b->centre[1]) <
				fmax(b->half[0], b->half[1]))
			under = fmax(under, top);
	}
	under = fmin(fmax(under, *ground), foot);
	return foot - under < 2 * hidden * own->half[2] ? under : foot;
}

double answering_length(const struct answer_told *t, size_t object, enum question_kind kind)
{
	const struct box *own = box_of(t, object);
	double ground;
	const double foot = find_foot(t, object, &ground), height = own->centre[2] + own->half[2] - foot;

	if (kind == QUESTION_HEIGHT) /* above the table, of what stands on something else */
		return t->asked.relation == PARSE_ABOVE && foot - ground > height / 4 ? foot - ground
										      : height;
	if (kind == QUESTION_WIDTH)
		return 2 * fmax(own->half[0], own->half[1]);
	return cbrt(4 * own->half[0] * own->half[1] * height);
}

const char *answering_length_name(enum question_kind kind)
{
	return kind == QUESTION_HEIGHT ? "height" : kind == QUESTION_WIDTH ? "width" : "size";
}

/* Nothing is measured of a thing that has no Gaussians. */
void answering_need_boxes(const struct answer_told *t, struct asking_answer *found)
{
	for (size_t k = 0; k < found->count; k++)
		if (!t->asking->model.extents[found->things[k]].n) {
			snprintf(found->reason, sizeof found->reason, "nothing is seen of %.200s",
				t->asking->model.lifted.names[found->things[k]]);
			found->count = 0;
		}
}

void answering_say_size(struct answer_told *t)
{
	const struct asking *a = t->asking;
	const size_t thing = t->answer->things[0];
	const double own = answering_length(t, thing, t->asked.kind), *half = box_of(t, thing)->half;
	char text[3][LENGTH_TEXT];
	size_t like = ASKING_NONE;
	double least = INFINITY;

	for (size_t o = 0; o < a->model.lifted.objects; o++) {
		const double off = fabs(log(answering_length(t, o, t->asked.kind) / own));
		if (o != thing && a->model.extents[o].n && off < least) {
			like = o;
			least = off;
		}
	}
	if (t->asked.kind == QUESTION_SIZE)
		answering_say(t, "%s x %s x %s high", answer_length(a, 2 * half[0], text[0]),
			answer_length(a, 2 * half[1], text[1]),
			answer_length(a, answering_length(t, thing, QUESTION_HEIGHT), text[2]));
	else
		answering_say(t, "%s %s", answer_length(a, own, text[0]),
			t->asked.kind == QUESTION_HEIGHT ? "high" : "wide");
	if (like != ASKING_NONE)
		answering_say(t, ", %.2g times the %s of %s", own / answering_length(t, like, t->asked.kind),
			answering_length_name(t->asked.kind), a->model.lifted.names[like]);
}
