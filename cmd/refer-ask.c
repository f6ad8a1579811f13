/* refer-ask: what a question about a lifted scene means, in words. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/ask/reply.h"
#include "cmd/ask/asking.h"
#include "cmd/text/questions.h"
#include "answer/responses.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

/* Questions that wait together are encoded together: 200 of them take 5.3 s one by one, 3.5 by four, 3.0 by
 * 16 or 64 (one thread, 0.6 s of it loading). */
enum { AT_ONCE = 16 };
/* The exit status of one question where two things are as likely, or of a guess. */
enum { ASK_UNSURE = 5 };

static struct {
	struct asking_options asking;
	double time;
	struct reply_options reply;
} options = {.asking = {.least = RESPONSES_LEAST}, .time = NAN};

static const struct cli_option table[] = {
	CLI_TEXT("scene", &options.asking.given.scene, "SCENE", "scene folder (default: RUN/scene)"),
	CLI_TEXT("model", &options.asking.given.model, "MODEL",
		"model of refer-lift (default: RUN/lifted/model.safetensors)"),
	CLI_TEXT("encoder", &options.asking.given.encoder, "DIR",
		"the encoder's folder (default: where 'make encoder' puts it)"),
	CLI_TEXT("camera", &options.asking.camera, "FILE",
		"a camera that is not in the scene: a file of one, as gs-import takes them; questions are asked from there, and it is what --picture draws"),
	CLI_TEXT("point", &options.reply.point, "VIEW:x,y",
		"instead of a QUESTION: the thing under a pixel of a view, and how it could be called"),
	CLI_TEXT("box", &options.reply.box, "VIEW:x0,y0,x1,y1",
		"likewise the thing in a box, such as a detector draws"),
	CLI_TEXT("viewpoint", &options.asking.viewpoint, "VIEW|x,y,z",
		"where questions are asked: left and right are as seen from there (default: between the training views)"),
	{"time", 0, CLI_REAL, &options.time, "T",
		"of a scene that moves: where things are at this time (default: its first)", 0, 0},
	{"min-probability", 0, CLI_REAL, &options.asking.least, "P",
		"a question less likely to mean anything that is here is refused (default 0.5)", 0, 1},
	CLI_SWITCH("always", &options.asking.is_always,
		"what would be refused is answered by the likeliest thing, as a guess, with exit status 5"),
	CLI_TEXT("without", &options.asking.without, "PART,...",
		"choose without parts of the choice, as refer-render does"),
	CLI_SWITCH("explain", &options.asking.is_explained,
		"say how the question was taken apart, and what each part gave each candidate"),
	{"picture", 'o', CLI_STRING, &options.reply.picture, "FILE",
		"draw the answer, in the view that shows it best, as a PNG", 0, 0},
	{0}};

static const struct cli_tool tool = {.name = "refer-ask",
	.operands = "RUN [QUESTION]",
	.summary = "Ask a lifted scene where things are: QUESTION, or each line of stdin.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_JSON,
	.min_operands = 1,
	.max_operands = 2};

/* Answers one question, or what --point or --box name, at once. *status becomes ERR_CHECK where it means
 * nothing here, or the answer is no, and else ASK_UNSURE where another thing is as likely. */
static int answer(const struct cli *c, struct asking *a, const char *question, struct talk *talk, int *status,
	struct err *e)
{
	const double start = cli_seconds();
	SCOPED_BY(asking_answer_free) struct asking_answer found = {0};
	struct answer_told told;
	struct cli_report to;

	if (reply_make(&told, &found, a, question, talk, &options.reply, cli_report(&to, c), e))
		return -1;
	*status = answer_is_no(&told) ? ERR_CHECK : told.is_unsure || found.is_guess ? ASK_UNSURE : ERR_NONE;
	int bad = c->json ? answer_put_json(&told, stdout, e) : answer_put_words(&told, stdout, e);
	if (!bad && fflush(stdout))
		bad = err_errno(e, "stdout");
	cli_note(c, 1, "answered in %.3f s", cli_seconds() - start);
	return bad ? -1 : 0;
}

static void prompt(void)
{
	if (isatty(STDIN_FILENO) && isatty(STDERR_FILENO))
		fputs("> ", stderr);
}

/* The next question of stdin, and those that wait behind it: how many, 0 at the end, -1 with *e. */
static int take_questions(struct question to[AT_ONCE], struct questions *from, struct err *e)
{
	int n = 0, got;

	do {
		got = question_next(&to[n], from, e);
		n += got > 0;
	} while (got > 0 && n < AT_ONCE && question_waits(from));
	return got < 0 ? got : n;
}

static void expect(struct asking *a, const struct question *q, int n)
{
	const char *texts[AT_ONCE];
	size_t count = 0;

	for (int i = 0; i < n; i++)
		if (!q[i].fault)
			texts[count++] = q[i].text;
	asking_expect(a, texts, n > 1 ? count : 0);
}

/* *status becomes that of the worst. */
static int answer_line(const struct cli *c, struct asking *a, const struct question *q, struct talk *talk,
	int *status, struct err *e)
{
	int own = 0;

	if (q->fault) {
		fprintf(stderr, "%s: stdin:%ld: %s\n", tool.name, q->line, q->fault);
		*status = ERR_FORMAT;
		return 0;
	}
	if (q->is_first)
		*talk = (struct talk)TALK_NEW;
	if (answer(c, a, q->text, talk, &own, e))
		return -1;
	*status = *status ? *status : own ? ERR_CHECK : ERR_NONE;
	return 0;
}

/* Every line of stdin. */
static int answer_lines(const struct cli *c, struct asking *a, int *status, struct err *e)
{
	static struct question q[AT_ONCE];
	static struct questions from = {.fd = STDIN_FILENO};
	static struct talk talk = TALK_NEW;
	int n;

	for (prompt(); (n = take_questions(q, &from, e)) > 0; prompt()) {
		expect(a, q, n);
		for (int i = 0; i < n; i++)
			if (answer_line(c, a, &q[i], &talk, status, e))
				return -1;
	}
	return n;
}

static int ask(const struct cli *c, struct asking *a, int *status, struct err *e)
{
	struct question q = {0};

	if (c->operand_count > 1 && !question_take(&q, c->operands[1]))
		return err_set(e, ERR_FORMAT, "the question %s", q.fault);
	options.asking.time = isnan(options.time) ? NULL : &options.time;
	if (asking_open(a, &options.asking, e))
		return -1;
	cli_note(c, 1, "%zu objects, loaded in %.3f s", a->model.lifted.objects, cli_seconds() - c->start);
	const int is_one = c->operand_count > 1 || options.reply.point || options.reply.box;
	return is_one ? answer(c, a, q.text, NULL, status, e) : answer_lines(c, a, status, e);
}

static void check(const struct cli *c)
{
	const char *model = options.asking.given.model, *camera = options.asking.camera;
	const int has_place = options.reply.point || options.reply.box,
		  is_one = has_place || c->operand_count > 1;

	if ((options.reply.point && options.reply.box) || (has_place && c->operand_count > 1))
		cli_usage(c, "--point, --box and QUESTION do not go together");
	if (options.reply.picture && !is_one)
		cli_usage(c, "--picture needs a QUESTION");
	if (options.reply.picture && !strcmp(options.reply.picture, "-"))
		cli_usage(c, "--picture must name a file");
	if (model && !strcmp(model, "-") && !is_one)
		cli_usage(c, "--model - needs a QUESTION, as questions come from stdin");
	if (camera && !strcmp(camera, "-") && (!is_one || (model && !strcmp(model, "-"))))
		cli_usage(c, "--camera - and %s cannot both be stdin", is_one ? "--model" : "the questions");
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(asking_close) struct asking a = {0};
	int status = 0;

	(void)to;
	check(c);
	cli_refuse_overwrite(c,
		CLI_SCENE " model camera encoder:" ENCODER_PARTS " RUN:scene|lifted|*.safetensors", "picture",
		NULL);
	options.asking.run = c->operands[0];
	options.asking.is_json = c->json;
	options.reply.is_verbose = c->verbose;
	return ask(c, &a, &status, e) ? -1 : status;
}

int main(int argc, char **argv)
{
	return cli_main(&tool, argc, argv, run);
}
