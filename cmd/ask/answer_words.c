#include "cmd/ask/reply.h"

#include "base/number.h"
#include <math.h>

/* Where one object is, seen from another: by the axis along which their centres are farthest apart. */
static const char *side_of(const struct asking_answer *a, size_t object, size_t other)
{
	static const char *const sides[3][2] = {
		{"to the left of", "to the right of"}, {"in front of", "behind"}, {"below", "above"}};
	double most = 0;
	int axis = 0;

	for (int k = 0; k < 3; k++) {
		const double d = a->centres[object][k] - a->centres[other][k];
		if (fabs(d) > fabs(most)) {
			most = d;
			axis = k;
		}
	}
	return sides[axis][most > 0];
}

static void put_percent(FILE *out, double p)
{
	char text[NUMBER_SIZE];

	fputs(number_percent(text, p), out);
}

static void put_view(const struct answer_told *t, FILE *out)
{
	const struct answer_drawn *d = &t->drawn;

	if (!t->picture)
		return;
	fprintf(out, "; drawn in view %s", d->view->name);
	if (d->high[0] <= d->low[0])
		fputs(", where it is not in sight", out);
}

/* How it could be called. */
static void put_calling(const struct answer_told *t, FILE *out)
{
	if (!*t->calling.text) {
		fputs("; no description finds it", out);
		return;
	}
	fprintf(out, "; call it '%s' ", t->calling.text);
	put_percent(out, t->calling.probability);
}

static void put_thing(const struct answer_told *t, size_t object, FILE *out)
{
	const struct asking *a = t->asking;
	char **names = a->model.lifted.names;
	const struct box *b = &a->extents[object].turned;
	double distance;
	const size_t nearest = asking_nearest(a, object, &distance), second = t->answer->runner_up;

	fprintf(out, "%s: ", names[object]);
	put_percent(out, t->answer->probability[object]);
	if (second != ASKING_NONE) {
		fprintf(out, ", then %s ", names[second]);
		put_percent(out, t->answer->probability[second]);
	}
	if (nearest != ASKING_NONE)
		fprintf(out, "; %.3g %s %s", distance, side_of(t->answer, object, nearest), names[nearest]);
	if (a->extents[object].n)
		fprintf(out, "; centre %.3g %.3g %.3g, size %.3g x %.3g x %.3g high",
			b->centre[0] + a->scene.offset[0], b->centre[1] + a->scene.offset[1],
			b->centre[2] + a->scene.offset[2], 2 * b->half[0], 2 * b->half[1], 2 * b->half[2]);
	if (t->is_picked)
		put_calling(t, out);
	put_view(t, out);
	fputc('\n', out);
}

/* "0.31 apart", and what is between the centres. */
static void put_distance(const struct answer_told *t, FILE *out)
{
	const size_t *ends = t->answer->things;
	char **names = t->asking->model.lifted.names;

	for (int k = 0; k < 2; k++) {
		fprintf(out, k ? " to %s " : "%s ", names[ends[k]]);
		put_percent(out, t->answer->probability[ends[k]]);
	}
	if (t->distance.gap > 0)
		fprintf(out, ": %.3g between their boxes", t->distance.gap);
	else
		fputs(": their boxes touch", out);
	fprintf(out, ", %.3g between their centres", t->distance.centres);
	put_view(t, out);
	fputc('\n', out);
}

static int check_stream(FILE *out, struct err *e)
{
	return ferror(out) ? err_errno(e, "answer") : 0;
}

int answer_put_words(const struct answer_told *t, FILE *out, struct err *e)
{
	const struct asking_answer *a = t->answer;

	if (a->explained)
		explain_put(a->explained, out);
	if (a->explained && a->is_by_purpose)
		fputs("  answered by what the thing is for\n", out);
	if (!a->count)
		fprintf(out, "nothing here is that: %s\n", a->reason);
	if (t->distance.is_asked && a->count)
		put_distance(t, out);
	for (size_t k = 0; k < a->count && !t->distance.is_asked; k++)
		put_thing(t, a->things[k], out);
	return check_stream(out, e);
}

static cJSON *number(double x)
{
	return cJSON_CreateNumber(round(x * 1e4) / 1e4);
}

/* In the scene's unit, which may be anything: six digits. */
static cJSON *length(double x)
{
	char digits[64];

	snprintf(digits, sizeof digits, "%.6g", x);
	return cJSON_CreateRaw(digits);
}

static int add(cJSON *to, const char *key, cJSON *item)
{
	if (cJSON_AddItemToObject(to, key, item))
		return 1;
	cJSON_Delete(item);
	return 0;
}

static int add_vector(cJSON *to, const char *key, const double x[3])
{
	cJSON *list = cJSON_AddArrayToObject(to, key);
	int fine = list != NULL;

	for (int k = 0; k < 3 && fine; k++)
		fine = cJSON_AddItemToArray(list, length(x[k]));
	return fine;
}

static int add_name(cJSON *to, const struct answer_told *t, size_t object)
{
	return cJSON_AddStringToObject(to, "name", t->asking->model.lifted.names[object]) &&
	       add(to, "probability", number(t->answer->probability[object]));
}

static int add_place(cJSON *to, const struct answer_told *t, size_t object)
{
	const struct asking *a = t->asking;
	const struct box *b = &a->extents[object].turned;
	double centre[3], size[3], distance;
	const size_t nearest = asking_nearest(a, object, &distance);

	for (int k = 0; k < 3; k++) {
		centre[k] = b->centre[k] + a->scene.offset[k];
		size[k] = 2 * b->half[k];
	}
	if (a->extents[object].n && !(add_vector(to, "centre", centre) && add_vector(to, "size", size)))
		return 0;
	if (nearest == ASKING_NONE)
		return 1;
	cJSON *near = cJSON_AddObjectToObject(to, "nearest");
	return near && cJSON_AddStringToObject(near, "name", a->model.lifted.names[nearest]) &&
	       add(near, "distance", length(distance)) &&
	       cJSON_AddStringToObject(near, "side", side_of(t->answer, object, nearest));
}

static int add_things(cJSON *to, const struct answer_told *t)
{
	cJSON *list = cJSON_AddArrayToObject(to, "things");

	for (size_t k = 0; k < t->answer->count && list; k++) {
		const size_t object = t->answer->things[k];
		cJSON *one = cJSON_CreateObject();
		if (!cJSON_AddItemToArray(list, one) || !add_name(one, t, object) ||
			!add_place(one, t, object))
			return 0;
	}
	return list != NULL;
}

static int add_distance(cJSON *to, const struct answer_told *t)
{
	if (!t->distance.is_asked || !t->answer->count)
		return 1;
	cJSON *distance = cJSON_AddObjectToObject(to, "distance");
	return distance && add(distance, "gap", length(t->distance.gap)) &&
	       add(distance, "centres", length(t->distance.centres));
}

static int add_calling(cJSON *to, const struct answer_told *t)
{
	if (!t->is_picked || !*t->calling.text)
		return 1;
	cJSON *called = cJSON_AddObjectToObject(to, "called");
	return called && cJSON_AddStringToObject(called, "text", t->calling.text) &&
	       add(called, "probability", number(t->calling.probability));
}

/* The picture, and where in it the things are. */
static int add_picture(cJSON *to, const struct answer_told *t)
{
	const int *low = t->drawn.low, *high = t->drawn.high;

	if (!t->picture)
		return 1;
	if (!cJSON_AddStringToObject(to, "picture", t->picture) ||
		!cJSON_AddStringToObject(to, "view", t->drawn.view->name))
		return 0;
	if (high[0] <= low[0])
		return 1;
	return add(to, "pixels", cJSON_CreateIntArray((int[]){low[0], low[1], high[0], high[1]}, 4));
}

static int add_answer(cJSON *to, const struct answer_told *t)
{
	const struct asking_answer *a = t->answer;

	if (!cJSON_AddStringToObject(to, t->is_picked ? "picked" : "question", t->question) ||
		!cJSON_AddBoolToObject(to, "answered", a->count > 0) ||
		!add(to, "probability", number(a->there)) || !add_things(to, t))
		return 0;
	if (a->runner_up != ASKING_NONE) {
		cJSON *second = cJSON_AddObjectToObject(to, "runner_up");
		if (!second || !add_name(second, t, a->runner_up))
			return 0;
	}
	if (a->is_by_purpose && !cJSON_AddStringToObject(to, "by", "purpose"))
		return 0;
	if (!a->count && !cJSON_AddStringToObject(to, "reason", a->reason))
		return 0;
	if (!add_distance(to, t) || !add_calling(to, t) || !add_picture(to, t))
		return 0;
	return !a->explained || cJSON_AddItemReferenceToObject(to, "explanation", a->explained);
}

int answer_put_json(const struct answer_told *t, FILE *out, struct err *e)
{
	cJSON *all = cJSON_CreateObject();
	char *line = all && add_answer(all, t) ? cJSON_PrintUnformatted(all) : NULL;

	cJSON_Delete(all);
	if (!line)
		return err_set(e, ERR_SYSTEM, "answer: out of memory");
	fprintf(out, "%s\n", line);
	cJSON_free(line);
	return check_stream(out, e);
}

void answer_caption(const struct answer_told *t, char *to, size_t room)
{
	const struct asking_answer *a = t->answer;
	char percent[NUMBER_SIZE];
	size_t n = 0;

	snprintf(to, room, "nothing here is that");
	for (size_t k = 0; k < a->count && n < room; k++)
		n += (size_t)snprintf(to + n, room - n, "%s%s %s", k ? ", " : "",
			t->asking->model.lifted.names[a->things[k]],
			number_percent(percent, a->probability[a->things[k]]));
}
