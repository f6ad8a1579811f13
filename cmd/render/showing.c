#include "cmd/render/locating.h"

#include "base/file.h"
#include "base/mem.h"
#include "cmd/ask/reply.h"
#include "formats/splats/anysplats.h"
#include "formats/splats/ply.h"
#include "formats/splats/splat.h"
#include "splat/visibility.h"

int showing_open(struct showing *w, const struct scene *scene, const struct anymodel *model, struct err *e)
{
	const size_t n = scene->splats.n;

	*w = (struct showing){
		scene, model, mem_alloc(n, sizeof(float), "scene", e), mem_alloc(n, 1, "scene", e)};
	return !w->most || !w->of || visibility_most(&scene->splats, &scene->cameras, w->most, e) ? -1 : 0;
}

void showing_free(struct showing *w)
{
	mem_free_all(w->most, w->of);
}

int showing_things(struct splats *to, const struct showing *w, const size_t *things, size_t count,
	enum locate_show show, struct err *e)
{
	const struct splats *s = &w->scene->splats;

	*to = (struct splats){0};
	return -(locate_things(
			 w->of, &w->model->lifted, w->model->extents, things, count, show, s, w->most, e) ||
		 locate_show(to, s, w->of, show, e));
}

/* Of the only sentence. */
static int show_answer(struct splats *to, struct locating *r, enum locate_show show, struct err *e)
{
	struct request *q = &r->request;
	const struct responses *a = &q->responses;
	const size_t k = a->answer[0], first = a->begin ? a->begin[k] : 0;
	SCOPED_BY(showing_free) struct showing w = {0};

	if (anymodel_place(&q->model, &q->scene, e) || showing_open(&w, &q->scene, &q->model, e))
		return -1;
	if (a->begin)
		return showing_things(to, &w, a->objects + first, a->begin[k + 1] - first, show, e);
	return locate_answer(w.of, a, k, &r->answers[k].extent, show, &q->scene.splats, w.most, e) ||
	       locate_show(to, &q->scene.splats, w.of, show, e);
}

int showing_write(
	struct locating *r, enum locate_show show, const char *ply, const char *splat, struct err *e)
{
	SCOPED_BY(splats_free) struct splats shown = {0};

	if (show_answer(&shown, r, show, e))
		return -1;
	int bad = (ply && ply_write(&shown, r->request.scene.offset, ply, e)) ||
		  (splat && splat_write(&shown, (double[3]){0}, splat, e));
	return bad ? -1 : 0;
}

static int write_scene(const struct asking *a, const struct asking_answer *found, enum locate_show show,
	const char *path, size_t *taken, const struct report *to, struct err *e)
{
	const enum anysplats_format format = (enum anysplats_format)anysplats_format_of(path);
	char text[ANYSPLATS_LOSS];
	int lost = 0;
	const struct scene *scene = &a->scene;
	SCOPED_BY(splats_free) struct splats shown = {0};
	SCOPED_BY(showing_free) struct showing w = {0};

	if (showing_open(&w, scene, &a->model, e) ||
		showing_things(&shown, &w, found->things, found->count, show, e) ||
		(lost = anysplats_loss(&shown, scene->offset, format, text, e)) < 0 ||
		anysplats_write(&shown, scene->offset, format, ANYSPLATS_SPZ_VERSION, path, e))
		return -1;
	if (lost)
		report_warn(to, "%s: %s", path, text);
	for (size_t i = 0; i < scene->splats.n; i++)
		*taken += w.of[i] != 0;
	return 0;
}

int showing_ask(const struct asking_options *o, const char *question, enum locate_show show, const char *path,
	FILE *out, const struct report *to, struct err *e)
{
	SCOPED_BY(asking_close) struct asking a = {0};
	SCOPED_BY(asking_answer_free) struct asking_answer found = {0};
	const struct answer_told told = {.asking = &a, .answer = &found, .question = question};
	char caption[256];
	size_t taken = 0;

	if (file_out_probe(path, e) || asking_open(&a, o, e) || asking_ask(&a, question, 0, &found, to, e))
		return -1;
	answer_caption(&told, caption, sizeof caption);
	if (!found.count)
		return err_set(e, ERR_CHECK, "nothing here is that: %s", found.reason);
	if (write_scene(&a, &found, show, path, &taken, to, e))
		return -1;
	return fprintf(out, "%s: %zu of %zu Gaussians\n", caption, taken, a.scene.splats.n) < 0
		       ? err_errno(e, "stdout")
		       : 0;
}
