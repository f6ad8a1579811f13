/* refer-render: the masks of sentences in any view, from a trained model. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/masks.h"
#include "formats/model.h"
#include "formats/npy.h"
#include "formats/png.h"
#include "formats/scene.h"
#include "formats/text.h"
#include "mask/overlay.h"
#include "refer/respond.h"
#include "splat/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SPLIT_ALL = 2 };

static struct {
	const char *scene, *text, *model, *views, *refs, *png, *response, *overlay;
	int split, sentences, size[2], is_npy;
	double scale;
} options = {.split = SPLIT_TEST, .sentences = SPLIT_ALL, .scale = 1};

static const struct cli_option table[] = {
	{"scene", 0, CLI_STRING, &options.scene, "SCENE", "scene folder of gs-import (required)", 0, 0},
	{"text", 0, CLI_STRING, &options.text, "TEXT", "sentences encoded by text-encode (required)", 0, 0},
	{"model", 0, CLI_STRING, &options.model, "MODEL", "model of refer-train (required)", 0, 0},
	{"split", 0, CLI_CHOICE, &options.split, "train|test|all", "which views (default test)", 0, 0},
	{"views", 0, CLI_STRING, &options.views, "NAME,...", "these views instead of a split", 0, 0},
	{"sentences", 0, CLI_CHOICE, &options.sentences, "train|test|all", "which sentences (default all)", 0, 0},
	{"refs", 0, CLI_STRING, &options.refs, "REF,...", "these sentences instead of a split", 0, 0},
	{"size", 0, CLI_SIZE, &options.size, "WxH", "size of the masks (default: the view's)", 1, 65536},
	{"scale", 0, CLI_REAL, &options.scale, "S", "size of the masks as a share of the view's (default 1)", 1e-4, 16},
	{"png", 0, CLI_STRING, &options.png, "DIR", "write masks as DIR/VIEW/REF.png", 0, 0},
	{"response", 0, CLI_STRING, &options.response, "DIR", "write response maps as DIR/VIEW/REF.png or .npy", 0, 0},
	{"response-type", 0, CLI_CHOICE, &options.is_npy, "png|npy",
		"png (default): 16 bits, 65535 times the sigmoid of the response; npy: the response", 0, 0},
	{"overlay", 0, CLI_STRING, &options.overlay, "DIR", "draw masks over the scene's colours as DIR/VIEW/REF.png", 0, 0},
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
	size_t ref_count, view_count;
	size_t *refs;		      /* indices in text */
	const struct camera **views;
	float *responses;	      /* (ref_count,N) */
	struct file_out out;
};

/* 1 where a comma-separated list has the word. */
static int list_has(const char *list, const char *word)
{
	const size_t length = strlen(word);

	for (const char *p = list; p; p = strchr(p, ',') ? strchr(p, ',') + 1 : NULL)
		if (!strncmp(p, word, length) && (p[length] == ',' || !p[length]))
			return 1;
	return 0;
}

/* The first word of a list that is_known does not know, or NULL; the caller frees it. */
static char *unknown_word(const char *list, const struct run *r, int (*is_known)(const struct run *, const char *), struct err *e)
{
	char *copy = mem_strdup(list, e), *found = NULL;

	for (char *p = copy, *next; p && !found; p = next) {
		next = strchr(p, ',');
		if (next)
			*next++ = 0;
		if (!is_known(r, p))
			found = mem_strdup(p, e);
	}
	free(copy);
	return found;
}

static int is_view(const struct run *r, const char *name)
{
	return cameras_find(&r->scene.cameras, name) != NULL;
}

static int is_ref(const struct run *r, const char *name)
{
	return text_find(&r->text, name) >= 0;
}

static int choose(struct run *r, struct err *e)
{
	char *unknown = options.views ? unknown_word(options.views, r, is_view, e) : NULL;

	if (unknown) {
		err_set(e, ERR_FORMAT, "%s: no view '%s'", options.scene, unknown);
	} else if (options.refs && (unknown = unknown_word(options.refs, r, is_ref, e))) {
		err_set(e, ERR_FORMAT, "%s: no sentence with ref '%s'", options.text, unknown);
	}
	free(unknown);
	if (unknown)
		return -1;
	r->refs = mem_alloc(r->text.n, sizeof *r->refs, "sentences", e);
	r->views = mem_alloc(r->scene.cameras.n, sizeof *r->views, "views", e);
	if (!r->refs || !r->views)
		return -1;
	for (size_t i = 0; i < r->text.n; i++)
		if (options.refs ? list_has(options.refs, r->text.refs[i])
				 : options.sentences == SPLIT_ALL || (int)r->text.splits[i] == options.sentences)
			r->refs[r->ref_count++] = i;
	for (size_t i = 0; i < r->scene.cameras.n; i++) {
		const struct camera *c = &r->scene.cameras.views[i];
		if (options.views ? list_has(options.views, c->name) : options.split == SPLIT_ALL || (int)c->split == options.split)
			r->views[r->view_count++] = c;
	}
	return 0;
}

static int load(struct run *r, const struct cli *c, struct err *e)
{
	if (scene_read(&r->scene, options.scene, e) || text_read(&r->text, options.text, e) ||
		model_read(&r->model, options.model, e))
		return -1;
	if (r->model.scene_gaussians != r->scene.splats.n)
		return err_set(e, ERR_FORMAT, "%s: is of a scene of %zu Gaussians, %s has %zu", options.model,
			r->model.scene_gaussians, options.scene, r->scene.splats.n);
	if (r->model.layout.text_width != r->text.width)
		return err_set(e, ERR_FORMAT, "%s: is of sentences of width %d, %s has %d", options.model,
			r->model.layout.text_width, options.text, r->text.width);
	if (choose(r, e))
		return -1;
	if (!r->view_count)
		cli_warn(c, "%s: no view in this split", options.scene);
	r->responses = mem_alloc(r->ref_count, r->scene.splats.n * sizeof(float), "responses", e);
	if (!r->responses)
		return -1;
	const struct respond_model m = {&r->model.layout, r->model.similarity, r->model.scene_gaussians, r->model.n,
		r->model.ids, r->model.features, r->model.parameters, r->scene.splats.means, r->model.low, r->model.high};
	return respond_all(&m, r->text.offsets, r->text.words, r->refs, r->ref_count, r->responses, e);
}

/* DIR/VIEW/REF + suffix, with the folder made; '/' in a ref becomes '_'. NULL with *e set. */
static char *picture_path(const char *dir, const char *view, const char *ref, const char *suffix, struct err *e)
{
	char *folder = file_join(dir, view, "", e), *name = mem_strdup(ref, e), *path = NULL;

	for (char *p = name; p && *p; p++)
		if (*p == '/')
			*p = '_';
	if (folder && name && !file_make_dir(folder, e))
		path = file_join(folder, name, suffix, e);
	free(folder);
	free(name);
	return path;
}

static int put_response(const char *path, const float *image, const struct camera *c, struct err *e)
{
	const size_t pixels = (size_t)c->width * (size_t)c->height, shape[2] = {(size_t)c->height, (size_t)c->width};

	if (options.is_npy)
		return npy_write(path, image, shape, 2, e);
	uint16_t *grey = mem_alloc(pixels, sizeof *grey, path, e);
	if (!grey)
		return -1;
	for (size_t p = 0; p < pixels; p++)
		grey[p] = (uint16_t)lrintf(65535 / (1 + expf(-image[p])));
	int bad = png_write16(path, grey, c->height, c->width, e);
	free(grey);
	return bad;
}

static int put_overlay(const char *path, const uint8_t *mask, const uint8_t *rgb, const struct camera *c, struct err *e)
{
	const size_t bytes = 3 * (size_t)c->width * (size_t)c->height;
	uint8_t *copy = mem_alloc(bytes, 1, path, e);

	if (!copy)
		return -1;
	memcpy(copy, rgb, bytes);
	overlay_draw(copy, mask, c->height, c->width);
	int bad = png_write(path, copy, c->height, c->width, 3, e);
	free(copy);
	return bad;
}

/* The pictures that were asked for. */
static int put_pictures(const struct camera *c, const char *ref, const float *image, const uint8_t *mask, const uint8_t *rgb,
	struct err *e)
{
	const char *dirs[3] = {options.png, options.response, options.overlay};
	const size_t pixels = (size_t)c->width * (size_t)c->height;
	int bad = 0;

	for (int i = 0; i < 3 && !bad; i++) {
		char *path = dirs[i] ? picture_path(dirs[i], c->name, ref, i == 1 && options.is_npy ? ".npy" : ".png", e) : NULL;
		if (dirs[i] && !path)
			return -1;
		if (i == 0 && path) {
			uint8_t *grey = mem_alloc(pixels, 1, path, e);
			for (size_t p = 0; grey && p < pixels; p++)
				grey[p] = mask[p] ? 255 : 0;
			bad = grey ? png_write(path, grey, c->height, c->width, 1, e) : -1;
			free(grey);
		} else if (path) {
			bad = i == 1 ? put_response(path, image, c, e) : put_overlay(path, mask, rgb, c, e);
		}
		free(path);
	}
	return bad;
}

/* One mask: its record and pictures. */
static int put_mask(struct run *r, const struct camera *c, size_t sentence, const float *image, const uint8_t *rgb,
	struct err *e)
{
	const size_t pixels = (size_t)c->width * (size_t)c->height;
	uint8_t *mask = mem_alloc(pixels, 1, "mask", e);
	struct mask_record record = {.view = c->name, .ref = r->text.refs[sentence], .object = r->text.objects[sentence]};

	if (!mask)
		return -1;
	record.score = respond_mask(image, pixels, mask);
	int bad = rle_encode(&record.mask, mask, c->height, c->width, e) || masks_put(r->out.stream, &record, e) ||
		  put_pictures(c, record.ref, image, mask, rgb, e);
	rle_free(&record.mask);
	free(mask);
	return bad ? -1 : 0;
}

static int render(struct run *r, const struct camera *view, struct err *e)
{
	int width = options.size[0], height = options.size[1], bad = -1;

	if (!width)
		camera_scaled_size(view, options.scale, &width, &height);
	const struct camera c = camera_resize(view, width, height);
	const size_t pixels = (size_t)width * (size_t)height;
	struct render_view *v = render_prepare(&r->scene.splats, &c, e);
	float *image = mem_alloc(r->ref_count + 3, pixels * sizeof(float), "images", e);
	uint8_t *rgb = options.overlay ? mem_alloc(pixels, 3, "colours", e) : NULL;
	if (!v || !image || (options.overlay && !rgb))
		goto done;
	if (render_values(v, r->responses, (int)r->ref_count, image, NULL, e))
		goto done;
	if (rgb) {
		float *colours = image + r->ref_count * pixels;
		if (render_colors(v, &r->scene.splats, &c, (const float[3]){0, 0, 0}, colours, e))
			goto done;
		for (size_t i = 0; i < 3 * pixels; i++)
			rgb[i] = (uint8_t)lrintf(255 * colours[i]);
	}
	bad = 0;
	for (size_t i = 0; i < r->ref_count && !bad; i++)
		bad = put_mask(r, &c, r->refs[i], image + i * pixels, rgb, e);
done:
	render_free(v);
	free(image);
	free(rgb);
	return bad;
}

static int run(struct run *r, const struct cli *c, struct err *e)
{
	struct cli_progress progress;
	int bad = 0;

	if (load(r, c, e) || file_out_open(&r->out, c->output, e))
		return -1;
	cli_progress_start(&progress, c, "views", (double)r->view_count);
	for (size_t i = 0; i < r->view_count && !bad; i++) {
		bad = render(r, r->views[i], e);
		cli_progress_step(&progress, (double)i + 1, NULL);
	}
	cli_progress_end(&progress);
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
	int bad = run(&r, &c, &e);
	scene_free(&r.scene);
	text_free(&r.text);
	model_free(&r.model);
	free(r.refs);
	free(r.views);
	free(r.responses);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
