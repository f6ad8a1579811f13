#include "cmd/render/draw.h"

#include "answer/answer.h"
#include "answer/peak.h"
#include "base/file.h"
#include "base/mem.h"
#include "formats/records/masks.h"

static int add_view(struct drawing *d, const struct camera *view, struct err *e)
{
	const struct draw_options *o = d->options;
	int width = o->size[0], height = o->size[1];

	if (!width)
		camera_scaled_size(view, o->scale ? o->scale : 1, &width, &height);
	if (rle_check_size(height, width, e))
		return err_prefix(e, view->name);
	const struct camera own = camera_resize(view, width, height);
	const struct motion *m = &d->request->scene.motion;
	for (size_t t = 0; t < (d->names ? m->times : 1); t++) {
		struct camera *to = &d->views[d->view_count];
		*to = own;
		if (d->names) {
			const size_t room = strlen(view->name) + 24;
			to->has_time = 1;
			to->time = m->at[t];
			if (!(to->name = d->names[d->view_count] = mem_alloc(room, 1, "views", e)))
				return -1;
			snprintf(to->name, room, "%s.t%05zu", view->name, t);
		}
		d->view_count++;
	}
	return 0;
}

int draw_choose(struct drawing *d, const struct draw_options *options, struct request *request, struct err *e)
{
	const struct cameras *from = &request->scene.cameras;
	SCOPED char *chosen = mem_zalloc(from->n, 1, "views", e);

	d->options = options;
	d->request = request;
	const size_t times = options->is_all_times ? request->scene.motion.times : 1;
	if (!times)
		return err_set(e, ERR_USAGE, "--all-times: %s is still: it has no motion.safetensors",
			request->scene.path);
	int bad = !chosen || !(d->views = mem_alloc(from->n, times * sizeof *d->views, "views", e)) ||
		  (options->is_all_times &&
			  !(d->names = mem_zalloc(from->n, times * sizeof *d->names, "views", e))) ||
		  (options->views && cameras_mark(from, options->views, "--views", chosen, e));
	for (size_t i = 0; i < from->n && !bad; i++)
		if (options->views ? chosen[i]
				   : options->split == REQUEST_ALL ||
					     (int)from->views[i].split == options->split)
			bad = add_view(d, &from->views[i], e);
	return bad ? -1 : 0;
}

static void free_wholes(struct drawing *d)
{
	for (size_t k = 0; d->wholes && k < d->request->responses.answers; k++)
		splats_free(&d->wholes[k]);
	free(d->wholes);
	d->wholes = NULL;
}

/* What all sentences mean, said from a viewpoint or each from its own. */
static int answer(struct drawing *d, const struct viewpoint *from, struct err *e)
{
	struct request *r = d->request;

	free_wholes(d);
	int bad = request_answer(r, from, e) ||
		  !(d->wholes = mem_zalloc(r->responses.answers, sizeof *d->wholes, "objects", e));
	if (!bad && d->options->is_amodal)
		bad = responses_wholes(&r->responses, &r->scene.splats, &r->scene.cameras, d->wholes, e);
	return bad ? -1 : 0;
}

/* The point where the answer's responses are largest, if there are any above 0. */
static int find_peak(const struct drawing *d, const struct answer *a, struct mask *to, struct err *e)
{
	const struct camera *c = a->camera;
	int x, y;
	const int found = peak_find(a->image, c->height, c->width, (int)d->options->peak, &x, &y, e);

	if (found <= 0)
		return found;
	if (!(to->place = mask_place_new(e)))
		return -1;
	to->place->has_peak = 1;
	to->place->peak[0] = x;
	to->place->peak[1] = y;
	return 0;
}

/* One answer: its mask, and the pictures of all sentences that it is the answer to. */
static int put_answer(void *data, const struct answer *a, struct err *e)
{
	const struct drawing *d = data;
	const struct request *r = d->request;
	struct mask *to = &d->shown[a->view * r->responses.answers + a->answer];
	const struct camera *c = a->camera;
	int bad = rle_encode(&to->rle, a->mask, c->height, c->width, e);

	to->score = a->score;
	to->visible = a->visible;
	bad = bad || (d->options->peak && find_peak(d, a, to, e));
	for (size_t i = 0; i < r->count && !bad; i++) {
		char words[200];
		const struct picture picture = {c->name, r->text.refs[r->refs[i]], c->height, c->width,
			a->image, a->mask, a->rgb, {r->text.texts[r->refs[i]], words}};
		if (r->responses.answer[i] != a->answer)
			continue;
		overlay_words(r, i, a->score, words, sizeof words);
		bad = pictures_put(&d->options->pictures, &picture, e);
	}
	return bad;
}

/* The objects of an answer that is of several: parts (objects of the model). Returns how many. */
static size_t list_parts(const struct request *r, const struct mask *shown, size_t answer, struct mask *parts)
{
	const struct responses *a = &r->responses;
	const size_t n = a->alone ? a->begin[answer + 1] - a->begin[answer] : 0;

	for (size_t k = 0; k < n; k++) {
		const size_t at = a->begin[answer] + k, o = a->objects[at];
		parts[k] = shown[a->alone[at]];
		parts[k].object = r->model.lifted.names[o];
		parts[k].score = rle_area(&parts[k].rle) ? (double)r->model.lifted.confidence[o] : 0;
	}
	return n > 1 ? n : 0;
}

/* Of a sentence of motion its time; whether a view is of that. */
static int is_then(const struct drawing *d, size_t i, size_t view, struct mask_place *place)
{
	const struct request *r = d->request;
	const double *when = r->responses.when ? r->responses.when[i] : NULL,
		     at = r->options->time ? *r->options->time : d->views[d->first + view].time;

	if (!when || isnan(when[0]))
		return 1;
	place->has_when = 1;
	memcpy(place->when, when, sizeof place->when);
	return at >= when[0] && at <= when[1];
}

static int put_sentence(const struct drawing *d, size_t i, size_t view, const struct mask *shown,
	struct mask *parts, struct err *e)
{
	const struct request *r = d->request;
	const size_t answer = r->responses.answer[i];
	struct mask m = shown[answer];
	struct mask_place place = m.place ? *m.place : (struct mask_place){0};
	uint32_t all = (uint32_t)m.rle.height * (uint32_t)m.rle.width;

	m.view = d->views[d->first + view].name;
	m.ref = r->text.refs[r->refs[i]];
	if (!is_then(d, i, view, &place) && d->options->is_when)
		m.rle = (struct rle){.height = m.rle.height, .width = m.rle.width, .n = 1, .runs = &all};
	m.place = m.place || place.has_when ? &place : NULL;
	m.object = text_object(&r->text, r->refs[i]);
	if (r->responses.sure)
		m.score = rle_area(&m.rle) ? r->responses.sure[i] : 0;
	return d->put(d->data, &m, parts, list_parts(r, shown, answer, parts), e);
}

static int put_view(void *data, size_t view, struct err *e)
{
	struct drawing *d = data;
	const struct request *r = d->request;
	struct mask *shown = d->shown + view * r->responses.answers;
	SCOPED struct mask *parts = mem_alloc(r->model.lifted.objects, sizeof *parts, "masks", e);
	int bad = !parts;

	for (size_t i = 0; i < r->count && !bad; i++)
		bad = put_sentence(d, i, view, shown, parts, e);
	for (size_t k = 0; k < r->responses.answers; k++)
		mask_free(&shown[k]);
	report_step(d->to, (double)(d->first + view) + 1, NULL);
	return bad;
}

/* The views from d->first on. */
static int render(struct drawing *d, size_t views, struct err *e)
{
	const struct request *r = d->request;
	const struct pictures *pictures = &d->options->pictures;
	const struct answer_question q = {.splats = &r->scene.splats,
		.responses = &r->responses,
		.wholes = d->options->is_amodal ? d->wholes : NULL,
		.wants_rgb = pictures->overlays != NULL,
		.wants_images = pictures->responses != NULL};
	const struct answer_calls calls = {d, put_answer, put_view};
	size_t count = r->responses.answers;

	if (mem_size(count, views, &count))
		return err_set(e, ERR_SYSTEM, "masks do not fit in memory");
	d->shown = mem_zalloc(count, sizeof *d->shown, "masks", e);
	int bad = !d->shown || answer_all(&q, d->views + d->first, views, &calls, e) ? -1 : 0;
	for (size_t i = 0; d->shown && i < count; i++)
		mask_free(&d->shown[i]);
	free(d->shown);
	d->shown = NULL;
	return bad;
}

/* Of a scene that moves each view shows its own time, and sentences are judged at that. */
static int render_all(struct drawing *d, const struct viewpoint *from, struct err *e)
{
	struct scene *scene = &d->request->scene;
	const int is_moving = scene->motion.times && !d->request->options->time;
	double at = NAN;
	int bad = 0;

	if (!d->options->is_each && !is_moving)
		return answer(d, from, e) || render(d, d->view_count, e);
	for (d->first = 0; d->first < d->view_count && !bad; d->first++) {
		const struct camera *view = &d->views[d->first];
		const struct viewpoint own = {.kind = VIEWPOINT_CAMERA, .camera = view};
		const int is_new = d->options->is_each || !(view->time == at);
		bad = (is_moving && scene_move_to_view(scene, view, e)) ||
		      (is_new && answer(d, d->options->is_each ? &own : from, e)) || render(d, 1, e);
		at = view->time;
	}
	return bad;
}

int draw_each(struct drawing *d, const struct viewpoint *from, const struct report *to, struct err *e)
{
	d->to = to;
	report_start(to, "views", (double)d->view_count);
	const int bad = render_all(d, from, e);
	report_end(to);
	return bad;
}

static int put_line(void *out, const struct mask *m, const struct mask *parts, size_t n, struct err *e)
{
	return masks_put_parts(out, m, parts, n, e);
}

int draw(struct drawing *d, const struct viewpoint *from, const char *path, const struct report *to,
	struct err *e)
{
	struct file_out out;

	if (file_out_open(&out, path, e))
		return -1;
	d->put = put_line;
	d->data = out.stream;
	return file_out_end(&out, draw_each(d, from, to, e), e);
}

void drawing_free(struct drawing *d)
{
	if (d->request)
		free_wholes(d);
	free(d->views);
	if (d->names)
		mem_free_strings(d->names, d->view_count);
}
