#include "cmd/render/locating.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "formats/records/boxes.h"
#include "formats/splats/ply.h"
#include "geom/up.h"
#include "lift/lift_labels.h"

int labelling_open(struct labelling *r, const char *scene, const char *model, struct err *e)
{
	if (scene_read(&r->scene, scene, e) || anymodel_read(&r->model, model, e))
		return -1;
	if (!r->model.is_lifted)
		return err_set(e, ERR_FORMAT, "%s: is a trained model; --all needs one of refer-lift",
			file_name(model));
	if (anymodel_check_scene(&r->model, file_name(model), &r->scene, e))
		return -1;
	r->labels = mem_alloc(r->scene.splats.n, sizeof *r->labels, "labels", e);
	return -(!r->labels || anymodel_place(&r->model, &r->scene, e) ||
		 labels_find(r->labels, &r->model.lifted, r->model.extents, e));
}

void labelling_free(struct labelling *r)
{
	free(r->labels);
	anymodel_free(&r->model);
	scene_free(&r->scene);
}

int labelling_write_scene(const struct labelling *r, const char *path, struct err *e)
{
	return ply_write_labelled(&r->scene.splats, r->scene.offset, r->labels, path, e);
}

static int write_one(const struct showing *w, size_t object, const char *dir, struct err *e)
{
	SCOPED char *name = name_to_file(w->model->lifted.names[object], e);
	SCOPED char *path = name ? file_join(dir, name, ".ply", e) : NULL;
	SCOPED_BY(splats_free) struct splats alone = {0};

	return !path || showing_things(&alone, w, &object, 1, LOCATE_ISOLATED, e) ||
	       ply_write(&alone, w->scene->offset, path, e);
}

int labelling_write_each(const struct labelling *r, const char *dir, struct err *e)
{
	SCOPED_BY(showing_free) struct showing w = {0};

	if (file_make_dir(dir, e))
		return -1;
	int bad = showing_open(&w, &r->scene, &r->model, e);
	for (size_t o = 0; o < r->model.lifted.objects && !bad; o++)
		bad = write_one(&w, o, dir, e);
	return bad ? -1 : 0;
}

int labelling_write(const struct labelling *r, const char *path, struct err *e)
{
	const struct lifted *l = &r->model.lifted;
	struct file_out out;

	if (file_out_open(&out, path, e))
		return -1;
	for (size_t o = 0; o < l->objects; o++) {
		const struct extent *x = &r->model.extents[o];
		const struct box_gaussians of = {x->n, x->ids};
		struct box_record record = anymodel_box(x, r->scene.offset, l->confidence[o]);
		record.object = l->names[o];
		record.label = (int)o + 1;
		labels_colour(record.label, record.colour);
		boxes_put(out.stream, &record, &of);
	}
	return file_out_end(&out, 0, e);
}

static void forget(struct locating *r)
{
	for (size_t k = 0; r->answers && k < r->request.responses.answers; k++)
		extent_free(&r->answers[k].extent);
	free(r->answers);
	r->answers = NULL;
}

void locating_free(struct locating *r)
{
	forget(r);
	request_free(&r->request);
}

static size_t parts_of(const struct responses *a, size_t answer)
{
	const size_t n = a->begin ? a->begin[answer + 1] - a->begin[answer] : 0;

	return n > 1 ? n : 0;
}

/* The objects, where an answer is of several. */
static int find_objects(struct locating *r, struct err *e)
{
	struct request *q = &r->request;
	int has_several = 0;

	for (size_t k = 0; k < q->responses.answers; k++)
		has_several |= parts_of(&q->responses, k) > 0;
	if (!has_several)
		return 0;
	return anymodel_place(&q->model, &q->scene, e);
}

int locating_find(struct locating *r, double up[3], struct err *e)
{
	struct request *q = &r->request;

	r->answers = mem_zalloc(q->responses.answers, sizeof *r->answers, "objects", e);
	if (!r->answers)
		return -1;
	cameras_up(&q->scene.cameras, up);
	return locate_all(r->answers, &q->responses, &q->scene.splats, up, e) || find_objects(r, e);
}

/* parts gets the objects of an answer that is of several; to be freed. */
static int make_parts(const struct locating *r, size_t answer, struct box_record **parts, struct err *e)
{
	const struct responses *a = &r->request.responses;
	const size_t n = parts_of(a, answer);

	*parts = mem_zalloc(n, sizeof **parts, "objects", e);
	for (size_t i = 0; i < n && *parts; i++) {
		const size_t o = a->objects[a->begin[answer] + i];
		(*parts)[i] = anymodel_box(&r->request.model.extents[o], r->request.scene.offset,
			r->request.model.lifted.confidence[o]);
		(*parts)[i].object = r->request.model.lifted.names[o];
	}
	return *parts ? 0 : -1;
}

/* With a time neither the parts nor the Gaussians, which it does not change. */
static int put(const struct locating *r, size_t i, const double *time, FILE *out, struct err *e)
{
	const struct request *q = &r->request;
	const size_t answer = q->responses.answer[i];
	const struct located *l = &r->answers[answer];
	const struct extent *x = &l->extent;
	const struct box_gaussians of = {x->n, x->ids};
	SCOPED struct box_record *parts = NULL;
	struct box_record record;

	if (!time && make_parts(r, answer, &parts, e))
		return -1;
	record = anymodel_box(x, q->scene.offset, q->responses.sure ? q->responses.sure[i] : l->sure);
	record.ref = q->text.refs[q->refs[i]];
	record.object = (char *)text_object(&q->text, q->refs[i]);
	record.parts = parts;
	record.part_count = time ? 0 : parts_of(&q->responses, answer);
	if (time)
		snprintf(record.time, sizeof record.time, "%.17g", *time);
	boxes_put(out, &record, time ? NULL : &of);
	return 0;
}

int locating_write(const struct locating *r, const char *path, struct err *e)
{
	struct file_out out;
	int bad = file_out_open(&out, path, e);

	for (size_t i = 0; i < r->request.count && !bad; i++)
		bad = put(r, i, NULL, out.stream, e);
	return file_out_end(&out, bad, e);
}

static int track(struct locating *r, FILE *out, struct err *e)
{
	struct request *q = &r->request;
	const struct motion *m = &q->scene.motion;
	double up[3];
	int bad = 0;

	cameras_up(&q->scene.cameras, up);
	for (size_t t = 0; t < m->times && !bad; t++) {
		bad = scene_move(&q->scene, &m->at[t], e) ||
		      !(r->answers = mem_zalloc(q->responses.answers, sizeof *r->answers, "objects", e)) ||
		      locate_all(r->answers, &q->responses, &q->scene.splats, up, e);
		for (size_t i = 0; i < q->count && !bad; i++)
			bad = put(r, i, &m->at[t], out, e);
		forget(r);
	}
	return bad ? -1 : 0;
}

int locating_track(struct locating *r, const char *path, struct err *e)
{
	struct file_out out;

	if (!r->request.scene.motion.times)
		return err_set(e, ERR_USAGE, "--track: %s is still: it has no motion.safetensors",
			r->request.scene.path);
	return file_out_end(&out, file_out_open(&out, path, e) || track(r, out.stream, e), e);
}
