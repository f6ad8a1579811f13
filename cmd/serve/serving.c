/* One thread has the scene, as a chooser and an encoder are for one thread: requests wait for it in the order
 * in which they came, and the questions among them are encoded together. */
#include "cmd/serve/serving.h"

#include "base/file.h"
#include "base/mem.h"
#include "cmd/text/encode.h"
#include "formats/records/json.h"

#include <omp.h>

enum { AT_ONCE = 16 /* questions that are encoded together */ };

static void expect(struct serving *s, const struct serving_job *jobs)
{
	const char *questions[AT_ONCE];
	size_t n = 0;

	for (const struct serving_job *j = jobs; j && n < AT_ONCE; j = j->next)
		if (j->question)
			questions[n++] = j->question;
	asking_expect(s->asking, questions, n);
}

static void finish(struct serving *s, struct serving_job *job, int result)
{
	pthread_mutex_lock(&s->lock);
	job->result = result;
	job->is_done = 1;
	pthread_cond_broadcast(&s->done);
	pthread_mutex_unlock(&s->lock);
}

static void *work(void *data)
{
	struct serving *s = data;

	omp_set_num_threads(s->threads); /* a thread does not inherit that */
	for (;;) {
		pthread_mutex_lock(&s->lock);
		while (!s->first && !s->is_ending)
			pthread_cond_wait(&s->come, &s->lock);
		struct serving_job *jobs = s->first;
		s->first = NULL;
		pthread_mutex_unlock(&s->lock);
		if (!jobs)
			return NULL;
		expect(s, jobs);
		for (struct serving_job *next; jobs; jobs = next) {
			next = jobs->next; /* a job that is done is its caller's */
			finish(s, jobs, jobs->run(s, jobs->data, jobs->e));
		}
	}
}

int serving_do(struct serving *s, struct serving_job *job)
{
	pthread_mutex_lock(&s->lock);
	struct serving_job **last = &s->first;
	while (*last)
		last = &(*last)->next;
	*last = job;
	pthread_cond_signal(&s->come);
	while (!job->is_done)
		pthread_cond_wait(&s->done, &s->lock);
	pthread_mutex_unlock(&s->lock);
	return job->result;
}

static int start(struct serving *s, struct err *e)
{
	if (pthread_mutex_init(&s->lock, NULL) || pthread_mutex_init(&s->labelling, NULL) ||
		pthread_cond_init(&s->come, NULL) || pthread_cond_init(&s->done, NULL) ||
		pthread_create(&s->thread, NULL, work, s))
		return err_set(e, ERR_SYSTEM, "threads: cannot be made");
	s->is_started = 1;
	return 0;
}

int serving_open(
	struct serving *s, const struct serving_options *options, const struct report *to, struct err *e)
{
	s->options = options;
	s->threads = omp_get_max_threads();
	s->to = to;
	s->asking_options = (struct asking_options){.run = options->run,
		.given.encoder = options->encoder,
		.least = options->least,
		.may_be_nameless = 1};
	s->labels = options->labels ? mem_strdup(options->labels, e)
				    : file_join(options->run, "labels.jsonl", "", e);
	s->asking = mem_zalloc(1, sizeof *s->asking, "scene", e);
	if (!s->labels || !s->asking || asking_open(s->asking, &s->asking_options, e))
		return -1;
	s->viewer = options->viewer ? mem_strdup(options->viewer, e) : cache_folder("viewer", e);
	if (s->viewer && !file_is_dir(s->viewer)) {
		free(s->viewer);
		s->viewer = NULL;
	}
	s->scene_path = mem_strdup(s->asking->files.scene, e);
	return !s->scene_path || scene_read_cameras(&s->cameras, s->scene_path, e) ||
			       serving_labels_open(s, e) || start(s, e)
		       ? -1
		       : serving_labels_refresh(s, e);
}

void serving_close(struct serving *s)
{
	if (s->is_started) {
		pthread_mutex_lock(&s->lock);
		s->is_ending = 1;
		pthread_cond_signal(&s->come);
		pthread_mutex_unlock(&s->lock);
		pthread_join(s->thread, NULL);
	}
	serving_labels_close(s);
	serving_forget(s);
	if (s->asking)
		asking_close(s->asking);
	cameras_free(&s->cameras);
	mem_free_all(s->asking, s->viewer, s->labels, s->scene_path);
	mem_free_strings(s->labelled, s->labelled_count);
}

int serving_text_open(struct serving_text *t, struct err *e)
{
	*t = (struct serving_text){0};
	t->out = open_memstream(&t->bytes, &t->length);
	return t->out ? 0 : err_set(e, ERR_SYSTEM, "reply: out of memory");
}

int serving_text_end(struct serving_text *t, int bad, struct serving_reply *to, struct err *e)
{
	if (fclose(t->out) && !bad)
		bad = err_set(e, ERR_SYSTEM, "reply: out of memory");
	*to = (struct serving_reply){"application/json", t->bytes, t->length};
	return bad;
}

int serving_view(const struct serving *s, const cJSON *body, const char *key, size_t *view, struct err *e)
{
	const char *name;

	if (json_string(body, key, 1, &name, "request", e) < 0)
		return -1;
	for (*view = 0; *view < s->cameras.n; ++*view)
		if (!strcmp(s->cameras.views[*view].name, name))
			return 0;
	return err_set(e, ERR_CHECK, "no view '%s'", name);
}

size_t serving_thing(const struct lifted *l, const char *name)
{
	for (size_t o = 0; o < l->objects; o++)
		if (!strcmp(l->names[o], name))
			return o;
	return ASKING_NONE;
}

void serving_put_mask(struct jsontext *to, const char *view, const struct rle *mask)
{
	jsontext_open(to, NULL, '{');
	jsontext_string(to, "view", view);
	jsontext_number(to, "height", mask->height);
	jsontext_number(to, "width", mask->width);
	jsontext_open(to, "counts", '[');
	for (size_t k = 0; k < mask->n; k++)
		jsontext_number(to, NULL, mask->runs[k]);
	jsontext_close(to, ']');
	jsontext_close(to, '}');
}

int serving_answer(struct serving *s, const char *what, const cJSON *body, int may_write,
	struct serving_reply *to, struct err *e)
{
	static const struct {
		const char *what;
		int (*answer)(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e);
	} all[] = {{"ask", serving_ask}, {"pick", serving_pick}, {"things", serving_things},
		{"splats", serving_splats}, {"view", serving_picture}, {"mask", serving_mask}};

	*to = (struct serving_reply){0};
	if (!strcmp(what, "label"))
		return serving_label(s, body, may_write, to, e);
	for (size_t k = 0; k < sizeof all / sizeof *all; k++)
		if (!strcmp(what, all[k].what))
			return all[k].answer(s, body, to, e);
	return err_set(e, ERR_CHECK,
		"no '%s' here: ask, pick, label, things, splats, view and mask are what there is", what);
}
