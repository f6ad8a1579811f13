/* Questions, and what is at a place. */
#include "cmd/serve/serving.h"

#include "base/mem.h"
#include "cmd/text/questions.h"
#include "formats/records/json.h"

#include <math.h>

struct asked {
	struct question question;
	const char *from; /* a view or x,y,z; NULL: the usual viewpoint */
	char place[128];
	const char *conversation;      /* NULL: none */
	char key[QUESTION_MOST + 300]; /* of the answers that are kept; "": it is not */
	const char *point, *box;
	struct camera *ray; /* a camera of one pixel, in place of a view; NULL */
	struct serving_reply *to;
};

/* The conversation of that name, or a new one in the place of the one that was used least lately. */
static struct talk *find_talk(struct serving *s, const char *name)
{
	struct serving_talk *least = s->talks;

	for (struct serving_talk *t = s->talks; t < s->talks + SERVING_TALKS; t++) {
		if (!strcmp(t->name, name) && t->used) {
			least = t;
			break;
		}
		if (t->used < least->used)
			least = t;
	}
	if (!least->used || strcmp(least->name, name) != 0) {
		*least = (struct serving_talk){.talk = TALK_NEW};
		snprintf(least->name, sizeof least->name, "%s", name);
	}
	least->used = ++s->used;
	return &least->talk;
}

/* The answer as refer-ask --json prints it, with what a person reads as "words". */
static int put_answer(const struct answer_told *told, FILE *out, struct err *e)
{
	struct serving_text json, words;
	struct serving_reply got = {0}, said = {0};

	if (serving_text_open(&json, e))
		return -1;
	int bad = serving_text_end(&json, answer_put_json(told, json.out, e), &got, e) ||
		  serving_text_open(&words, e) ||
		  serving_text_end(&words, answer_put_words(told, words.out, e), &said, e);
	if (!bad) {
		while (said.length && said.bytes[said.length - 1] == '\n')
			said.bytes[--said.length] = 0;
		fwrite(got.bytes, 1, strrchr(got.bytes, '}') - got.bytes, out);
		fputs(",\"words\":", out);
		jsontext_quote(out, said.bytes);
		fputs("}\n", out);
	}
	mem_free_all(got.bytes, said.bytes);
	return bad;
}

static int set_viewpoint(struct asking *a, const char *from, struct err *e)
{
	a->from = (struct viewpoint){.kind = VIEWPOINT_USUAL};
	return from && viewpoint_read(&a->from, from, &a->scene.cameras, a->scene.offset)
		       ? err_set(e, ERR_CHECK, "from: '%s' is no view and no x,y,z", from)
		       : 0;
}

static int answer(struct serving *s, void *data, struct err *e)
{
	struct asked *q = data;
	struct asking *a = s->asking;
	const struct reply_options options = {.point = q->point, .box = q->box};
	SCOPED_BY(asking_answer_free) struct asking_answer found = {0};
	struct talk *talk = q->conversation ? find_talk(s, q->conversation) : NULL;
	struct answer_told told;
	struct serving_text text;

	if (!*q->question.text && !q->point && !q->box) {
		if (talk)
			*talk = (struct talk)TALK_NEW;
		*q->to = (struct serving_reply){"application/json", mem_strdup("{}\n", e), 3};
		return q->to->bytes ? 0 : -1;
	}
	if (set_viewpoint(a, q->from, e))
		return -1;
	if (q->ray)
		a->given = (struct cameras){1, q->ray};
	int bad = reply_make(&told, &found, a, q->question.text, talk, &options, &report_silent, e) ||
		  serving_text_open(&text, e);
	if (!bad)
		bad = serving_text_end(&text, put_answer(&told, text.out, e), q->to, e);
	if (!bad && *q->key)
		serving_remember(s, q->key, q->to);
	a->given = (struct cameras){0};
	if (bad && e->code == ERR_USAGE) /* a place that is in no view */
		e->code = ERR_FORMAT;
	return bad;
}

static int take_conversation(struct asked *q, const cJSON *body, struct err *e)
{
	if (json_string(body, "conversation", 0, &q->conversation, "request", e) < 0)
		return -1;
	if (q->conversation && strlen(q->conversation) > SERVING_TALK_NAME)
		return err_set(e, ERR_FORMAT, "request: key 'conversation' is longer than %d bytes",
			SERVING_TALK_NAME);
	return 0;
}

static int take_from(struct asked *q, const cJSON *body, struct err *e)
{
	const cJSON *from = json_member(body, "from");
	double at[3];

	if (!cJSON_IsArray(from))
		return json_string(body, "from", 0, &q->from, "request", e) < 0 ? -1 : 0;
	if (json_numbers(from, 3, at))
		return err_set(e, ERR_FORMAT, "request: key 'from' is no view and no three numbers");
	snprintf(q->place, sizeof q->place, "%.17g,%.17g,%.17g", at[0], at[1], at[2]);
	q->from = q->place;
	return 0;
}

int serving_ask(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e)
{
	struct asked q = {.to = to};
	struct serving_job job = {.run = answer, .data = &q, .e = e};
	const char *text;

	if (json_string(body, "question", 1, &text, "request", e) < 0 || take_conversation(&q, body, e) ||
		take_from(&q, body, e))
		return -1;
	if (text[strspn(text, " \t\r\n")] && !question_take(&q.question, text))
		return err_set(e, ERR_FORMAT, "the question %s", q.question.fault);
	if (*q.question.text)
		job.question = q.question.text;
	if (q.conversation)
		return serving_do(s, &job);
	const int length = snprintf(q.key, sizeof q.key, "%s\n%s", q.question.text, q.from ? q.from : "");
	if (length >= (int)sizeof q.key)
		*q.key = 0;
	const int found = *q.key ? serving_recall(s, q.key, to, e) : 0;
	return found ? (found < 0 ? -1 : 0) : serving_do(s, &job);
}

static char *print_place(const char *view, const double *x, int n, struct err *e)
{
	const size_t room = strlen(view) + 128;
	char *text = mem_alloc(room, 1, "place", e);

	if (text && n == 2)
		snprintf(text, room, "%s:%.6f,%.6f", view, x[0], x[1]);
	else if (text)
		snprintf(text, room, "%s:%.6f,%.6f,%.6f,%.6f", view, x[0], x[1], x[2], x[3]);
	return text;
}

/* A camera of one pixel that looks along a direction. */
static int make_ray(struct camera *c, const double origin[3], const double direction[3], struct err *e)
{
	const double length = hypot(hypot(direction[0], direction[1]), direction[2]);
	double rotation[3][3] = {{0}}, *right = rotation[0], *down = rotation[1], *ahead = rotation[2];
	int least = 0;

	if (!(length > 0))
		return err_set(e, ERR_FORMAT, "request: key 'direction' has no length");
	for (int k = 0; k < 3; k++) {
		ahead[k] = direction[k] / length;
		least = fabs(ahead[k]) < fabs(ahead[least]) ? k : least;
	}
	right[(least + 1) % 3] = -ahead[(least + 2) % 3];
	right[(least + 2) % 3] = ahead[(least + 1) % 3];
	const double across = hypot(right[(least + 1) % 3], right[(least + 2) % 3]);
	for (int k = 0; k < 3; k++)
		right[k] /= across;
	for (int k = 0; k < 3; k++)
		down[k] = ahead[(k + 1) % 3] * right[(k + 2) % 3] - ahead[(k + 2) % 3] * right[(k + 1) % 3];
	*c = (struct camera){
		.name = "here", .width = 1, .height = 1, .fx = 1000, .fy = 1000, .cx = .5, .cy = .5};
	camera_set_centre(c, rotation, origin);
	return 0;
}

int serving_pick(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e)
{
	struct asked q = {.to = to};
	struct serving_job job = {.run = answer, .data = &q, .e = e};
	double origin[3], direction[3], x[4];
	struct camera ray;
	SCOPED char *place = NULL;
	size_t view;

	if (json_member(body, "origin")) {
		if (json_matrix(body, "origin", 3, 0, origin, "request", e) ||
			json_matrix(body, "direction", 3, 0, direction, "request", e) ||
			make_ray(&ray, origin, direction, e))
			return -1;
		q.ray = &ray;
		q.point = "here:0,0";
		return serving_do(s, &job);
	}
	const int is_box = json_member(body, "box") != NULL;
	if (serving_view(s, body, "view", &view, e) ||
		(is_box ? json_matrix(body, "box", 4, 0, x, "request", e)
			: json_number(body, "x", 1, x, "request", e) < 0 ||
					json_number(body, "y", 1, x + 1, "request", e) < 0))
		return -1;
	if (!(place = print_place(s->cameras.views[view].name, x, is_box ? 4 : 2, e)))
		return -1;
	*(is_box ? &q.box : &q.point) = place;
	return serving_do(s, &job);
}
