#include "cmd/render/locating.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "cmd/run/object_extents.h"
#include "formats/records/boxes.h"
#include "formats/splats/ply.h"
#include "lift/labels.h"

#include <stdlib.h>

int labelling_open(struct labelling *r, const char *scene, const char *model, struct err *e)
{
	if (scene_read(&r->scene, scene, e) || anymodel_read(&r->model, model, e))
		return -1;
	if (!r->model.is_lifted)
		return err_set(e, ERR_FORMAT, "%s: is a trained model; --all needs one of refer-lift",
			file_name(model));
	if (anymodel_check_scene(&r->model, file_name(model), &r->scene, scene, e))
		return -1;
	r->extents = object_extents(&r->model.lifted, &r->scene.splats, &r->scene.cameras, e);
	r->labels = mem_alloc(r->scene.splats.n, sizeof *r->labels, "labels", e);
	return r->extents && r->labels ? labels_find(r->labels, &r->model.lifted, r->extents, e) : -1;
}

void labelling_free(struct labelling *r)
{
	object_extents_free(r->extents, r->model.lifted.objects);
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
	char *name = name_to_file(w->lifted->names[object], e),
	     *path = name ? file_join(dir, name, ".ply", e) : NULL;
	SCOPED_BY(splats_free) struct splats alone = {0};
	const int bad = !path || showing_things(&alone, w, &object, 1, LOCATE_ISOLATED, e) ||
			ply_write(&alone, w->scene->offset, path, e);

	free(path);
	free(name);
	return bad ? -1 : 0;
}

int labelling_write_each(const struct labelling *r, const char *dir, struct err *e)
{
	struct showing w;

	if (file_make_dir(dir, e))
		return -1;
	int bad = showing_open(&w, &r->scene, &r->model.lifted, r->extents, e);
	for (size_t o = 0; o < r->model.lifted.objects && !bad; o++)
		bad = write_one(&w, o, dir, e);
	showing_free(&w);
	return bad ? -1 : 0;
}

int labelling_write(const struct labelling *r, const char *path, struct err *e)
{
	const struct lifted *l = &r->model.lifted;
	struct file_out out;
	int bad = 0;

	if (file_out_open(&out, path, e))
		return -1;
	for (size_t o = 0; o < l->objects && !bad; o++) {
		const struct extent *x = &r->extents[o];
		const struct box_gaussians of = {x->n, x->ids};
		struct box_record record = object_extents_record(x, r->scene.offset, l->confidence[o]);
		record.object = l->names[o];
		record.label = (int)o + 1;
		labels_colour(record.label, record.colour);
		bad = boxes_put(out.stream, &record, &of, e);
	}
	return file_out_end(&out, bad, e);
}
