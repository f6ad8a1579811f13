/* A folder may lack anything but the scene and one set of answers. What is there is found by its usual name
 * (pipelines/two-stage.mk, lift.mk). */
#include "cmd/report/reporting.h"

#include "base/file.h"
#include "base/mem.h"
#include "score/score_choice.h"

/* Where each set of answers is, and the sentences that it answers. */
static const struct {
	const char *way, *name, *text, *masks;
} places[REPORT_SETS] = {
	{"lifted", "test", "text.safetensors", "lifted/predictions.test.jsonl"},
	{"lifted", "asked", "lifted/asked.safetensors", "lifted/asked.jsonl"},
	{"lifted", "train", "text.safetensors", "lifted/predictions.train.jsonl"},
	{"stage2", "test", "text.safetensors", "stage2/predictions.test.jsonl"},
	{"stage2", "train", "text.safetensors", "stage2/predictions.train.jsonl"},
	{"stage1", "test", "text.safetensors", "stage1/predictions.test.jsonl"},
	{"stage1", "train", "text.safetensors", "stage1/predictions.train.jsonl"},
};

/* The path of a part of the folder; NULL where it is not there, or memory is out: then *e is set. */
static char *part(const struct report_run *r, const char *name, struct err *e)
{
	return file_find(r->options->run, name, e);
}

static int read_scene(struct report_run *r, struct err *e)
{
	const char *run = r->options->run;

	if (!file_exists(run))
		return err_set(e, ERR_SYSTEM, "%s: No such file or directory", run);
	SCOPED char *path = part(r, "scene", e);
	if (!path)
		return err_set(e, ERR_SYSTEM,
			"%s: no scene in it: 'make -f pipelines/lift.mk SCENE=%s ...' makes one", run, run);
	return scene_read(&r->scene, path, e);
}

static int read_lifted(struct report_run *r, struct err *e)
{
	r->lifted_path = part(r, "lifted/model.safetensors", e);
	if (!r->lifted_path)
		return 0;
	if (anymodel_read(&r->lifted, r->lifted_path, e))
		return -1;
	r->has_lifted = r->lifted.is_lifted && r->lifted.lifted.gaussians == r->scene.splats.n;
	return r->has_lifted ? 0
			     : err_set(e, ERR_FORMAT, "%s: is of another scene, or no model of refer-lift",
				       r->lifted_path);
}

/* The file that the pipeline scored against, as log/score.command ends with it. */
static int find_truth(struct report_run *r, struct err *e)
{
	static const char before[] = " --truth ";
	SCOPED char *path = NULL, *command = NULL;
	size_t length;

	if (r->options->truth)
		return (r->truth_path = mem_strdup(r->options->truth, e)) ? 0 : -1;
	if (!(path = part(r, "log/score.command", e)))
		return 0;
	if (file_read(path, &command, &length, e))
		return -1;
	const char *at = strstr(command, before);
	if (at && at[sizeof before - 1] && file_exists(at + sizeof before - 1))
		return (r->truth_path = mem_strdup(at + sizeof before - 1, e)) ? 0 : -1;
	return 0;
}

/* Scores a set as `miou-score --predicted-views` does; every set has its own views. */
static int score_set(const struct report_run *r, struct report_set *s, struct err *e)
{
	size_t n = r->truth.n;

	s->truth = mem_alloc(n, sizeof *s->truth, "truth", e);
	if (!s->truth)
		return -1;
	for (size_t i = 0; i < n; i++)
		s->truth[i] = r->truth.set.items[i];
	if (score_keep_views(s->truth, &n, s->masks.set.items, s->masks.n, NULL, 0, e) ||
		score_match(&s->pairs, s->truth, n, s->masks.set.items, s->masks.n, e) ||
		score_measure_all(&s->pairs, e) || score_choices(&s->pairs, s->truth, n, e))
		return -1;
	score_sum(&s->sum, s->pairs.items, s->pairs.n);
	return 0;
}

static int read_set(struct report_run *r, size_t place, struct err *e)
{
	struct report_set *s = &r->sets[r->set_count];
	SCOPED char *text = part(r, places[place].text, e),
		    *masks = text ? part(r, places[place].masks, e) : NULL;
	int bad = 0;

	if (text && masks) {
		*s = (struct report_set){.way = places[place].way, .name = places[place].name};
		r->set_count++;
		bad = text_read(&s->text, text, e) || score_masks_read(&s->masks, masks, e) ||
		      masks_views(&s->masks.set, s->masks.lines, masks, &r->scene.cameras, NULL, NULL, e);
		bad = bad || (r->truth_path && score_set(r, s, e));
		s->masks.path = NULL;
	}
	return bad ? -1 : 0;
}

static int read_sets(struct report_run *r, const struct report *to, struct err *e)
{
	for (size_t k = 0; k < REPORT_SETS; k++)
		if (read_set(r, k, e))
			return -1;
	if (r->set_count)
		return 0;
	SCOPED char *text = part(r, "text.safetensors", e);
	if (!r->has_lifted || !text)
		return err_set(e, ERR_SYSTEM,
			"%s: no answers in it: 'make -f pipelines/lift.mk SCENE=%s ...' makes some",
			r->options->run, r->options->run);
	r->set_count = 1;
	r->sets[0] = (struct report_set){.way = "lifted", .name = "train"};
	return text_read(&r->sets[0].text, text, e) || report_answer(r, &r->sets[0], to, e) ||
	       (r->truth_path && score_set(r, &r->sets[0], e));
}

/* How much a view is worth a picture: 2 where there is truth of it, 1 where there are answers. */
static int worth(const struct report_run *r, const char *view)
{
	int best = 0;

	for (size_t k = 0; k < r->set_count && best < 2; k++) {
		const struct report_set *s = &r->sets[k];
		for (size_t i = 0; i < s->masks.n && !best; i++)
			best = !strcmp(s->masks.set.items[i].view, view);
		for (size_t i = 0; i < s->pairs.n && best < 2; i++)
			if (!strcmp(s->truth[s->pairs.items[i].truth_index].view, view))
				best = 2;
	}
	return best;
}

/* Views with truth come before others; of those that are alike, some that are spread evenly. */
static int choose_views(struct report_run *r, struct err *e)
{
	const struct cameras *c = &r->scene.cameras;
	const size_t most = (size_t)r->options->views;
	SCOPED int *worths = mem_alloc(c->n, sizeof *worths, "views", e);
	size_t of[3] = {0}, take[3] = {0}, at[3] = {0}, taken[3] = {0};

	if (!worths || !(r->shown = mem_alloc(c->n, sizeof *r->shown, "views", e)))
		return -1;
	for (size_t v = 0; v < c->n; v++)
		of[worths[v] = worth(r, c->views[v].name)]++;
	take[2] = of[2] < most ? of[2] : most;
	take[1] = of[1] < most - take[2] ? of[1] : most - take[2];
	for (size_t v = 0; v < c->n; v++) {
		const int w = worths[v];
		if (!w || taken[w] >= take[w] || at[w]++ != taken[w] * of[w] / take[w])
			continue;
		taken[w]++;
		const double scale = (double)r->options->width / c->views[v].width;
		r->shown[r->shown_count++] = camera_scaled(&c->views[v], scale < 1 ? scale : 1);
	}
	return 0;
}

int report_run_read(
	struct report_run *r, const struct report_options *options, const struct report *to, struct err *e)
{
	r->options = options;
	if (read_scene(r, e) || read_lifted(r, e) || find_truth(r, e) ||
		(r->truth_path && (score_masks_read(&r->truth, r->truth_path, e) ||
					  masks_views(&r->truth.set, r->truth.lines, r->truth_path,
						  &r->scene.cameras, NULL, NULL, e))) ||
		read_sets(r, to, e))
		return -1;
	return choose_views(r, e);
}

void report_run_free(struct report_run *r)
{
	for (size_t k = 0; k < r->set_count; k++) {
		text_free(&r->sets[k].text);
		score_pairs_free(&r->sets[k].pairs);
		free(r->sets[k].truth);
		score_masks_free(&r->sets[k].masks);
	}
	score_masks_free(&r->truth);
	anymodel_free(&r->lifted);
	scene_free(&r->scene);
	mem_free_all(r->lifted_path, r->truth_path, r->shown);
}
