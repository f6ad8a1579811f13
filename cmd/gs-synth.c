/* gs-synth: a synthetic table-top benchmark, laid out as a person's own data would be. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/colmap.h"
#include "formats/masks.h"
#include "formats/ply.h"
#include "formats/png.h"
#include "synth/candidates.h"
#include "synth/cameras.h"
#include "synth/scene.h"
#include "synth/sentences.h"
#include "synth/truth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ATTEMPTS = 20 };

/* What is made, and the open outputs. */
struct job {
	struct cli cli;
	struct synth_options options;
	struct synth_scene scene;
	struct synth_detector detector;
	struct synth_sentence *sentences;
	struct file_out candidates, truth;
};

static int open_in(struct file_out *out, const char *dir, const char *name, struct err *e)
{
	char *path = file_join(dir, name, "", e);
	int bad = !path || file_out_open(out, path, e) ? -1 : 0;

	free(path);
	return bad;
}

/* Makes the folder of the photographs and tells each camera the name of its own. */
static int name_photographs(struct job *j, const char *dir, struct err *e)
{
	char *images = file_join(dir, "images", "", e);
	int bad = images ? 0 : -1;

	if (!bad && file_make_dir(images, e))
		bad = err_prefix(e, images);
	for (size_t i = 0; i < j->scene.cameras.n && !bad; i++) {
		struct camera *c = &j->scene.cameras.views[i];
		c->image = file_join(images, c->name, ".png", e);
		bad = c->image ? 0 : -1;
	}
	free(images);
	return bad;
}

static int write_model(struct job *j, const char *dir, struct err *e)
{
	static const double offset[3] = {0};
	char *ply = file_join(dir, "point_cloud.ply", "", e), *sparse = file_join(dir, "sparse/0", "", e);
	int bad = -1;

	if (ply && sparse && !ply_write(&j->scene.splats, offset, ply, e))
		bad = colmap_write_text(&j->scene.cameras, sparse, e);
	free(ply);
	free(sparse);
	return bad;
}

/* Texts, names and refs are made of letters, digits, commas, hyphens and spaces: JSON needs no escapes for
 * them. */
static int write_sentences(struct job *j, const char *dir, struct err *e)
{
	int n = j->scene.object_count * SYNTH_SENTENCES;
	struct file_out out = {0};

	if (open_in(&out, dir, "sentences.jsonl", e))
		return -1;
	for (int i = 0; i < n; i++) {
		const struct synth_sentence *s = &j->sentences[i];
		fprintf(out.stream, "{\"ref\":\"%s\",\"object\":\"%s\",\"text\":\"%s\",\"split\":\"%s\"}\n",
			s->ref, j->scene.objects[s->object].name, s->text,
			s->split == SPLIT_TEST ? "test" : "train");
	}
	return file_out_commit(&out, e);
}

/* One line, as --test-views takes it. */
static int write_test_views(struct job *j, const char *dir, struct err *e)
{
	struct file_out out = {0};
	const char *comma = "";

	if (open_in(&out, dir, "test-views", e))
		return -1;
	for (size_t i = 0; i < j->scene.cameras.n; i++) {
		const struct camera *c = &j->scene.cameras.views[i];
		if (c->split == SPLIT_TEST) {
			fprintf(out.stream, "%s%s", comma, c->name);
			comma = ",";
		}
	}
	fputc('\n', out.stream);
	return file_out_commit(&out, e);
}

static int write_photograph(
	struct job *j, const struct camera *c, const struct render_view *view, struct err *e)
{
	static const float background[3] = {0.6f, 0.62f, 0.65f};
	size_t values = 3 * (size_t)c->width * (size_t)c->height;
	float *rgb = mem_alloc(values, sizeof *rgb, "photograph", e);
	uint8_t *bytes = mem_alloc(values, 1, "photograph", e);
	int bad = !rgb || !bytes || render_colors(view, &j->scene.splats, c, background, rgb, e) ? -1 : 0;

	if (!bad) {
		for (size_t i = 0; i < values; i++)
			bytes[i] = (uint8_t)lrintf(255 * rgb[i]);
		bad = png_write(c->image, bytes, c->height, c->width, 3, e);
	}
	free(rgb);
	free(bytes);
	return bad;
}

static int put_truth(struct job *j, const struct camera *c, const uint8_t *masks, struct err *e)
{
	size_t pixels = (size_t)c->width * (size_t)c->height;
	int bad = 0;

	for (int i = 0; i < j->scene.object_count && !bad; i++) {
		struct mask_record r = {.view = c->name, .object = j->scene.objects[i].name, .score = NAN};
		bad = rle_encode(&r.mask, masks + (size_t)i * pixels, c->height, c->width, e) ||
		      masks_put(j->truth.stream, &r, e);
		rle_free(&r.mask);
	}
	return bad ? -1 : 0;
}

static int put_candidates(
	struct job *j, int number, const struct camera *c, const uint8_t *masks, struct err *e)
{
	struct synth_candidates found = {0};
	int bad = synth_detect(&found, &j->detector, number, masks, c->height, c->width, e);

	for (size_t i = 0; i < found.n && !bad; i++) {
		const struct synth_candidate *f = &found.items[i];
		struct synth_sentence *s = &j->sentences[f->object * SYNTH_SENTENCES + f->sentence];
		struct mask_record r = {.view = c->name,
			.ref = s->ref,
			.object = j->scene.objects[f->object].name,
			.score = f->score,
			.mask = f->mask};
		bad = masks_put(j->candidates.stream, &r, e);
	}
	synth_candidates_free(&found);
	return bad;
}

static int write_view(struct job *j, int number, struct err *e)
{
	const struct camera *c = &j->scene.cameras.views[number];
	size_t pixels = (size_t)c->width * (size_t)c->height;
	uint8_t *masks = mem_alloc((size_t)j->scene.object_count, pixels, "truth", e);
	struct render_view *view = masks ? render_prepare(&j->scene.splats, c, e) : NULL;
	int bad = !view || write_photograph(j, c, view, e) ||
		  synth_truth_visible(&j->scene, view, pixels, masks, e) || put_truth(j, c, masks, e) ||
		  (c->split == SPLIT_TRAIN && put_candidates(j, number, c, masks, e));

	if (view)
		render_free(view);
	free(masks);
	return bad ? -1 : 0;
}

static int write_views(struct job *j, const char *dir, struct err *e)
{
	struct cli_progress progress;
	int bad = open_in(&j->candidates, dir, "candidates.jsonl", e) ||
		  open_in(&j->truth, dir, "truth.jsonl", e);

	cli_progress_start(&progress, &j->cli, "views", j->options.views);
	for (int i = 0; i < j->options.views && !bad; i++) {
		bad = write_view(j, i, e);
		cli_progress_step(&progress, i + 1, NULL);
	}
	cli_progress_end(&progress);
	if (!bad)
		bad = file_out_commit(&j->candidates, e) || file_out_commit(&j->truth, e);
	file_out_abort(&j->candidates);
	file_out_abort(&j->truth);
	return bad ? -1 : 0;
}

static int make_once(struct job *j, struct err *e)
{
	struct synth_layout layout;
	double right[2], away[2];
	struct synth_scene *s = &j->scene;

	if (synth_scene_make(s, &j->options, e))
		return -1;
	synth_cameras_reference(&s->cameras, right, away);
	synth_layout_make(&layout, s->objects, s->object_count, &s->table, right, away);
	if (synth_sentences_make(j->sentences, &layout, j->options.seed, e)) {
		synth_scene_free(s);
		return -1;
	}
	synth_detector_make(&j->detector, s->objects, s->object_count, j->sentences, s->preset->severity,
		j->options.seed);
	return 0;
}

/* Things may stand so that words cannot tell them apart; then they are put otherwise. Nothing is written
 * before. */
static int make(struct job *j, int number, struct err *e)
{
	j->sentences = mem_zalloc(
		(size_t)j->options.objects * SYNTH_SENTENCES, sizeof *j->sentences, "sentences", e);
	if (!j->sentences)
		return -1;
	for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
		j->options.seed = synth_preset_seed(number, (uint64_t)j->cli.seed, attempt);
		*e = (struct err){0};
		if (!make_once(j, e))
			return 0;
		if (e->code != ERR_CHECK)
			return -1;
	}
	return err_set(e, ERR_CHECK, "seed %lld: words cannot tell the objects apart; try another --seed",
		j->cli.seed);
}

int main(int argc, char **argv)
{
	long long objects = 0, views = 0, gaussians = 0;
	int number = 0, size[2] = {0};
	struct job j = {0};
	struct err e = {0};
	const struct cli_option options[] = {
		{"scene", 0, CLI_CHOICE, &number, "table|diner|toys|tea|kitchen",
			"what is made (default table)", 0, 0},
		{"objects", 0, CLI_INT, &objects, "K", "objects (default: the scene's; of the table 8)",
			SYNTH_MIN_OBJECTS, SYNTH_MAX_OBJECTS},
		{"views", 0, CLI_INT, &views, "V",
			"views for training and testing (default: the scene's; of the table 25)",
			SYNTH_MIN_VIEWS, SYNTH_MAX_VIEWS},
		{"size", 0, CLI_SIZE, size, "WxH",
			"size of the photographs in pixels (default 492x364; of the table 320x240)", 16,
			4096},
		{"gaussians", 0, CLI_INT, &gaussians, "N", "Gaussians (default 60000; of the table 20000)",
			1000, 10000000},
		{0},
	};
	const struct cli_tool tool = {
		.name = "gs-synth",
		.operands = "-o DIR",
		.summary =
			"Make a synthetic table-top scene with photographs, sentences, candidate masks and their truth.",
		.options = options,
		.common = CLI_OUTPUT | CLI_SEED | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
		.output_arg = "DIR",
		.needs_output = 1,
	};

	cli_parse(&j.cli, &tool, argc, argv);
	if (!strcmp(j.cli.output, "-"))
		cli_usage(&j.cli, "-o must name a folder");
	const struct synth_preset *p = synth_preset(number);
	j.options = (struct synth_options){p, 0, objects ? (int)objects : p->objects,
		views ? (int)views : p->views, size[0] ? size[0] : p->width, size[0] ? size[1] : p->height,
		gaussians ? (size_t)gaussians : p->gaussians};
	const char *dir = j.cli.output;
	int bad = make(&j, number, &e) || name_photographs(&j, dir, &e) || write_model(&j, dir, &e) ||
		  write_sentences(&j, dir, &e) || write_test_views(&j, dir, &e) || write_views(&j, dir, &e);
	free(j.sentences);
	synth_scene_free(&j.scene);
	return bad ? cli_fail(&j.cli, &e) : cli_done(&j.cli);
}
