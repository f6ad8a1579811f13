#include "cmd/run/anymodel.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/names.h"
#include "cmd/text/text_query.h"
#include "formats/scene/lifted.h"
#include "formats/arrays/safetensors.h"
#include "geom/up.h"

int anymodel_read(struct anymodel *m, const char *path, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	*m = (struct anymodel){0};
	if (safetensors_open(&st, path, e))
		return -1;
	const char *format = safetensors_meta(&st, "format");
	m->is_lifted = format && !strcmp(format, "refer.lifted");
	m->is_selection = format && !strcmp(format, "refer.selection");
	if (m->is_lifted)
		return lifted_take(&m->lifted, &m->origin, &st, e) || parser_weights_default(&m->weights, e);
	if (!m->is_selection && (!format || strcmp(format, "refer.model")))
		return err_set(e, ERR_FORMAT,
			"%s: format is '%s', expected 'refer.model', 'refer.lifted' or 'refer.selection'",
			st.path, format ? format : "");
	if (m->is_selection ? selection_take(&m->selection, &st, e) : model_take(&m->trained, &st, e))
		return -1;
	if (m->trained.query == REFER_PARSES && parser_weights_default(&m->weights, e))
		return -1;
	m->origin = m->is_selection ? (struct origin){.scene = m->selection.scene} : m->trained.origin;
	return 0;
}

void anymodel_free(struct anymodel *m)
{
	tracks_free(&m->tracks);
	lifted_extents_free(m->extents, m->lifted.objects);
	free(m->poses);
	model_free(&m->trained);
	lifted_free(&m->lifted);
	selection_free(&m->selection);
	parser_weights_free(&m->weights);
	*m = (struct anymodel){0};
}

int anymodel_check_scene(
	const struct anymodel *m, const char *model, const struct scene *scene, struct err *e)
{
	const size_t gaussians = m->is_selection ? m->selection.gaussians
				 : m->is_lifted	 ? m->lifted.gaussians
						 : m->trained.scene_gaussians;

	return scene_check(scene, model, gaussians, &m->origin.scene, e);
}

int anymodel_place(struct anymodel *m, const struct scene *scene, struct err *e)
{
	double up[3];

	if (m->extents || !m->is_lifted)
		return 0;
	cameras_up(&scene->cameras, up);
	if (lifted_extents(&m->extents, &m->lifted, &scene->splats, up, e))
		return -1;
	m->lifted.extents = m->extents;
	return 0;
}

int anymodel_follow(struct anymodel *m, const struct scene *scene, struct err *e)
{
	const size_t objects = m->lifted.objects;
	double up[3];

	if (!m->is_lifted || !scene->motion.times)
		return 0;
	if (!m->poses) {
		lifted_extents_free(m->extents, objects);
		m->lifted.extents = m->extents = mem_zalloc(objects, sizeof *m->extents, "objects", e);
		m->poses = mem_zalloc(objects, sizeof *m->poses, "objects", e);
		if (!m->extents || !m->poses)
			return -1;
	}
	cameras_up(&scene->cameras, up);
	return lifted_extents_again(m->extents, m->poses, &m->lifted, &scene->splats, up, e);
}

static int track_frames(struct anymodel *m, const struct scene *scene, struct splats *at, struct err *e)
{
	const struct motion *motion = &scene->motion;
	SCOPED char *is_moved = mem_zalloc(at->n, 1, "tracks", e);
	struct extent *extents = NULL;
	double up[3];

	cameras_up(&scene->cameras, up);
	int bad = !is_moved || lifted_extents(&extents, &m->lifted, at, up, e);
	for (size_t i = 0; i < motion->moved && !bad; i++)
		is_moved[motion->ids[i]] = 1;
	bad = bad || tracks_begin(&m->tracks, m->lifted.objects, extents, at, motion->at, motion->times,
			     is_moved, up, e);
	for (size_t i = 0; i < motion->times && !bad; i++)
		bad = motion_set(motion, motion->at[i], at, e) || tracks_put(&m->tracks, i, at, e);
	lifted_extents_free(extents, m->lifted.objects);
	return bad || tracks_end(&m->tracks, e) ? -1 : 0;
}

int anymodel_track(struct anymodel *m, const struct scene *scene, struct err *e)
{
	const struct camera first = {.has_time = 1, .time = scene->motion.times ? scene->motion.at[0] : 0};
	struct splats at;

	if (!scene->motion.times || !m->is_lifted || m->tracks.times)
		return 0;
	if (scene_splats_at(&at, scene, &first, e))
		return -1;
	const int bad = track_frames(m, scene, &at, e);
	scene_splats_release(&at, scene);
	return bad;
}

static void move(struct box *b, const double by[3])
{
	for (int k = 0; k < 3; k++)
		b->centre[k] += by[k];
}

struct box_record anymodel_box(const struct extent *x, const double offset[3], double sure)
{
	struct box_record record = {
		.score = x->n ? sure : 0, .is_empty = !x->n, .aligned = x->aligned, .turned = x->turned};

	move(&record.aligned, offset);
	move(&record.turned, offset);
	return record;
}

static int check_fit(const struct anymodel *m, const struct anymodel_ask *q, struct err *e)
{
	const char *model = file_name(q->model_path), *text = file_name(q->text_path);
	const int width = m->is_lifted ? m->lifted.width : m->trained.layout.text_width,
		  asked = !m->is_lifted && m->trained.query == REFER_PARSES ? query_width(q->text->width)
									    : q->text->width;

	if (anymodel_check_scene(m, model, q->scene, e))
		return -1;
	if (!m->is_selection && width != asked)
		return err_set(e, ERR_FORMAT, "%s: is of sentences of width %d, %s has %d", model, width,
			text, asked);
	if (fingerprint_check("encoder", text, &q->text->encoder, model, &m->origin.encoder, e))
		return -1;
	if (m->is_lifted && !q->text->pieces)
		return err_set(e, ERR_FORMAT,
			"%s: no word pieces, which %s asks for: encode its sentences again", text, model);
	return m->is_lifted &&
	       (parser_weights_need_middle(&m->weights, model, m->lifted.middle, &m->origin.encoder, e) ||
		       parser_weights_need_middle(&m->weights, text, q->text->middle, &q->text->encoder, e));
}

/* Where each sentence is said: from (q->count). */
static int find_viewpoints(const struct anymodel_ask *q, struct viewpoint *from, struct err *e)
{
	const struct cameras *c = &q->scene->cameras;
	SCOPED_BY(names_free) struct names names = {0};
	int bad = 0;

	if (names_make(&names, c->views, sizeof *c->views, offsetof(struct camera, name), c->n, e))
		return -1;
	for (size_t i = 0; i < q->count && !bad; i++) {
		const char *view = q->text->views ? q->text->views[q->which[i]] : "";
		from[i] = q->from ? *q->from : (struct viewpoint){.kind = VIEWPOINT_USUAL};
		if (q->from || !*view)
			continue;
		const size_t v = names_find(&names, view);
		if (v == NAMES_NONE)
			bad = err_set(e, ERR_FORMAT,
				"%s: sentence '%s' is of view '%s', which %s does not have",
				file_name(q->text_path), q->text->refs[q->which[i]], view, q->scene->path);
		else
			from[i] = (struct viewpoint){.kind = VIEWPOINT_CAMERA, .camera = &c->views[v]};
	}
	return bad;
}

static int answer_lifted(const struct lifted *l, const struct anymodel_ask *q, struct responses_question *of,
	struct responses *a, struct err *e)
{
	SCOPED struct viewpoint *from = mem_alloc(q->count, sizeof *from, "sentences", e);

	of->from = from;
	if (!from || find_viewpoints(q, from, e))
		return -1;
	return responses_lifted(a, l, of, q->parts, q->least, e);
}

/* The sentences' rows of a selection, by ref. */
static int answer_selected(
	const struct selection *s, const struct anymodel_ask *q, struct responses *a, struct err *e)
{
	const struct responses_selection of = {s->gaussians, s->indptr, s->index};
	SCOPED size_t *row = mem_alloc(q->count, sizeof *row, "sentences", e);
	SCOPED_BY(names_free) struct names refs = {0};
	int bad = !row || names_make(&refs, s->refs, sizeof *s->refs, 0, s->n, e);

	for (size_t i = 0; i < q->count && !bad; i++) {
		const char *ref = q->text->refs[q->which[i]];
		row[i] = names_find(&refs, ref);
		if (row[i] == NAMES_NONE)
			bad = err_set(e, ERR_FORMAT, "%s: has nothing for ref '%s' of %s",
				file_name(q->model_path), ref, file_name(q->text_path));
	}
	return -(bad || responses_selected(a, &of, row, q->count, e));
}

int anymodel_answer(
	const struct anymodel *m, const struct anymodel_ask *q, struct responses *a, struct err *e)
{
	const struct model *t = &m->trained;
	const float *means = q->scene->splats.means;
	const struct parser parser = {
		.weights = &m->weights, .encoder = q->text->encoder.hex, .memo = q->memo};
	struct responses_question of = {&q->scene->splats, &q->scene->cameras, q->text->offsets,
		q->text->words, q->text->middle, q->text->texts, q->text->pieces, NULL, &parser,
		m->tracks.times ? &m->tracks : NULL, q->which, q->count, q->text->refs,
		file_name(q->model_path), q->wants_parts};
	SCOPED_BY(rows_free) struct rows rows = {0};
	SCOPED_BY(query_free) struct query query = {0};

	*a = (struct responses){0};
	if (check_fit(m, q, e))
		return -1;
	if (m->is_selection)
		return answer_selected(&m->selection, q, a, e);
	if (m->is_lifted)
		return answer_lifted(&m->lifted, q, &of, a, e);
	if (model_rows(t, means, &rows, e))
		return -1;
	if (t->query == REFER_PARSES) {
		if (text_query(q->text, q->text_path, &m->weights, &query, e))
			return -1;
		of.offsets = query.offsets;
		of.words = query.words;
	}
	const struct respond_model respond = {&t->layout, t->similarity, &rows, t->blend, t->features,
		t->parameters, means, t->low, t->high};
	return responses_trained(a, &respond, &of, q->wants_calibration, e);
}
