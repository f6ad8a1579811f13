/* What a page shows: the things, the splats, photographs and masks. */
#include "cmd/serve/serving.h"

#include "answer/answer.h"
#include "base/mem.h"
#include "cmd/report/reporting.h"
#include "formats/records/json.h"

#include <zlib.h>

enum { PICTURE_SIDE = 1600 /* pixels of a photograph at most */ };

/* The scene as the report's viewer takes it; nothing of it is to be freed. */
static struct report_run as_run(const struct serving *s, struct report_options *options)
{
	*options = (struct report_options){.splats = s->options->splats};
	return (struct report_run){.options = options,
		.scene = s->asking->scene,
		.has_lifted = 1,
		.lifted = s->asking->model,
		.shown_count = 1,
		.shown = s->cameras.views};
}

static int is_labelled(const struct serving *s, const char *name)
{
	for (size_t k = 0; k < s->labelled_count; k++)
		if (!strcmp(s->labelled[k], name))
			return 1;
	return 0;
}

static void put_lists(struct jsontext *to, const struct serving *s)
{
	const struct lifted *l = &s->asking->model.lifted;

	jsontext_open(to, "views", '[');
	for (size_t v = 0; v < s->cameras.n; v++) {
		jsontext_open(to, NULL, '{');
		jsontext_string(to, "name", s->cameras.views[v].name);
		jsontext_number(to, "width", s->cameras.views[v].width);
		jsontext_number(to, "height", s->cameras.views[v].height);
		jsontext_close(to, '}');
	}
	jsontext_close(to, ']');
	jsontext_open(to, "things", '[');
	for (size_t o = 0; o < l->objects; o++) {
		jsontext_open(to, NULL, '{');
		jsontext_string(to, "name", l->names[o]);
		jsontext_number(to, "gaussians", (double)(l->indptr[o + 1] - l->indptr[o]));
		jsontext_flag(to, "labelled", is_labelled(s, l->names[o]));
		jsontext_close(to, '}');
	}
	jsontext_close(to, ']');
}

static int put_things(struct serving *s, void *data, struct err *e)
{
	SCOPED_BY(report_splats_free) struct report_splats splats = {0};
	struct report_options options;
	const struct report_run run = as_run(s, &options);
	struct serving_text text;

	if (report_splats_make(&splats, &run, e) || serving_text_open(&text, e))
		return -1;
	struct jsontext to = {.out = text.out};
	jsontext_open(&to, NULL, '{');
	jsontext_number(&to, "revision", (double)s->revision);
	jsontext_flag(&to, "can_label", s->can_click);
	jsontext_flag(&to, "can_outline", s->weights != NULL);
	jsontext_flag(&to, "has_viewer", s->viewer != NULL);
	put_lists(&to, s);
	const int bad = report_scene_put(&to, &run, &splats, s->viewer, e);
	jsontext_close(&to, '}');
	fputc('\n', text.out);
	return serving_text_end(&text, bad, data, e);
}

int serving_things(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e)
{
	(void)body;
	return serving_do(s, &(struct serving_job){.run = put_things, .data = to, .e = e});
}

static int put_splats(struct serving *s, void *data, struct err *e)
{
	SCOPED_BY(report_splats_free) struct report_splats splats = {0};
	struct report_options options;
	const struct report_run run = as_run(s, &options);
	struct serving_reply *to = data;

	if (report_splats_make(&splats, &run, e))
		return -1;
	uLongf length = compressBound((uLong)(32 * splats.n));
	char *bytes = mem_alloc(length, 1, "splats", e);
	if (!bytes || compress2((Bytef *)bytes, &length, splats.bytes, (uLong)(32 * splats.n),
			      Z_BEST_SPEED) != Z_OK) {
		free(bytes);
		return bytes ? err_set(e, ERR_SYSTEM, "splats: cannot be packed") : -1;
	}
	*to = (struct serving_reply){"application/octet-stream", bytes, length};
	return 0;
}

int serving_splats(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e)
{
	(void)body;
	return serving_do(s, &(struct serving_job){.run = put_splats, .data = to, .e = e});
}

struct wanted_view {
	struct camera camera; /* as large as the picture */
	struct serving_reply *to;
};

static int render_picture(struct serving *s, void *data, struct err *e)
{
	struct wanted_view *w = data;

	w->to->type = "image/jpeg";
	return report_rendering(&s->asking->scene, &w->camera, (uint8_t **)&w->to->bytes, &w->to->length, e);
}

int serving_picture(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e)
{
	size_t view;

	if (serving_view(s, body, "name", &view, e))
		return -1;
	struct wanted_view w = {camera_within(&s->cameras.views[view], PICTURE_SIDE), to};
	const int found =
		report_photograph(s->scene_path, &w.camera, (uint8_t **)&to->bytes, &to->length, s->to, e);
	to->type = "image/jpeg";
	return found ? (found < 0 ? -1 : 0)
		     : serving_do(s, &(struct serving_job){.run = render_picture, .data = &w, .e = e});
}

struct wanted_mask {
	const cJSON *things;
	size_t view;
	struct serving_reply *to;
};

static int find_thing(const struct lifted *l, const cJSON *name, size_t *thing, struct err *e)
{
	if (!cJSON_IsString(name))
		return err_set(e, ERR_FORMAT, "request: key 'thing' is no name and no list of names");
	*thing = serving_thing(l, name->valuestring);
	return *thing == ASKING_NONE ? err_set(e, ERR_CHECK, "no thing '%s'", name->valuestring) : 0;
}

static int encode_mask(void *data, const struct answer *a, struct err *e)
{
	return rle_encode(data, a->mask, a->camera->height, a->camera->width, e);
}

static int put_mask(struct serving *s, void *data, struct err *e)
{
	const struct wanted_mask *w = data;
	const struct lifted *l = &s->asking->model.lifted;
	const cJSON *only = cJSON_IsArray(w->things) ? w->things->child : w->things;
	SCOPED size_t *things = mem_alloc(l->objects, sizeof *things, "mask", e);
	SCOPED_BY(rle_free) struct rle mask = {0};
	const struct camera *view = &s->asking->scene.cameras.views[w->view];
	const struct answer_calls calls = {&mask, encode_mask, NULL};
	struct serving_text text;
	size_t count = 0, thing = 0;

	for (; things && only && count < l->objects; only = cJSON_IsArray(w->things) ? only->next : NULL) {
		if (find_thing(l, only, &thing, e))
			return -1;
		things[count++] = thing;
	}
	if (!things || !count)
		return things ? err_set(e, ERR_CHECK, "no thing is named") : -1;
	if (answer_mask(s->asking, things, count, view, &calls, e) || serving_text_open(&text, e))
		return -1;
	struct jsontext to = {.out = text.out};
	serving_put_mask(&to, s->cameras.views[w->view].name, &mask);
	fputc('\n', text.out);
	return serving_text_end(&text, 0, w->to, e);
}

int serving_mask(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e)
{
	struct wanted_mask w = {.things = json_member(body, "thing"), .to = to};

	return serving_view(s, body, "view", &w.view, e)
		       ? -1
		       : serving_do(s, &(struct serving_job){.run = put_mask, .data = &w, .e = e});
}
