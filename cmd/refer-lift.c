/* refer-lift: objects lifted onto the Gaussians from their masks, in closed form. */
#include "base/file.h"
#include "base/mem.h"
#include "base/names.h"
#include "cli/cli.h"
#include "formats/lifted.h"
#include "formats/masks.h"
#include "formats/parser_weights.h"
#include "formats/scene.h"
#include "formats/text.h"
#include "formats/weights.h"
#include "refer/lift_objects.h"
#include "refer/recognise.h"

#include <stdlib.h>
#include <string.h>

static struct {
	const char *scene, *weights, *text, *masks;
	int is_as_masked;
} options;

static const struct cli_option table[] = {
	{"scene", 0, CLI_STRING, &options.scene, "SCENE", "scene folder of gs-import (required)", 0, 0},
	{"weights", 0, CLI_STRING, &options.weights, "WEIGHTS", "folder of gs-weigh (required)", 0, 0},
	{"text", 0, CLI_STRING, &options.text, "TEXT", "sentences encoded by text-encode (required)", 0, 0},
	{"masks", 0, CLI_STRING, &options.masks, "MASKS", "masks of pseudomask-select (required)", 0, 0},
	{"names", 0, CLI_CHOICE, &options.is_as_masked, "sentences|masks",
		"which of several alike an object is: as sentences say (default), or as masks do", 0, 0},
	{0}};

static const struct cli_tool tool = {.name = "refer-lift",
	.operands = "--scene SCENE --weights WEIGHTS --text TEXT --masks MASKS",
	.summary = "Lift the objects that sentences name onto the Gaussians of a scene, from their masks.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT,
	.output_arg = "MODEL"};

struct run {
	struct scene scene;
	struct text text;
	struct mask_set set;
	long *lines;			       /* (set.n) */
	size_t *views;			       /* (set.n) of each mask */
	size_t *sentence_object, *mask_object; /* (text.n), (set.n) in names; LIFTED_NONE: does not count */
	struct names refs, objects_of;	       /* of the sentences; of `trained` */
	const char **trained;		       /* (text.n) objects of the training sentences, else NULL */
	char *is_shown; /* (text.n) by a mask, at the first training sentence of an object */
	size_t objects;
	char **names; /* (objects) of the sentences, in the order in which these first name them; not owned */
	char *is_there; /* (scene.cameras.n) the view has weights */
	struct lift_objects lift;
	struct lifted model;
	struct parser_weights weights;
	struct cli_progress progress;
};

static void run_free(struct run *r)
{
	scene_free(&r->scene);
	text_free(&r->text);
	masks_free(&r->set);
	free(r->lines);
	free(r->views);
	free(r->sentence_object);
	free(r->mask_object);
	names_free(&r->refs);
	names_free(&r->objects_of);
	free(r->trained);
	free(r->is_shown);
	free(r->names);
	free(r->is_there);
	lift_objects_free(&r->lift);
	lifted_free(&r->model);
	parser_weights_free(&r->weights);
}

static int load(struct run *r, struct err *e)
{
	if (scene_read(&r->scene, options.scene, e) || text_read(&r->text, options.text, e) ||
		masks_read_lines(&r->set, &r->lines, options.masks, e))
		return -1;
	if (!r->text.pieces)
		return err_set(e, ERR_FORMAT, "%s: has no word pieces: encode the sentences anew",
			file_name(options.text));
	r->views = mem_alloc(r->set.n, sizeof *r->views, "masks", e);
	r->mask_object = mem_alloc(r->set.n, sizeof *r->mask_object, "masks", e);
	r->sentence_object = mem_alloc(r->text.n, sizeof *r->sentence_object, "sentences", e);
	r->names = mem_alloc(r->text.n, sizeof *r->names, "objects", e);
	r->trained = mem_alloc(r->text.n, sizeof *r->trained, "sentences", e);
	r->is_shown = mem_zalloc(r->text.n, 1, "sentences", e);
	r->is_there = mem_zalloc(r->scene.cameras.n, 1, "views", e);
	if (!r->views || !r->mask_object || !r->sentence_object || !r->names || !r->trained || !r->is_shown ||
		!r->is_there)
		return -1;
	return masks_views(&r->set, r->lines, options.masks, &r->scene.cameras, r->views, e);
}

/* Which training views can be looked at. */
static int find_views(struct run *r, const struct cli *c, struct err *e)
{
	size_t left_out;

	if (weights_mark(options.weights, &r->scene.cameras, r->is_there, &left_out, e))
		return -1;
	if (left_out)
		cli_warn(c, "%s: %zu training views have no weights, and their masks do not count",
			options.weights, left_out);
	return 0;
}

/* The first training sentence of a mask's object: a sentence's mask is its object's, but those of test
 * sentences, and of views without weights, are not looked at. NAMES_NONE where the mask does not count. */
static size_t sentence_of_mask(const struct run *r, size_t mask)
{
	const struct mask_record *m = &r->set.records[mask];
	const size_t ref = m->ref ? names_find(&r->refs, m->ref) : NAMES_NONE;
	const char *name = ref == NAMES_NONE ? m->object : r->trained[ref];

	return name && r->is_there[r->views[mask]] ? names_find(&r->objects_of, name) : NAMES_NONE;
}

static int find_sentences(struct run *r, struct err *e)
{
	const size_t n = r->text.n;

	for (size_t i = 0; i < n; i++)
		r->trained[i] = r->text.splits[i] == SPLIT_TRAIN ? r->text.objects[i] : NULL;
	if (names_make(&r->refs, r->text.refs, sizeof(char *), 0, n, e) ||
		names_make(&r->objects_of, r->trained, sizeof(char *), 0, n, e))
		return -1;
	for (size_t i = 0; i < r->set.n; i++) {
		r->mask_object[i] = sentence_of_mask(r, i);
		if (r->mask_object[i] != NAMES_NONE)
			r->is_shown[r->mask_object[i]] = 1;
	}
	return 0;
}

/* The objects that a training sentence names and a mask shows. */
static void find_objects(struct run *r, const struct cli *c)
{
	size_t unknown = 0;

	for (size_t i = 0; i < r->text.n; i++) {
		const size_t first = r->trained[i] ? names_find(&r->objects_of, r->trained[i]) : i;
		r->sentence_object[i] = first < i ? r->sentence_object[first] : LIFTED_NONE;
		if (first < i || !r->trained[i])
			continue;
		if (r->is_shown[i])
			r->names[r->sentence_object[i] = r->objects++] = r->text.objects[i];
		else
			cli_warn(c, "%s: '%s' has no mask in a training view, and is left out",
				file_name(options.masks), r->trained[i]);
	}
	for (size_t i = 0; i < r->set.n; i++) {
		const size_t first = r->mask_object[i];
		r->mask_object[i] = first == NAMES_NONE ? LIFTED_NONE : r->sentence_object[first];
		unknown += r->is_there[r->views[i]] && r->mask_object[i] == LIFTED_NONE;
	}
	if (unknown)
		cli_warn(c, "%s: %zu masks are of no training sentence's object", file_name(options.masks),
			unknown);
}

static int by_object(const void *a, const void *b)
{
	const struct lift_mask *x = a, *y = b;

	return (x->object > y->object) - (x->object < y->object);
}

static int lift_view(struct run *r, size_t view, struct lift_mask *masks, struct err *e)
{
	struct weights weights;
	size_t n = 0;

	for (size_t i = 0; i < r->set.n; i++)
		if (r->views[i] == view && r->mask_object[i] != LIFTED_NONE)
			masks[n++] = (struct lift_mask){r->mask_object[i], &r->set.records[i].mask};
	if (!n)
		return 0;
	qsort(masks, n, sizeof *masks, by_object);
	if (weights_open(&weights, options.weights, &r->scene, view, e))
		return -1;
	const struct view_weights blend = weights_view(&weights);
	int bad = lift_objects_view(&r->lift, &blend, weights.height, weights.width, masks, n, e);
	weights_close(&weights);
	return bad;
}

static int lift(struct run *r, struct err *e)
{
	const size_t n = r->scene.cameras.n;
	struct lift_mask *masks = mem_alloc(r->set.n, sizeof *masks, "masks", e);
	int bad = !masks || lift_objects_init(&r->lift, r->scene.splats.n, r->objects, e);

	for (int round = 0; round < LIFT_ROUNDS && !bad; round++) {
		for (size_t v = 0; v < n && !bad; v++) {
			bad = lift_view(r, v, masks, e);
			cli_progress_step(&r->progress, (double)((size_t)round * n + v + 1), NULL);
		}
		if (!bad)
			lift_objects_settle(&r->lift);
	}
	free(masks);
	return bad || lift_objects_finish(&r->lift, &r->model, e) ? -1 : 0;
}

static int run(struct run *r, const struct cli *c, struct err *e)
{
	double confidence = 0;
	size_t moved = 0;

	if (load(r, e) || parser_weights_default(&r->weights, e) || find_views(r, c, e) ||
		find_sentences(r, e))
		return -1;
	find_objects(r, c);
	cli_progress_start(&r->progress, c, "views", (double)r->scene.cameras.n * LIFT_ROUNDS);
	int bad = lift(r, e);
	cli_progress_end(&r->progress);
	if (bad || lifted_add_sentences(&r->model, &r->text, r->sentence_object, r->names, e) ||
		(!options.is_as_masked && recognise(&r->model, &r->scene.splats, &r->scene.cameras,
						  &(struct parser){.weights = &r->weights}, &moved, e)))
		return -1;
	for (size_t o = 0; o < r->model.objects; o++)
		confidence += (double)r->model.confidence[o] / (double)r->model.objects;
	cli_note(c, 1,
		"%zu objects, %lld Gaussians with a share in one; agreement of the masks %.3f; %zu changed places",
		r->model.objects, (long long)r->model.indptr[r->model.objects], confidence, moved);
	const struct origin origin = {r->scene.fingerprint, r->text.encoder};
	return lifted_write(&r->model, &origin, c->output,
		options.is_as_masked ? "--names masks" : "--names sentences", e);
}

int main(int argc, char **argv)
{
	struct run r = {0};
	struct cli c;
	struct err e = {0};

	cli_parse(&c, &tool, argc, argv);
	if (!options.scene || !options.weights || !options.text || !options.masks)
		cli_usage(&c, "--scene, --weights, --text and --masks are required");
	cli_refuse_overwrite(&c, CLI_SCENE " " CLI_WEIGHTS " text masks", "output", NULL);
	cli_refuse_terminal(&c);
	int bad = run(&r, &c, &e);
	run_free(&r);
	return bad ? cli_fail(&c, &e) : cli_done(&c);
}
