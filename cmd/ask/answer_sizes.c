/* How large a thing is. */
#include "cmd/ask/answering.h"

#include <math.h>

static const struct box *box_of(const struct answer_told *t, size_t object)
{
	return &t->asking->model.extents[object].turned;
}

/* How high a thing is above what the lowest stands on: its foot, or the top of what stands there. */
static double above_ground(const struct answer_told *t, size_t object)
{
	const struct box *own = box_of(t, object);
	const double foot = own->centre[2] - own->half[2];
	double ground = foot;

	for (size_t o = 0; o < t->asking->model.lifted.objects; o++)
		if (t->asking->model.extents[o].n)
			ground = fmin(ground, box_of(t, o)->centre[2] - box_of(t, o)->half[2]);
	return foot - ground > own->half[2] / 2 ? foot - ground : 2 * own->half[2];
}

double answering_length(const struct answer_told *t, size_t object, enum question_kind kind)
{
	const double *half = box_of(t, object)->half;

	if (kind == QUESTION_HEIGHT)
		return t->asked.relation == PARSE_ABOVE ? above_ground(t, object) : 2 * half[2];
	return 2 * (kind == QUESTION_WIDTH ? fmax(half[0], half[1]) : cbrt(half[0] * half[1] * half[2]));
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
			answer_length(a, 2 * half[1], text[1]), answer_length(a, 2 * half[2], text[2]));
	else
		answering_say(t, "%s %s", answer_length(a, own, text[0]),
			t->asked.kind == QUESTION_HEIGHT ? "high" : "wide");
	if (like != ASKING_NONE)
		answering_say(t, ", %.2g times the %s of %s", own / answering_length(t, like, t->asked.kind),
			answering_length_name(t->asked.kind), a->model.lifted.names[like]);
}
