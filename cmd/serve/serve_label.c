/* What a person names: by clicks on regions, or by an outline. Records of masks in one file, as pipelines
 * read them, and a lifted model of them beside the folder's own (cmd/ask/asking.h). The model is made before
 * the file changes, so that what cannot be lifted is not kept. */
#include "cmd/serve/serving.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "cmd/lift/lifting.h"
#include "cmd/text/encode.h"
#include "formats/records/json.h"
#include "formats/records/masks.h"
#include "formats/scene/lifted.h"

#include <math.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { NAME_BYTES = 200 };
enum { TRIES = 50 /* tenths of a second that another writer of the labels is waited for */ };

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

static void *look_at_all(void *data)
{
	struct serving *s = data;
	struct err ignored; /* a click has it again */

	for (size_t v = 0; v < s->cameras.n; v++) {
		pthread_mutex_lock(&s->labelling);
		if (s->is_looking)
			pointing_look(&s->pointing, v, &ignored);
		pthread_mutex_unlock(&s->labelling);
	}
	return NULL;
}

void serving_labels_look(struct serving *s)
{
	s->is_looking = s->can_click;
	if (s->is_looking && pthread_create(&s->looker, NULL, look_at_all, s))
		s->is_looking = 0;
}

void serving_labels_close(struct serving *s)
{
	if (s->is_looking) {
		pthread_mutex_lock(&s->labelling);
		s->is_looking = 0;
		pthread_mutex_unlock(&s->labelling);
		pthread_join(s->looker, NULL);
	}
	pointing_free(&s->pointing);
	free(s->weights);
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

static int add_masks(struct serving *s, const struct serving_label *l, struct masks *all, struct err *e)
{
	for (size_t v = 0; v < s->cameras.n; v++) {
		struct mask m = {.score = NAN, .visible = NAN};
		size_t area;
		if (serving_find_mask(s, l, v, &m.rle, &area, e))
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

static int change(struct serving *s, const struct serving_label *l, struct masks *all, struct err *e)
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

	return file_out_end(&out, file_out_open(&out, path, e) || put_masks(out.stream, all, e), e);
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
	const struct lifting_files files = {s->scene_path, s->weights, text, masks, NULL, NULL};
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

/* What conversations were about, which has another number now, or is gone. */
static void move_talks(struct serving *s, const struct lifted *before, const struct lifted *now)
{
	for (struct serving_talk *t = s->talks; t < s->talks + SERVING_TALKS; t++) {
		if (!t->used || t->talk.thing == ASKING_NONE)
			continue;
		t->talk.thing = serving_thing(now, before->names[t->talk.thing]);
		if (t->talk.thing == ASKING_NONE)
			t->talk = (struct talk)TALK_NEW;
	}
}

static int take_fresh(struct serving *s, void *data, struct err *e)
{
	struct fresh *f = data;
	struct asking *before = s->asking;

	move_talks(s, &before->model.lifted, &f->asking->model.lifted);
	s->asking = f->asking;
	f->asking = before;
	pthread_mutex_lock(&s->lock);
	serving_forget(s);
	pthread_mutex_unlock(&s->lock);
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

int serving_labels_refresh(struct serving *s, struct err *e)
{
	SCOPED char *model = part(s, "lifted/labels.safetensors", e);
	SCOPED_BY(masks_free) struct masks all = {0};
	struct stat labels, lifted;

	if (!model || !s->weights || stat(s->labels, &labels))
		return model ? 0 : -1;
	if (!stat(model, &lifted) && lifted.st_mtim.tv_sec >= labels.st_mtim.tv_sec)
		return 0;
	return read_labels(s, &all, e) || (all.n && (lift(s, &all, e) || read_again(s, &all, e))) ? -1 : 0;
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

static int keep(struct serving *s, const struct serving_label *l, struct serving_reply *to, struct err *e)
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
	*name = name_trim(json_member(body, key)->valuestring);
	if (name_fault(*name, NAME_DATA, fault))
		return serving_faulty(e, key, name_fault(*name, NAME_DATA, fault));
	return strlen(*name) > NAME_BYTES ? serving_faulty(e, key, "is longer than 200 bytes") : 0;
}

static int label(struct serving *s, const cJSON *body, int may_write, struct serving_reply *to, struct err *e)
{
	struct serving_label l = {.views = json_member(body, "views")};

	if (take_name(body, "name", &l.name, e) || take_name(body, "remove", &l.remove, e) ||
		take_name(body, "rename", &l.rename, e))
		return -1;
	if ((l.name || l.remove) && !may_write)
		return err_set(
			e, ERR_USAGE, "the token is missing, or another: what keeps something needs it");
	if (l.rename && !l.name)
		return serving_faulty(e, "name", "is missing: what shall have another name");
	int bad = !l.remove && !l.rename && serving_take_place(s, body, &l, e);
	if (!bad)
		bad = l.name || l.remove ? keep(s, &l, to, e) : serving_preview(s, &l, to, e);
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
