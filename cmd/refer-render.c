/* refer-render: the masks of sentences in any view, from a model. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/jobs/anymodel.h"
#include "formats/masks.h"
#include "cmd/jobs/pictures.h"
#include "formats/scene.h"
#include "formats/text.h"
#include "refer/answer.h"
#include "refer/asked.h"
#include "ask/choose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SPLIT_ALL = 2 };

static struct {
	const char *scene, *text, *model, *views, *refs, *without;
	unsigned parts;
	struct pictures pictures;
	int split, sentences, is_plain, is_amodal, size[2];
	const char *viewpoint; /* "each": the view that is rendered */
	double scale;	       /* 0: not given */
	double least;
} options = {.split = SPLIT_TEST, .sentences = SPLIT_ALL, .least = ASKED_LEAST};

static const struct cli_option table[] = {
	{"scene", 0, CLI_STRING, &options.scene, "SCENE", "scene folder of gs-import (required)", 0, 0},
	{"text", 0, CLI_STRING, &options.text, "TEXT", "sentences encoded by text-encode (required)", 0, 0},
	{"model", 0, CLI_STRING, &options.model, "MODEL", "model of refer-train or refer-lift (required)", 0,
		0},
	{"split", 0, CLI_CHOICE, &options.split, "train|test|all", "which views (default test)", 0, 0},
	{"views", 0, CLI_STRING, &options.views, "NAME,...", "these views instead of a split", 0, 0},
	{"sentences", 0, CLI_CHOICE, &options.sentences, "train|test|all", "which sentences (default all)", 0,
		0},
	{"refs", 0, CLI_STRING, &options.refs, "REF,...", "these sentences instead of a split", 0, 0},
	{"calibration", 0, CLI_CHOICE, &options.is_plain, "peak|none",
		"peak (default): lift a sentence's responses until its best are clearly above 0; none: as trained",
		0, 0},
	{"min-probability", 0, CLI_REAL, &options.least, "P",
		"lifted models: a sentence less likely to mean anything gets no mask (default 0.65)", 0, 1},
	{"without", 0, CLI_STRING, &options.without, "PART,...",
		"lifted models: choose without words, names, knowledge, alike, colours, sizes, relations, except or sentence",
		0, 0},
	{"viewpoint", 0, CLI_STRING, &options.viewpoint, "VIEW|x,y,z|each",
		"lifted models: where sentences are said; each: in every view that is rendered (default: the view that a sentence names, else between the training views)",
		0, 0},
	{"amodal", 0, CLI_FLAG, &options.is_amodal, NULL,
		"outlines of whole objects as if nothing hid them, and the share in sight", 0, 0},
	{"size", 0, CLI_SIZE, &options.size, "WxH", "size of the masks (default: the view's)", 1, 65536},
	{"scale", 0, CLI_REAL, &options.scale, "S", "size of the masks as a share of the view's (default 1)",
		1e-4, 16},
	{"png", 0, CLI_STRING, &options.pictures.masks, "DIR", "write masks as DIR/VIEW/REF.png", 0, 0},
	{"response", 0, CLI_STRING, &options.pictures.responses, "DIR",
		"write response maps as DIR/VIEW/REF.png or .npy", 0, 0},
	{"response-type", 0, CLI_CHOICE, &options.pictures.is_npy, "png|npy",
		"png (default): 16 bits, 65535 times the sigmoid of the response; npy: the response", 0, 0},
	{"overlay", 0, CLI_STRING, &options.pictures.overlays, "DIR",
		"draw masks over the scene's colours as DIR/VIEW/REF.png", 0, 0},
	{0}};

static const struct cli_tool tool = {.name = "refer-render",
	.operands = "--scene SCENE --text TEXT --model MODEL",
	.summary = "Render the masks of sentences in any view of a scene.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT};

/* What a view shows of an answer, until the views before it are written. */
struct shown {
	struct rle mask;
	double score, visible;
};

/* What is rendered from. */
struct run {
	struct scene scene;
	struct text text;
	struct anymodel model;
	struct asked asked;
	size_t ref_count, view_count;
	char *chosen;	       /* of the views, then of the sentences: which a list names */
	size_t *refs;	       /* indices in text */
	struct camera *views;  /* at the size of the masks */
	size_t first;	       /* of the views: the first that is rendered now */
	struct splats *wholes; /* (answers) for --amodal */
	struct shown *shown;   /* (view_count,answers) */
	struct file_out out;
	struct cli_progress progress;
};

static int choose_views(struct run *r, struct err *e)
{
	const struct cameras *from = &r->scene.cameras;

	r->chosen = mem_zalloc(from->n, 1, "views", e);
	r->views = mem_alloc(from->n, sizeof *r->views, "views", e);
	if (!r->chosen || !r->views)
		return -1;
	if (options.views && cameras_mark(from, options.views, "--views", r->chosen, e))
		return -1;
	for (size_t i = 0; i < from->n; i++) {
		const struct camera *view = &from->views[i];
		int width = options.size[0], height = options.size[1];
		if (options.views ? !r->chosen[i]
				  : options.split != SPLIT_ALL && (int)view->split != options.split)
			continue;
		if (!width)
			camera_scaled_size(view, options.scale ? options.scale : 1, &width, &height);
		if (rle_check_size(height, width, e))
			return err_prefix(e, view->name);
		r->views[r->view_count++] = camera_resize(view, width, height);
	}
	return 0;
}

static int choose_refs(struct run *r, const struct cli *c, struct err *e)
{
	struct list_name name;

	free(r->chosen);
	r->chosen = mem_zalloc(r->text.n, 1, "sentences", e);
	r->refs = mem_alloc(r->text.n, sizeof *r->refs, "sentences", e);
	if (!r->chosen || !r->refs)
		return -1;
	if (options.refs && text_mark(&r->text, options.refs, "--refs", r->chosen, e))
		return -1;
	if (choose_without(options.without, &options.parts, &name))
		cli_usage(c, "--without: no part '%.*s'", (int)name.length, name.text);
	for (size_t i = 0; i < r->text.n; i++)
		if (options.refs ? r->chosen[i]
				 : options.sentences == SPLIT_ALL ||
					   (int)r->text.splits[i] == options.sentences)
			r->refs[r->ref_count++] = i;
	return 0;
}

static int load(struct run *r, const struct cli *c, struct err *e)
{
	if (scene_read(&r->scene, options.scene, e) || text_read(&r->text, options.text, e) ||
		anymodel_read(&r->model, options.model, e) || choose_views(r, e) || choose_refs(r, c, e))
		return -1;
	if (!r->view_count || !r->ref_count)
		cli_warn(c, "%s: no %s in this split",
			r->view_count ? file_name(options.text) : options.scene,
			r->view_count ? "sentence" : "view");
	return 0;
}

static void free_answers(struct run *r)
{
	for (size_t k = 0; r->wholes && k < r->asked.answers; k++)
		splats_free(&r->wholes[k]);
	free(r->wholes);
	r->wholes = NULL;
	asked_free(&r->asked);
}

/* What all sentences mean, said from a viewpoint or each from its own. */
static int answer(struct run *r, const struct viewpoint *from, struct err *e)
{
	const struct anymodel_ask ask = {&r->scene, &r->text, options.model, options.scene, options.text,
		r->refs, r->ref_count, !options.is_plain, options.parts, options.least, from};

	free_answers(r);
	int bad = anymodel_answer(&r->model, &ask, &r->asked, e) ||
		  !(r->wholes = mem_zalloc(r->asked.answers, sizeof *r->wholes, "objects", e));
	if (!bad && options.is_amodal)
		bad = asked_wholes(&r->asked, &r->scene.splats, &r->scene.cameras, r->wholes, e);
	return bad ? -1 : 0;
}

/* One answer: its mask, and the pictures of all sentences that it is the answer to. */
static int put_answer(void *data, const struct answer *a, struct err *e)
{
	const struct run *r = data;
	struct shown *to = &r->shown[a->view * r->asked.answers + a->answer];
	const struct camera *c = a->camera;
	int bad = rle_encode(&to->mask, a->mask, c->height, c->width, e);

	to->score = a->score;
	to->visible = a->visible;
	for (size_t i = 0; i < r->ref_count && !bad; i++) {
		const struct picture picture = {
			c->name, r->text.refs[r->refs[i]], c->height, c->width, a->image, a->mask, a->rgb};
		if (r->asked.answer[i] == a->answer)
			bad = pictures_put(&options.pictures, &picture, e);
	}
	return bad;
}

static int put_view(void *data, size_t view, struct err *e)
{
	struct run *r = data;
	struct shown *shown = r->shown + view * r->asked.answers;
	int bad = 0;

	for (size_t i = 0; i < r->ref_count && !bad; i++) {
		const struct shown *from = &shown[r->asked.answer[i]];
		const size_t sentence = r->refs[i];
		double score = from->score;
		if (r->asked.sure)
			score = rle_area(&from->mask) ? r->asked.sure[i] : 0;
		const struct mask_record record = {r->views[r->first + view].name, r->text.refs[sentence],
			(char *)text_object(&r->text, sentence), score, from->mask, from->visible};
		bad = masks_put(r->out.stream, &record, e);
	}
	for (size_t k = 0; k < r->asked.answers; k++)
		rle_free(&shown[k].mask);
	cli_progress_step(&r->progress, (double)(r->first + view) + 1, NULL);
	return bad;
}

/* The views from r->first on. */
static int render(struct run *r, size_t views, struct err *e)
{
	const struct answer_question q = {&r->scene.splats, &r->asked, options.is_amodal ? r->wholes : NULL,
		options.pictures.overlays != NULL};
	const struct answer_calls calls = {r, put_answer, put_view};
	size_t count = r->asked.answers;

	if (mem_size(count, views, &count))
		return err_set(e, ERR_SYSTEM, "masks do not fit in memory");
	r->shown = mem_zalloc(count, sizeof *r->shown, "masks", e);
	int bad = !r->shown || answer_all(&q, r->views + r->first, views, &calls, e) ? -1 : 0;
	for (size_t i = 0; r->shown && i < count; i++)
		rle_free(&r->shown[i].mask);
	free(r->shown);
	return bad;
}

static int render_all(struct run *r, const struct viewpoint *from, struct err *e)
{
	int bad = 0;

	if (!options.viewpoint || strcmp(options.viewpoint, "each") != 0)
		return answer(r, options.viewpoint ? from : NULL, e) || render(r, r->view_count, e);
	for (r->first = 0; r->first < r->view_count && !bad; r->first++) {
		const struct viewpoint own = {.kind = VIEWPOINT_CAMERA, .camera = &r->views[r->first]};
		bad = answer(r, &own, e) || render(r, 1, e);
	}
	return bad;
}

static int run(struct run *r, const struct cli *c, struct err *e)
{
	struct viewpoint from;

	if (load(r, c, e))
		return -1;
	if (options.viewpoint && strcmp(options.viewpoint, "each") != 0 &&
		viewpoint_read(&from, options.viewpoint, &r->scene.cameras, r->scene.offset))
		cli_usage(c, "--viewpoint: '%s' is no view and no x,y,z", options.viewpoint);
	if (file_out_open(&r->out, c->output, e))
		return -1;
	cli_progress_start(&r->progress, c, "views", (double)r->view_count);
	int bad = render_all(r, &from, e);
	cli_progress_end(&r->progress);
	if (!bad)
		return file_out_commit(&r->out, e);
	file_out_abort(&r->out);
	return -1;
}

int main(int argc, char **argv)
{
	struct run r = {0};
	struct cli c;
	struct err e = {0};

	cli_parse(&c, &tool, argc, argv);
	if (!options.scene || !options.text || !options.model)
		cli_usage(&c, "--scene, --text and --model are required");
	cli_refuse_overwrite(
		&c, CLI_SCENE " text model", "output png:*.png response:*.png overlay:*.png", NULL);
	if (options.size[0] && options.scale)
		cli_usage(&c, "--size and --scale do not go together");
	int bad = run(&r, &c, &e);
	scene_free(&r.scene);
	text_free(&r.text);
	anymodel_free(&r.model);
	free_answers(&r);
	free(r.chosen);
	free(r.refs);
	free(r.views);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
