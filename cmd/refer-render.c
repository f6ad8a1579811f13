/* refer-render: the masks of sentences in any view, from a trained model. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/masks.h"
#include "formats/model.h"
#include "formats/pictures.h"
#include "formats/scene.h"
#include "formats/text.h"
#include "refer/answer.h"
#include "refer/calibrate.h"
#include "refer/respond.h"
#include "splat/render.h"

#include <stdlib.h>
#include <string.h>

enum { SPLIT_ALL = 2 };

static struct {
	const char *scene, *text, *model, *views, *refs;
	struct pictures pictures;
	int split, sentences, is_plain, size[2];
	double scale; /* 0: not given */
} options = {.split = SPLIT_TEST, .sentences = SPLIT_ALL};

static const struct cli_option table[] = {
	{"scene", 0, CLI_STRING, &options.scene, "SCENE", "scene folder of gs-import (required)", 0, 0},
	{"text", 0, CLI_STRING, &options.text, "TEXT", "sentences encoded by text-encode (required)", 0, 0},
	{"model", 0, CLI_STRING, &options.model, "MODEL", "model of refer-train (required)", 0, 0},
	{"split", 0, CLI_CHOICE, &options.split, "train|test|all", "which views (default test)", 0, 0},
	{"views", 0, CLI_STRING, &options.views, "NAME,...", "these views instead of a split", 0, 0},
	{"sentences", 0, CLI_CHOICE, &options.sentences, "train|test|all", "which sentences (default all)", 0,
		0},
	{"refs", 0, CLI_STRING, &options.refs, "REF,...", "these sentences instead of a split", 0, 0},
	{"calibration", 0, CLI_CHOICE, &options.is_plain, "peak|none",
		"peak (default): lift a sentence's responses until its best are clearly above 0; none: as trained",
		0, 0},
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

/* What is rendered from. */
struct run {
	struct scene scene;
	struct text text;
	struct model model;
	struct rows rows; /* of the model, in the scene */
	size_t ref_count, view_count;
	char *chosen; /* of the views, then of the sentences: which a list names */
	size_t *refs; /* indices in text */
	const struct camera **views;
	float *responses; /* (ref_count,N), as render_pack has them */
	double *lifts;	  /* (ref_count) */
	struct file_out out;
	struct cli_progress progress;
};

static int choose_views(struct run *r, const struct cli *c, struct err *e)
{
	const struct cameras *from = &r->scene.cameras;
	struct list_name name;

	r->chosen = mem_zalloc(from->n, 1, "views", e);
	r->views = mem_alloc(from->n, sizeof *r->views, "views", e);
	if (!r->chosen || !r->views)
		return -1;
	if (options.views && cameras_mark(from, options.views, r->chosen, &name))
		cli_usage(c, "--views: no view '%.*s'", (int)name.length, name.text);
	for (size_t i = 0; i < from->n; i++)
		if (options.views ? r->chosen[i]
				  : options.split == SPLIT_ALL || (int)from->views[i].split == options.split)
			r->views[r->view_count++] = &from->views[i];
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
	if (options.refs && text_mark(&r->text, options.refs, r->chosen, &name))
		cli_usage(c, "--refs: no sentence '%.*s'", (int)name.length, name.text);
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
		model_read(&r->model, options.model, e))
		return -1;
	if (r->model.scene_gaussians != r->scene.splats.n)
		return err_set(e, ERR_FORMAT, "%s: is of a scene of %zu Gaussians, %s has %zu",
			file_name(options.model), r->model.scene_gaussians, options.scene, r->scene.splats.n);
	if (r->model.layout.text_width != r->text.width)
		return err_set(e, ERR_FORMAT, "%s: is of sentences of width %d, %s has %d",
			file_name(options.model), r->model.layout.text_width, file_name(options.text),
			r->text.width);
	if (choose_views(r, c, e) || choose_refs(r, c, e))
		return -1;
	if (!r->view_count)
		cli_warn(c, "%s: no view in this split", options.scene);
	if (!r->ref_count)
		cli_warn(c, "%s: no sentence in this split", file_name(options.text));
	r->responses = mem_alloc(r->ref_count, r->scene.splats.n * sizeof(float), "responses", e);
	r->lifts = mem_zalloc(r->ref_count, sizeof *r->lifts, "responses", e);
	if (!r->responses || !r->lifts)
		return -1;
	if (model_rows(&r->model, r->scene.splats.means, &r->rows, e))
		return -1;
	const struct respond_model m = {&r->model.layout, r->model.similarity, &r->rows, r->model.features,
		r->model.parameters, r->scene.splats.means, r->model.low, r->model.high};
	if (respond_all(&m, r->text.offsets, r->text.words, r->refs, r->ref_count, r->responses, e) ||
		render_pack(r->responses, r->scene.splats.n, (int)r->ref_count, e))
		return -1;
	if (!options.is_plain)
		return calibrate(&r->scene.splats, &r->scene.cameras, &r->rows, r->responses, r->ref_count,
			r->lifts, e);
	return 0;
}

/* One mask: its record and pictures. */
static int put_mask(void *data, const struct answer *a, FILE *out, struct err *e)
{
	const struct run *r = data;
	const size_t sentence = r->refs[a->sentence];
	const struct camera *c = a->camera;
	struct mask_record record = {.view = c->name,
		.ref = r->text.refs[sentence],
		.object = r->text.objects[sentence],
		.score = a->score};
	const struct picture picture = {c->name, record.ref, c->height, c->width, a->image, a->mask, a->rgb};
	int bad = rle_encode(&record.mask, a->mask, c->height, c->width, e) || masks_put(out, &record, e) ||
		  pictures_put(&options.pictures, &picture, e);

	rle_free(&record.mask);
	return bad ? -1 : 0;
}

static void put_view(void *data, size_t view, const char *records)
{
	struct run *r = data;

	fputs(records, r->out.stream);
	cli_progress_step(&r->progress, (double)view + 1, NULL);
}

static int render(struct run *r, struct err *e)
{
	const struct answer_question q = {
		&r->scene.splats, r->responses, r->lifts, r->ref_count, options.pictures.overlays != NULL};
	const struct answer_calls calls = {r, put_mask, put_view};
	struct camera *cameras = mem_alloc(r->view_count, sizeof *cameras, "views", e);
	int bad = cameras ? 0 : -1;

	for (size_t i = 0; i < r->view_count && !bad; i++) {
		int width = options.size[0], height = options.size[1];
		if (!width)
			camera_scaled_size(r->views[i], options.scale ? options.scale : 1, &width, &height);
		bad = rle_check_size(height, width, e);
		if (bad)
			err_prefix(e, r->views[i]->name);
		cameras[i] = camera_resize(r->views[i], width, height);
	}
	bad = bad || answer_all(&q, cameras, r->view_count, &calls, e) ? -1 : 0;
	free(cameras);
	return bad;
}

static int run(struct run *r, const struct cli *c, struct err *e)
{
	if (load(r, c, e) || file_out_open(&r->out, c->output, e))
		return -1;
	cli_progress_start(&r->progress, c, "views", (double)r->view_count);
	int bad = render(r, e);
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
	if (!strcmp(options.text, "-") && !strcmp(options.model, "-"))
		cli_usage(&c, "--text and --model cannot both be stdin");
	if (options.size[0] && options.scale)
		cli_usage(&c, "--size and --scale do not go together");
	int bad = run(&r, &c, &e);
	scene_free(&r.scene);
	text_free(&r.text);
	model_free(&r.model);
	rows_free(&r.rows);
	free(r.chosen);
	free(r.refs);
	free(r.views);
	free(r.responses);
	free(r.lifts);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
