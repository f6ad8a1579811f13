#include "cmd/ask/answering.h"

#include "base/jsontext.h"
#include "base/number.h"

#include <math.h>
#include <string.h>

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

/* "brown box 91%", and, where it counts, how likely the next is. */
static void put_belief(const struct answer_told *t, size_t object, int with_next, FILE *out)
{
	char **names = t->asking->model.lifted.names;
	const size_t second = t->answer->runner_up;

	put_percent(out, t->answer->probability[object]);
	if (!with_next || second == ASKING_NONE)
		return;
	fprintf(out, ", then %s ", names[second]);
	put_percent(out, t->answer->probability[second]);
}

const char *answer_length(const struct asking *a, double x, char text[LENGTH_TEXT])
{
	if (!a->scene.is_metric)
		snprintf(text, LENGTH_TEXT, "%.3g", x);
	else if (fabs(x) < 0.995)
		snprintf(text, LENGTH_TEXT, "%.*f cm", fabs(x) < 0.0995, 100 * x);
	else
		snprintf(text, LENGTH_TEXT, "%.2f m", x);
	return text;
}

static void put_box(const struct answer_told *t, size_t object, FILE *out)
{
	const struct asking *a = t->asking;
	const struct box *b = &a->model.extents[object].turned;

	fprintf(out, "; centre %.3g %.3g %.3g, size %.3g x %.3g x %.3g high",
		b->centre[0] + a->scene.offset[0], b->centre[1] + a->scene.offset[1],
		b->centre[2] + a->scene.offset[2], 2 * b->half[0], 2 * b->half[1], 2 * b->half[2]);
}

/* "; from 0.3 to 0.6" */
static void put_when(const struct answer_told *t, FILE *out)
{
	if (t->answer->is_motion && t->answer->count && t->asked.kind != QUESTION_WHEN)
		fprintf(out, "; from %.4g to %.4g", t->answer->when[0], t->answer->when[1]);
}

static void put_thing(const struct answer_told *t, size_t object, FILE *out)
{
	const struct asking *a = t->asking;
	char **names = a->model.lifted.names;
	char length[LENGTH_TEXT];
	double distance;
	const size_t nearest = answering_nearest(a, object, &distance);

	fprintf(out, "%s: ", names[object]);
	if (nearest != ASKING_NONE)
		fprintf(out, "%s %s %s; ", answer_length(a, distance, length),
			answering_side(t->answer->centres[object], t->answer->centres[nearest]),
			names[nearest]);
	put_belief(t, object, 1, out);
	put_when(t, out);
	if (a->model.extents[object].n && t->is_verbose)
		put_box(t, object, out);
	if (t->is_picked)
		put_calling(t, out);
	put_view(t, out);
	fputc('\n', out);
}

static int is_yes_or_no(const struct answer_told *t)
{
	static const unsigned kinds = 1U << QUESTION_THERE | 1U << QUESTION_WHETHER | 1U << QUESTION_MORE |
				      1U << QUESTION_TALLY | 1U << QUESTION_EVEN | 1U << QUESTION_SAME;

	return !t->is_unsure && kinds >> t->asked.kind & 1;
}

int answer_is_no(const struct answer_told *t)
{
	return is_yes_or_no(t) ? !t->is_yes : !t->answer->count;
}

/* The length of a name without the number that tells it from others: "mug 2". */
static int kind_length(const char *name)
{
	const size_t n = strcspn(name, "0123456789"), rest = strlen(name + n);

	return (int)(n > 1 && rest && name[n - 1] == ' ' && strspn(name + n, "0123456789") == rest
			     ? n - 1
			     : n + rest);
}

/* Things by their names, where several of a kind are told apart by numbers together: "mug (3), plate". */
static void put_kinds(const struct answer_told *t, FILE *out)
{
	char **names = t->asking->model.lifted.names;
	const struct asking_answer *a = t->answer;
	const char *separator = ": ";

	for (size_t k = 0; k < a->count; k++) {
		const char *name = names[a->things[k]];
		const int length = kind_length(name);
		size_t first = a->count, n = 0;
		for (size_t i = 0; i < a->count; i++) {
			const char *other = names[a->things[i]];
			if (kind_length(other) != length || strncmp(other, name, (size_t)length) != 0)
				continue;
			first = n++ ? first : i;
		}
		if (first != k)
			continue;
		fprintf(out, n > 1 ? "%s%.*s (%zu)" : "%s%.*s", separator, length, name, n);
		separator = ", ";
	}
}

/* What was asked, then the things on one line: "two: brown box 91%, kettle 88%". */
static void put_value(const struct answer_told *t, const char *value, FILE *out)
{
	char **names = t->asking->model.lifted.names;
	const int is_list = t->asked.kind == QUESTION_LIST;

	fputs(value, out);
	if (is_list)
		put_kinds(t, out);
	for (size_t k = 0; k < t->answer->count && !is_list; k++) {
		fprintf(out, "%s%s ", k ? ", " : ": ", names[t->answer->things[k]]);
		put_belief(t, t->answer->things[k], 0, out);
	}
	put_when(t, out);
	if (answer_is_no(t) && *t->answer->reason)
		fprintf(out, "%s %s", t->answer->count ? ";" : ":", t->answer->reason);
	put_view(t, out);
	fputc('\n', out);
}

/* "the mug or the cup? 19% and 18%" */
static void put_choice(const struct answer_told *t, FILE *out)
{
	char **names = t->asking->model.lifted.names;
	const size_t ends[2] = {t->answer->things[0], t->answer->runner_up};

	fprintf(out, "%s or %s? ", names[ends[0]], names[ends[1]]);
	put_percent(out, t->answer->probability[ends[0]]);
	fputs(" and ", out);
	put_percent(out, t->answer->probability[ends[1]]);
	put_view(t, out);
	fputc('\n', out);
}

/* "0.31 apart", and what is between the centres. */
static void put_distance(const struct answer_told *t, FILE *out)
{
	const size_t *ends = t->answer->things;
	char **names = t->asking->model.lifted.names, length[LENGTH_TEXT];

	for (int k = 0; k < 2; k++) {
		fprintf(out, k ? " to %s " : "%s ", names[ends[k]]);
		put_percent(out, t->answer->probability[ends[k]]);
	}
	if (t->distance.gap > 0)
		fprintf(out, ": %s between their boxes", answer_length(t->asking, t->distance.gap, length));
	else
		fputs(": their boxes touch", out);
	fprintf(out, ", %s between their centres", answer_length(t->asking, t->distance.centres, length));
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
		fputs(a->explained, out);
	if (a->explained && a->is_by_purpose)
		fputs("  answered by what the thing is for\n", out);
	if (a->count && a->is_guess)
		fputs("a guess: ", out);
	const char *yes = t->is_yes ? "yes" : "no";
	const int is_counted = t->asked.kind == QUESTION_TALLY || t->asked.kind == QUESTION_EVEN;
	if (is_counted)
		fprintf(out, "%s, ", yes);
	if (t->is_unsure)
		put_choice(t, out);
	else if (is_yes_or_no(t) && !is_counted)
		put_value(t, yes, out);
	else if (*t->value)
		put_value(t, t->value, out);
	else if (!a->count)
		fprintf(out, "nothing here is that: %s\n", a->reason);
	else if (t->asked.kind == QUESTION_DISTANCE)
		put_distance(t, out);
	else
		for (size_t k = 0; k < a->count; k++)
			put_thing(t, a->things[k], out);
	return check_stream(out, e);
}

/* In the scene's unit, which may be anything: six digits. */
static void put_length(struct jsontext *to, const char *key, double x)
{
	char digits[64];

	snprintf(digits, sizeof digits, "%.6g", x);
	jsontext_raw(to, key, digits);
}

static void put_name(struct jsontext *to, const struct answer_told *t, size_t object)
{
	jsontext_string(to, "name", t->asking->model.lifted.names[object]);
	jsontext_rounded(to, "probability", t->answer->probability[object]);
}

static void put_place(struct jsontext *to, const struct answer_told *t, size_t object)
{
	const struct asking *a = t->asking;
	const struct extent *x = &a->model.extents[object];
	double distance;
	const size_t nearest = answering_nearest(a, object, &distance);

	for (int size = 0; size < 2 && x->n; size++) {
		jsontext_open(to, size ? "size" : "centre", '[');
		for (int k = 0; k < 3; k++)
			put_length(to, NULL,
				size ? 2 * x->turned.half[k] : x->turned.centre[k] + a->scene.offset[k]);
		jsontext_close(to, ']');
	}
	if (nearest == ASKING_NONE)
		return;
	jsontext_open(to, "nearest", '{');
	jsontext_string(to, "name", a->model.lifted.names[nearest]);
	put_length(to, "distance", distance);
	jsontext_string(to, "side", answering_side(t->answer->centres[object], t->answer->centres[nearest]));
	jsontext_close(to, '}');
}

static void put_things(struct jsontext *to, const struct answer_told *t)
{
	jsontext_open(to, "things", '[');
	for (size_t k = 0; k < t->answer->count; k++) {
		jsontext_open(to, NULL, '{');
		put_name(to, t, t->answer->things[k]);
		put_place(to, t, t->answer->things[k]);
		jsontext_close(to, '}');
	}
	jsontext_close(to, ']');
}

/* The picture, and where in it the things are. */
static void put_picture(struct jsontext *to, const struct answer_told *t)
{
	const int *low = t->drawn.low, *high = t->drawn.high;

	jsontext_string(to, "picture", t->picture);
	jsontext_string(to, "view", t->drawn.view->name);
	if (high[0] <= low[0])
		return;
	jsontext_open(to, "pixels", '[');
	for (int k = 0; k < 4; k++)
		jsontext_number(to, NULL, k < 2 ? low[k] : high[k - 2]);
	jsontext_close(to, ']');
}

int answer_put_json(const struct answer_told *t, FILE *out, struct err *e)
{
	const struct asking_answer *a = t->answer;
	struct jsontext j = {.out = out}, *to = &j;

	jsontext_open(to, NULL, '{');
	jsontext_string(to, t->is_picked ? "picked" : "question", t->question);
	if (!t->is_picked) {
		jsontext_string(to, "kind", question_name(t->asked.kind));
		if (strcmp(t->understood, t->question) != 0)
			jsontext_string(to, "understood", t->understood);
	}
	if (t->asking->scene.is_metric)
		jsontext_string(to, "unit", "m");
	jsontext_flag(to, "answered", a->count > 0);
	if (is_yes_or_no(t))
		jsontext_flag(to, "yes", t->is_yes);
	if (*t->value)
		jsontext_string(to, "value", t->value);
	if (t->asked.kind == QUESTION_NUMBER || t->asked.kind == QUESTION_LIST ||
		t->asked.kind == QUESTION_SURPLUS)
		jsontext_number(to, "number", (double)t->number);
	if (t->is_unsure)
		jsontext_flag(to, "unsure", 1);
	if (a->count && a->is_guess)
		jsontext_flag(to, "guess", 1);
	jsontext_rounded(to, "probability", a->there);
	put_things(to, t);
	if (a->is_motion && a->count) {
		jsontext_open(to, "when", '[');
		jsontext_number(to, NULL, a->when[0]);
		jsontext_number(to, NULL, a->when[1]);
		jsontext_close(to, ']');
	}
	if (a->runner_up != ASKING_NONE) {
		jsontext_open(to, "runner_up", '{');
		put_name(to, t, a->runner_up);
		jsontext_close(to, '}');
	}
	if (a->is_by_purpose)
		jsontext_string(to, "by", "purpose");
	if (answer_is_no(t) && *a->reason)
		jsontext_string(to, "reason", a->reason);
	if (t->asked.kind == QUESTION_DISTANCE && a->count == 2) {
		jsontext_open(to, "distance", '{');
		put_length(to, "gap", t->distance.gap);
		put_length(to, "centres", t->distance.centres);
		jsontext_close(to, '}');
	}
	if (t->is_picked && *t->calling.text) {
		jsontext_open(to, "called", '{');
		jsontext_string(to, "text", t->calling.text);
		jsontext_rounded(to, "probability", t->calling.probability);
		jsontext_close(to, '}');
	}
	if (t->picture)
		put_picture(to, t);
	if (a->explained)
		jsontext_raw(to, "explanation", a->explained);
	jsontext_close(to, '}');
	fputc('\n', out);
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
