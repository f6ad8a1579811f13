/* The library's functions on top of asking: each checks what a program could get wrong, and leaves the error
 * in the handle. */
#include "cmd/api/refersplat.h"

#include "answer/answer.h"
#include "base/mem.h"
#include "base/report.h"
#include "cmd/ask/reply.h"
#include "cmd/ask/asking.h"
#include "cmd/text/questions.h"
#include "formats/records/parses.h"
#include "geom/rotation.h"

#include <stdio.h>

struct refersplat {
	struct err err;
	int is_loaded;
	struct asking_options options;
	struct asking asking;
	struct asking_answer answer;
	int *objects; /* (answer.count), and their probabilities */
	double *probabilities;
	char *json;
};

struct refersplat *refersplat_new(void)
{
	return calloc(1, sizeof(struct refersplat));
}

static void forget_answer(struct refersplat *r)
{
	asking_answer_free(&r->answer);
	mem_free_all(r->objects, r->probabilities);
	r->objects = NULL;
	r->probabilities = NULL;
}

static void unload(struct refersplat *r)
{
	forget_answer(r);
	free(r->json);
	r->json = NULL;
	asking_close(&r->asking);
	r->asking = (struct asking){0};
	r->is_loaded = 0;
}

void refersplat_free(struct refersplat *r)
{
	if (r)
		unload(r);
	free(r);
}

const char *refersplat_message(const struct refersplat *r)
{
	return r->err.message;
}

/* The status of a call that was `bad`. */
static int end(struct refersplat *r, int bad)
{
	return !bad ? REFERSPLAT_OK : r->err.code ? (int)r->err.code : REFERSPLAT_SYSTEM;
}

/* Every call but the first begins so. */
static int begin(struct refersplat *r)
{
	r->err = (struct err){0};
	return r->is_loaded ? 0 : err_set(&r->err, ERR_USAGE, "no scene is loaded");
}

int refersplat_load(struct refersplat *r, const char *scene, const char *model, const char *encoder)
{
	unload(r);
	r->err = (struct err){0};
	if (!scene || !model)
		return end(r, err_set(&r->err, ERR_USAGE, "a scene and a model must be named"));
	r->options = (struct asking_options){.run = scene,
		.given = {.scene = (char *)scene, .model = (char *)model, .encoder = (char *)encoder},
		.least = RESPONSES_LEAST};
	const int bad = asking_open(&r->asking, &r->options, &r->err);
	r->options = (struct asking_options){.least = RESPONSES_LEAST};
	r->is_loaded = !bad;
	if (bad)
		unload(r);
	return end(r, bad);
}

int refersplat_load_camera(struct refersplat *r, const char *file)
{
	return end(r, begin(r) || asking_read_camera(&r->asking, file, &r->err));
}

static void put_boxes(struct refersplat_object *to, const struct extent *x, const double offset[3])
{
	double axes[3][3];

	box_bounds(&x->aligned, to->low, to->high);
	for (int k = 0; k < 3; k++) {
		to->low[k] += offset[k];
		to->high[k] += offset[k];
		to->centre[k] = x->turned.centre[k] + offset[k];
		to->size[k] = 2 * x->turned.half[k];
		for (int d = 0; d < 3; d++)
			axes[d][k] = x->turned.axes[k][d];
	}
	rotation_to_quat(axes, to->quat);
}

int refersplat_get_object(struct refersplat *r, size_t i, struct refersplat_object *object)
{
	const struct lifted *l = &r->asking.model.lifted;

	*object = (struct refersplat_object){0};
	if (begin(r))
		return end(r, -1);
	if (i >= l->objects)
		return end(r, err_set(&r->err, ERR_CHECK, "no object %zu, of %zu", i, l->objects));
	const struct extent *x = &r->asking.model.extents[i];
	object->name = l->names[i];
	object->confidence = l->confidence[i];
	object->count = x->n;
	object->gaussians = x->ids;
	if (x->n)
		put_boxes(object, x, r->asking.scene.offset);
	return REFERSPLAT_OK;
}

int refersplat_get_view(struct refersplat *r, size_t i, struct refersplat_view *view)
{
	const struct cameras *c = &r->asking.scene.cameras, *given = &r->asking.given;

	*view = (struct refersplat_view){0};
	if (begin(r))
		return end(r, -1);
	if (i >= c->n + given->n)
		return end(r, err_set(&r->err, ERR_CHECK, "no view %zu, of %zu", i, c->n + given->n));
	const struct camera *of = i < c->n ? &c->views[i] : given->views;
	*view = (struct refersplat_view){of->name, of->width, of->height};
	return REFERSPLAT_OK;
}

static int take_question(struct refersplat *r, struct question *q, const char *text)
{
	if (begin(r))
		return -1;
	if (!text || !question_take(q, text))
		return err_set(&r->err, ERR_FORMAT, "the sentence %s", text ? q->fault : "is missing");
	return 0;
}

static const struct camera *find_view(struct refersplat *r, const char *name)
{
	const struct camera *view = name ? asking_view(&r->asking, name) : NULL;

	if (!view)
		err_set(&r->err, ERR_USAGE, "no view '%s'", name ? name : "");
	return view;
}

static int parse_text(char **line, const struct asking *a, const struct text *t, struct err *e)
{
	const struct parser_vectors v = {
		t->pieces ? t->pieces[0] : NULL, t->middle, (int)t->offsets[1], t->width};
	SCOPED_BY(parse_free) struct parse p = {0};
	size_t length;

	if (parse_sentence(&p, &a->parser, t->texts[0], &v, e))
		return -1;
	FILE *out = open_memstream(line, &length);
	const int bad = out && parses_put(out, t->refs[0], t->texts[0], &p, e);
	*line = mem_text_end(out, line, bad, "parse", e);
	return *line ? 0 : -1;
}

int refersplat_parse(struct refersplat *r, const char *sentence, const char **json)
{
	SCOPED_BY(encoding_free) struct encoding x = {0};
	struct question q;

	*json = NULL;
	free(r->json);
	r->json = NULL;
	int bad = take_question(r, &q, sentence) || sentences_add(&x.sentences, "1", "?", q.text, &r->err) ||
		  encode(&x, &r->asking.encoder, &report_silent, &r->err) ||
		  parse_text(&r->json, &r->asking, &x.text, &r->err);
	*json = bad ? NULL : r->json;
	return end(r, bad);
}

static int copy_answer(struct refersplat *r, struct refersplat_answer *to)
{
	const struct asking_answer *from = &r->answer;

	r->objects = mem_alloc(from->count, sizeof *r->objects, "answer", &r->err);
	r->probabilities = mem_alloc(from->count, sizeof *r->probabilities, "answer", &r->err);
	if (!r->objects || !r->probabilities)
		return -1;
	for (size_t k = 0; k < from->count; k++) {
		r->objects[k] = (int)from->things[k];
		r->probabilities[k] = from->probability[from->things[k]];
	}
	*to = (struct refersplat_answer){
		from->count, r->objects, r->probabilities, from->there, from->count ? "" : from->reason};
	return 0;
}

int refersplat_ask(
	struct refersplat *r, const char *question, const char *view, struct refersplat_answer *answer)
{
	struct question q;

	*answer = (struct refersplat_answer){.reason = ""};
	forget_answer(r);
	if (take_question(r, &q, question))
		return end(r, -1);
	const struct camera *from = view ? find_view(r, view) : NULL;
	if (view && !from)
		return end(r, -1);
	r->asking.from =
		(struct viewpoint){.kind = view ? VIEWPOINT_CAMERA : VIEWPOINT_USUAL, .camera = from};
	if (asking_ask(&r->asking, q.text, 0, &r->answer, &report_silent, &r->err) || copy_answer(r, answer))
		return end(r, -1);
	return answer->count ? REFERSPLAT_OK : end(r, err_set(&r->err, ERR_CHECK, "%s", answer->reason));
}

static int copy_mask(void *data, const struct answer *a, struct err *e)
{
	(void)e;
	memcpy(data, a->mask, (size_t)a->camera->width * (size_t)a->camera->height);
	return 0;
}

static int draw_mask(struct refersplat *r, const struct camera *view, const size_t *things, size_t count,
	unsigned char *mask)
{
	const struct answer_calls calls = {mask, copy_mask, NULL};

	return answer_mask(&r->asking, things, count, view, &calls, &r->err);
}

/* things gets the objects, all of which are there. */
static int take_objects(struct refersplat *r, size_t *things, const int *objects, size_t count)
{
	for (size_t k = 0; k < count; k++) {
		if (objects[k] < 0 || (size_t)objects[k] >= r->asking.model.lifted.objects)
			return err_set(&r->err, ERR_USAGE, "no object %d, of %zu", objects[k],
				r->asking.model.lifted.objects);
		things[k] = (size_t)objects[k];
	}
	return 0;
}

int refersplat_mask(
	struct refersplat *r, const char *name, const int *objects, size_t count, unsigned char *mask)
{
	const struct camera *view = begin(r) ? NULL : find_view(r, name);
	SCOPED size_t *things = view ? mem_alloc(count, sizeof *things, "mask", &r->err) : NULL;
	int bad = !things || take_objects(r, things, objects, count);

	if (!bad && count)
		bad = draw_mask(r, view, things, count, mask);
	else if (!bad)
		memset(mask, 0, (size_t)view->width * (size_t)view->height);
	return end(r, bad);
}
