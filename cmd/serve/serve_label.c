/* What a person names: by clicks on regions, or by an outline. Records of masks in one file, as pipelines
 * read them, and a lifted model of them beside the folder's own (cmd/ask/asking.h). The model is made before
 * the file changes, so that what cannot be lifted is not kept. */
#include "cmd/serve/serving.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/threads.h"
#include "cmd/lift/lifting.h"
#include "cmd/text/encode.h"
#include "formats/records/json.h"
#include "formats/records/masks.h"
#include "formats/scene/lifted.h"
#include "mask/polygon.h"

#include <math.h>
#include <time.h>
#include <unistd.h>

enum { OUTLINE_POINTS = 20000, CLICKS = 1000, NAME_BYTES = 200 };
enum { TRIES = 50 /* tenths of a second that another writer of the labels is waited for */ };

/* What a request says. */
struct label {
	const char *name, *remove, *rename;
	size_t view;	    /* of the first place */
	const cJSON *views; /* whose masks are wanted; NULL: that view's */
	struct rle outline; /* in that view; runs are NULL where regions are meant */
};

static char *part(const struct serving *s, const char *name, struct err *e)
{
	return file_join(s->options->run, name, "", e);
}

static int keep_names(struct serving *s, const struct masks *all, struct err *e)
{
	char **names = mem_zalloc(all->n, sizeof *names, "labels", e);
	size_t n = 0;

	for (size_t k = 0; k < all->n && names; k++) {
		size_t earlier = 0;
		while (earlier < n && strcmp(names[earlier], mask_object(&all->items[k])) != 0)
			earlier++;
		if (earlier == n && (names[n] = mem_strdup(mask_object(&all->items[k]), e)))
			n++;
	}
	if (!names)
		return -1;
	mem_free_strings(s->labelled, s->labelled_count);
	s->labelled = names;
	s->labelled_count = n;
	return 0;
}

static int read_labels(const struct serving *s, struct masks *all, struct err *e)
{
	return file_exists(s->labels) ? masks_read(all, s->labels, e) : 0;
}

int serving_labels_open(struct serving *s, struct err *e)
{
	SCOPED char *regions = part(s, "regions.safetensors", e);
	SCOPED_BY(masks_free) struct masks all = {0};

	s->weights = part(s, "weights", e);
	if (!regions || !s->weights || read_labels(s, &all, e) || keep_names(s, &all, e))
		return -1;
	if (!file_is_dir(s->weights)) {
		free(s->weights);
		s->weights = NULL;
	}
	s->can_click = s->weights && file_exists(regions);
	return s->can_click ? pointing_open(&s->pointing, s->scene_path, regions, s->weights, e) : 0;
}

void serving_labels_close(struct serving *s)
{
	pointing_free(&s->pointing);
	free(s->weights);
}

static int faulty(struct err *e, const char *key, const char *why)
{
	return err_set(e, ERR_FORMAT, "request: key '%s' %s", key, why);
}

/* One of "points" or "outside". */
static int take_click(struct serving *s, const cJSON *click, const char *key, struct label *l, struct err *e)
{
	double at[2];
	size_t view;

	if (!cJSON_IsObject(click))
		return faulty(e, key, "is no list of {\"view\",\"x\",\"y\"}");
	if (serving_view(s, click, "view", &view, e) || json_number(click, "x", 1, at, "request", e) < 0 ||
		json_number(click, "y", 1, at + 1, "request", e) < 0)
		return -1;
	const struct camera *c = &s->cameras.views[view];
	if (!(at[0] >= 0 && at[1] >= 0 && at[0] < c->width && at[1] < c->height))
		return err_set(e, ERR_FORMAT,
			"request: key '%s': %g, %g is outside of view '%s', which is %dx%d", key, at[0],
			at[1], c->name, c->width, c->height);
	if (!s->pointing.click_count)
		l->view = view;
	at[0] /= c->width;
	at[1] /= c->height;
	return pointing_click(&s->pointing, view, at, !strcmp(key, "outside"), e);
}

static int take_clicks(struct serving *s, const cJSON *body, const char *key, struct label *l, struct err *e)
{
	const cJSON *list = json_member(body, key), *click;

	if (list && (!cJSON_IsArray(list) || cJSON_GetArraySize(list) > CLICKS))
		return faulty(e, key, "is no list of at most 1000 places");
	cJSON_ArrayForEach(click, list)
	{
		if (take_click(s, click, key, l, e))
			return -1;
	}
	return 0;
}

static int take_box(struct serving *s, const cJSON *box, struct label *l, struct err *e)
{
	double at[4];

	if (serving_view(s, box, "view", &l->view, e) || json_matrix(box, "box", 4, 0, at, "request", e))
		return -1;
	for (int k = 0; k < 4; k++)
		at[k] /= k % 2 ? s->cameras.views[l->view].height : s->cameras.views[l->view].width;
	return pointing_choose_boxed(&s->pointing, l->view, at, e);
}

/* A mask as large as the view's weights would do, and is not worth knowing: half the view. */
static int take_outline(struct serving *s, const cJSON *outline, struct label *l, struct err *e)
{
	const cJSON *points = json_member(outline, "points"), *point;
	const int n = cJSON_GetArraySize(points);
	int height, width;
	size_t k = 0;

	if (serving_view(s, outline, "view", &l->view, e))
		return -1;
	if (!cJSON_IsArray(points) || n < 3 || n > OUTLINE_POINTS)
		return faulty(e, "points", "is no list of 3 to 20000 [x,y]");
	const struct camera *c = &s->cameras.views[l->view];
	camera_scaled_size(c, .5, &height, &width);
	camera_scaled_size(c, .5, &width, &height);
	const size_t pixels = (size_t)height * (size_t)width;
	SCOPED double *x = mem_alloc((size_t)n, 2 * sizeof *x, "outline", e);
	SCOPED uint8_t *mask = mem_zalloc(pixels, 1, "outline", e),
		       *flips = mem_zalloc(pixels, 1, "outline", e);
	if (!x || !mask || !flips)
		return -1;
	cJSON_ArrayForEach(point, points)
	{
		if (json_numbers(point, 2, x + k))
			return faulty(e, "points", "is no list of 3 to 20000 [x,y]");
		x[k] = fmin(fmax(x[k], -1e6), 1e6) * width / c->width;
		x[k + 1] = fmin(fmax(x[k + 1], -1e6), 1e6) * height / c->height;
		k += 2;
	}
	polygon_fill(mask, flips, height, width, x, (size_t)n);
	if (!memchr(mask, 1, pixels))
		return faulty(e, "points", "go around no pixel of the view");
	return rle_encode(&l->outline, mask, height, width, e);
}

/* What is meant: the outline, or s->pointing's regions. */
static int take_place(struct serving *s, const cJSON *body, struct label *l, struct err *e)
{
	const cJSON *box = json_member(body, "box"), *outline = json_member(body, "outline");
	double size = 0;

	if (!s->weights)
		return err_set(e, ERR_CHECK,
			"%s: no weights in it, which labels need: 'make -f pipelines/lift.mk regions SCENE=%s ...' makes them",
			s->options->run, s->options->run);
	if (outline)
		return take_outline(s, outline, l, e);
	if (!s->can_click)
		return err_set(e, ERR_CHECK,
			"%s: no regions in it, which clicks need: 'make -f pipelines/lift.mk regions SCENE=%s ...' finds them; an outline needs none",
			s->options->run, s->options->run);
	s->pointing.click_count = 0;
	if (box)
		return take_box(s, box, l, e);
	if (take_clicks(s, body, "points", l, e) || take_clicks(s, body, "outside", l, e) ||
		json_number(body, "size", 0, &size, "request", e) < 0)
		return -1;
	if (!s->pointing.click_count)
		return faulty(e, "points", "is missing: points, a box or an outline say what is meant");
	return pointing_choose(&s->pointing, (int)fmin(fmax(size, -CLICKS), CLICKS), e);
}

/* *area 0 where the view shows nothing of it. */
static int find_mask(
	struct serving *s, const struct label *l, size_t view, struct rle *mask, size_t *area, struct err *e)
{
	*mask = (struct rle){0};
	*area = 0;
	if (!l->outline.runs)
		return pointing_mask(&s->pointing, view, mask, area, e);
	if (view != l->view)
		return 0;
	*area = rle_area(&l->outline);
	return rle_from_runs(mask, l->outline.runs, l->outline.n, l->outline.height, l->outline.width, e);
}

static int put_preview(
	struct serving *s, const struct label *l, struct jsontext *to, size_t view, struct err *e)
{
	SCOPED_BY(rle_free) struct rle mask = {0};
	size_t area;

	if (find_mask(s, l, view, &mask, &area, e))
		return -1;
	if (area)
		serving_put_mask(to, s->cameras.views[view].name, &mask);
	return 0;
}

static int preview(struct serving *s, const struct label *l, struct serving_reply *to, struct err *e)
{
	struct serving_text text;
	const cJSON *name;
	int bad = 0;

	if (serving_text_open(&text, e))
		return -1;
	struct jsontext json = {.out = text.out};
	jsontext_open(&json, NULL, '{');
	jsontext_open(&json, "masks", '[');
	if (!l->views)
		bad = put_preview(s, l, &json, l->view, e);
	cJSON_ArrayForEach(name, l->views)
	{
		for (size_t v = 0; v < s->cameras.n && !bad; v++)
			if (cJSON_IsString(name) && !strcmp(name->valuestring, s->cameras.views[v].name))
				bad = put_preview(s, l, &json, v, e);
	}
	jsontext_close(&json, ']');
	jsontext_close(&json, '}');
	fputc('\n', text.out);
	return serving_text_end(&text, bad, to, e);
}

/* Takes what has a name out of the masks, or gives it another. Returns how many. */
static size_t change_named(struct masks *all, const char *name, const char *other, struct err *e)
{
	size_t n = 0, found = 0;

	for (size_t k = 0; k < all->n; k++) {
		struct mask *m = &all->items[k];
		const int is_it = !strcmp(mask_object(m), name);
		found += is_it;
		if (is_it && !other) {
			mask_free(m);
			continue;
		}
		if (is_it) {
			free((void *)(uintptr_t)m->object);
			m->object = mem_strdup(other, e);
		}
		all->items[n++] = *m;
	}
	all->n = n;
	return found;
}

static int add_masks(struct serving *s, const struct label *l, struct masks *all, struct err *e)
{
	for (size_t v = 0; v < s->cameras.n; v++) {
		struct mask m = {.score = NAN, .visible = NAN};
		size_t area;
		if (find_mask(s, l, v, &m.rle, &area, e))
			return -1;
		if (!area) {
			rle_free(&m.rle);
			continue;
		}
		m.view = mem_strdup(s->cameras.views[v].name, e);
		m.object = mem_strdup(l->name, e);
		if (masks_add(all, &m, e) || !m.view || !m.object)
			return -1;
	}
	return 0;
}

static int change(struct serving *s, const struct label *l, struct masks *all, struct err *e)
{
	if (l->remove || l->rename) {
		const char *name = l->remove ? l->remove : l->name;
		if (l->rename && change_named(all, l->rename, l->rename, e))
			return err_set(
				e, ERR_FORMAT, "request: '%s' is the name of another label", l->rename);
		return change_named(all, name, l->rename, e) ? 0
							     : err_set(e, ERR_CHECK, "no label '%s'", name);
	}
	change_named(all, l->name, NULL, e);
	return add_masks(s, l, all, e);
}

static int put_masks(FILE *out, const struct masks *all, struct err *e)
{
	for (size_t k = 0; k < all->n; k++)
		if (masks_put(out, &all->items[k], e))
			return -1;
	return 0;
}

static int write_masks(const char *path, const struct masks *all, struct err *e)
{
	struct file_out out;

	return file_out_open(&out, path, e) ? -1 : file_out_end(&out, put_masks(out.stream, all, e), e);
}

static int encode_names(const struct serving *s, const char *masks, const char *text, struct err *e)
{
	SCOPED_BY(encoding_free) struct encoding x = {0};

	return encoding_read(&x, masks, 1, e) || encode(&x, &s->asking->encoder, s->to, e) ||
			       text_write(&x.text, text, "", e)
		       ? -1
		       : 0;
}

static int lift_model(
	const struct serving *s, const char *masks, const char *text, const char *model, struct err *e)
{
	const struct lifting_files files = {s->scene_path, s->weights, text, masks, NULL};
	SCOPED_BY(lifting_free) struct lifting l = {0};
	size_t moved;

	if (lifting_read(&l, &files, s->to, e) || lifting_make(&l, 1, &moved, s->to, e))
		return -1;
	const struct origin origin = {l.scene.fingerprint, l.text.encoder};
	return lifted_write(&l.model, &origin, model, "--names masks", e);
}

/* RUN/lifted/labels.safetensors of the masks; none of no masks. */
static int lift(const struct serving *s, const struct masks *all, struct err *e)
{
	SCOPED char *folder = part(s, "lifted", e), *masks = part(s, "lifted/labels.jsonl", e),
		    *text = part(s, "lifted/labels.text.safetensors", e),
		    *model = part(s, "lifted/labels.safetensors", e);

	if (!folder || !masks || !text || !model || file_make_dir(folder, e))
		return -1;
	if (!all->n)
		return unlink(model) && file_exists(model) ? err_errno(e, "%s", model) : 0;
	const int bad = write_masks(masks, all, e) || encode_names(s, masks, text, e) ||
			lift_model(s, masks, text, model, e);
	unlink(masks);
	unlink(text);
	return bad ? -1 : 0;
}

struct fresh {
	struct asking *asking;
	const struct masks *all;
};

static int take_fresh(struct serving *s, void *data, struct err *e)
{
	struct fresh *f = data;
	struct asking *before = s->asking;

	s->asking = f->asking;
	f->asking = before;
	s->revision++;
	return keep_names(s, f->all, e);
}

static int read_again(struct serving *s, const struct masks *all, struct err *e)
{
	struct fresh f = {mem_zalloc(1, sizeof *f.asking, "scene", e), all};
	struct serving_job job = {.run = take_fresh, .data = &f, .e = e};

	if (!f.asking)
		return -1;
	const int bad = asking_open(f.asking, &s->asking_options, e) || serving_do(s, &job);
	asking_close(f.asking);
	free(f.asking);
	return bad;
}

/* Nobody else writes the labels until *out is ended. */
static int claim(const struct serving *s, struct file_out *out, struct err *e)
{
	const struct timespec tenth = {.tv_nsec = 100000000};
	int bad = -1;

	for (int k = 0; k < TRIES && bad; k++) {
		if (k)
			nanosleep(&tenth, NULL);
		bad = file_out_claim(out, s->labels, e);
	}
	return bad;
}

static int keep(struct serving *s, const struct label *l, struct serving_reply *to, struct err *e)
{
	SCOPED_BY(masks_free) struct masks all = {0};
	struct timespec start, end;
	struct serving_text text;
	struct file_out out;

	clock_gettime(CLOCK_MONOTONIC, &start);
	if (claim(s, &out, e))
		return -1;
	const int bad = read_labels(s, &all, e) || change(s, l, &all, e) || lift(s, &all, e) ||
			put_masks(out.stream, &all, e);
	if (file_out_end(&out, bad, e) || read_again(s, &all, e) || serving_text_open(&text, e))
		return -1;
	clock_gettime(CLOCK_MONOTONIC, &end);
	struct jsontext json = {.out = text.out};
	jsontext_open(&json, NULL, '{');
	jsontext_string(&json, "name", l->rename ? l->rename : l->remove ? l->remove : l->name);
	jsontext_number(&json, "revision", (double)s->revision);
	jsontext_rounded(&json, "seconds",
		(double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec));
	jsontext_open(&json, "labels", '[');
	for (size_t k = 0; k < s->labelled_count; k++)
		jsontext_string(&json, NULL, s->labelled[k]);
	jsontext_close(&json, ']');
	jsontext_close(&json, '}');
	fputc('\n', text.out);
	return serving_text_end(&text, 0, to, e);
}

static int take_name(const cJSON *body, const char *key, const char **name, struct err *e)
{
	char fault[NAME_FAULT];
	const int got = json_string(body, key, 0, name, "request", e);

	if (got <= 0)
		return got;
	if (name_fault(*name, NAME_DATA, fault))
		return faulty(e, key, name_fault(*name, NAME_DATA, fault));
	return strlen(*name) > NAME_BYTES ? faulty(e, key, "is longer than 200 bytes") : 0;
}

static int label(struct serving *s, const cJSON *body, int may_write, struct serving_reply *to, struct err *e)
{
	struct label l = {.views = json_member(body, "views")};

	if (take_name(body, "name", &l.name, e) || take_name(body, "remove", &l.remove, e) ||
		take_name(body, "rename", &l.rename, e))
		return -1;
	if ((l.name || l.remove) && !may_write)
		return err_set(
			e, ERR_USAGE, "the token is missing, or another: what keeps something needs it");
	if (l.rename && !l.name)
		return faulty(e, "name", "is missing: what shall have another name");
	int bad = !l.remove && !l.rename && take_place(s, body, &l, e);
	if (!bad)
		bad = l.name || l.remove ? keep(s, &l, to, e) : preview(s, &l, to, e);
	rle_free(&l.outline);
	return bad ? -1 : 0;
}

int serving_label(
	struct serving *s, const cJSON *body, int may_write, struct serving_reply *to, struct err *e)
{
	pthread_mutex_lock(&s->labelling);
	const int bad = label(s, body, may_write, to, e);
	pthread_mutex_unlock(&s->labelling);
	return bad;
}
