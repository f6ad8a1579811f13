/* How large a thing is. */
#include "cmd/ask/answering.h"

#include "base/dot.h"

#include <math.h>

static const struct box *box_of(const struct answer_told *t, size_t object)
{
	return &t->asking->model.extents[object].turned;
}

/* The part of a thing's height that may be hidden at its foot, of what is seen of it. */
static const double hidden = 0.4;

/* How high a box's middle is: the third axis of all of them is up, wherever that is in the scene. */
static double level_of(const struct box *b)
{
	return dot(b->axes[2], b->centre, 3);
}

static double foot_of(const struct box *b)
{
	return level_of(b) - b->half[2];
}

/* How far the middles of two boxes are apart over the ground. */
static double aside_of(const struct box *a, const struct box *b)
{
	double d[3], along[2];

	for (int k = 0; k < 3; k++)
		d[k] = a->centre[k] - b->centre[k];
	for (int k = 0; k < 2; k++)
		along[k] = dot(a->axes[k], d, 3);
	return hypot(along[0], along[1]);
}

/* What all stand on: the lowest foot but one, as a cloth may hang over the edge, or the lowest of two things.
 */
static double find_ground(const struct answer_told *t)
{
	double lowest[2] = {INFINITY, INFINITY};

	for (size_t o = 0; o < t->asking->model.lifted.objects; o++) {
		const double foot = t->asking->model.extents[o].n ? foot_of(box_of(t, o)) : INFINITY;
		lowest[1] = fmin(lowest[1], fmax(lowest[0], foot));
		lowest[0] = fmin(lowest[0], foot);
	}
	return t->asking->model.lifted.objects > 2 && isfinite(lowest[1]) ? lowest[1] : lowest[0];
}

/* Where a thing's own foot is: on the ground, or on the top of what is below it, as what is close to it hides
 * the lowest Gaussians. */
static double find_foot(const struct answer_told *t, size_t object, double ground)
{
	const struct box *own = box_of(t, object);
	const double foot = foot_of(own);
	double under = ground;

	for (size_t o = 0; o < t->asking->model.lifted.objects; o++) {
		const struct box *b = box_of(t, o);
		const double top = level_of(b) + b->half[2];
		if (o != object && t->asking->model.extents[o].n && top < level_of(own) &&
			aside_of(own, b) < fmax(b->half[0], b->half[1]))
			under = fmax(under, top);
	}
	under = fmin(under, foot);
	return foot - under < 2 * hidden * own->half[2] ? under : foot;
}

double answering_length(const struct answer_told *t, size_t object, enum question_kind kind)
{
	const struct box *own = box_of(t, object);
	const double ground = find_ground(t), foot = find_foot(t, object, ground),
		     height = level_of(own) + own->half[2] - foot;

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
