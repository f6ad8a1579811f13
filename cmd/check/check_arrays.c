#include "cmd/check/check.h"

#include "base/mem.h"
#include "formats/splats/anysplats.h"
#include "formats/scene/features.h"
#include "formats/scene/lifted.h"
#include "formats/scene/model.h"
#include "formats/arrays/npz.h"
#include "formats/encoders/parser_weights.h"
#include "formats/images/png.h"
#include "formats/scene/proposed.h"
#include "formats/scene/selection.h"
#include "formats/scene/text.h"
#include "formats/scene/weights.h"

void check_add_splats(struct check *c, const struct splats *s)
{
	check_add(c, "gaussians", (long long)s->n);
	check_add(c, "harmonics", s->sh_coefficients);
}

void check_add_views(struct check *c, const struct cameras *views)
{
	size_t test = 0, same = 0;

	for (size_t i = 0; i < views->n; i++) {
		test += views->views[i].split == SPLIT_TEST;
		same += views->views[i].width == views->views[0].width &&
			views->views[i].height == views->views[0].height;
	}
	if (views->n && same == views->n) {
		c->width = views->views[0].width;
		c->height = views->views[0].height;
	}
	check_add(c, "training views", (long long)(views->n - test));
	check_add(c, "test views", (long long)test);
}

int check_splats(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(scene_free) struct scene s = {0};

	if (scene_read_splats(&s, path, e))
		return -1;
	c->scene = s.fingerprint;
	check_add_splats(c, &s.splats);
	return 0;
}

void check_add_motion(struct check *c, const struct motion *m)
{
	check_add(c, "times", (long long)m->times);
	check_add(c, "moving gaussians", (long long)m->moved);
}

int check_motion(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(motion_close) struct motion m = {0};

	if (motion_open(&m, path, e))
		return -1;
	c->scene = m.scene;
	check_add_motion(c, &m);
	check_add(c, "gaussians of the scene", (long long)m.gaussians);
	return 0;
}

int check_weights(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(weights_close) struct weights w = {0};

	if (weights_open_file(&w, path, e))
		return -1;
	c->precision = w.is_packed ? "packed" : precision_name(w.precision);
	c->width = w.width;
	c->height = w.height;
	c->scene = w.scene;
	c->camera = w.camera;
	check_add(c, "weights", (long long)w.indptr[(int64_t)w.width * w.height]);
	check_add(c, "gaussians of the scene", (long long)w.gaussians);
	return 0;
}

int check_text(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(text_free) struct text t = {0};

	if (text_read(&t, path, e))
		return -1;
	check_add(c, "sentences", (long long)t.n);
	check_add(c, "words", (long long)t.offsets[t.n]);
	check_add(c, "columns", t.width);
	c->encoder = t.encoder;
	return 0;
}

int check_model(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(model_free) struct model m = {0};

	if (model_read(&m, path, e))
		return -1;
	c->precision = precision_name(m.precision);
	check_add(c, "features", (long long)m.n);
	check_add(c, "columns", m.layout.feature_width);
	check_add(c, "gaussians of the scene", (long long)m.scene_gaussians);
	check_add(c, "parameters", (long long)m.layout.count);
	c->scene = m.origin.scene;
	c->encoder = m.origin.encoder;
	return 0;
}

int check_lifted(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(lifted_free) struct lifted l = {0};
	struct origin origin;

	if (lifted_read(&l, &origin, path, e))
		return -1;
	c->scene = origin.scene;
	c->encoder = origin.encoder;
	check_add(c, "objects", (long long)l.objects);
	check_add(c, "shares", (long long)l.indptr[l.objects]);
	check_add(c, "sentences", (long long)l.sentences);
	check_add(c, "words", (long long)l.offsets[l.sentences]);
	check_add(c, "columns", l.width);
	check_add(c, "gaussians of the scene", (long long)l.gaussians);
	return 0;
}

int check_features(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(features_close) struct features f = {0};

	if (features_open(&f, path, e))
		return -1;
	if (!f.labels)
		c->precision = f.is_half ? "f16" : "f32";
	c->scene = f.scene;
	check_add(c, "gaussians", (long long)f.gaussians);
	if (!f.labels)
		check_add(c, "channels", (long long)f.channels);
	size_t seen = 0, labels = 0;
	for (size_t i = 0; i < f.gaussians; i++) {
		seen += f.weight[i] > 0;
		labels += f.labels && f.labels[i] >= 0;
	}
	check_add(c, "seen", (long long)seen);
	if (f.labels)
		check_add(c, "labels", (long long)labels);
	return 0;
}

int check_selection(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(selection_free) struct selection s = {0};

	if (selection_read(&s, path, e))
		return -1;
	c->scene = s.scene;
	check_add(c, "sentences", (long long)s.n);
	check_add(c, "items", (long long)s.indptr[s.n]);
	check_add(c, "gaussians of the scene", (long long)s.gaussians);
	return 0;
}

int check_regions(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(regions_file_free) struct regions_file r = {0};

	if (regions_file_read(&r, path, e))
		return -1;
	c->scene = r.scene;
	check_add(c, "regions", r.tree.n);
	check_add(c, "gaussians of the scene", (long long)r.tree.gaussians);
	return 0;
}

int check_anysplats(struct check *c, const char *path, const char *kind, struct err *e)
{
	SCOPED_BY(splats_free) struct splats s = {0};
	struct rows_report report;
	double offset[3];

	if (anysplats_read(&s, offset, &report, path, e))
		return -1;
	c->kind = kind;
	check_add_splats(c, &s);
	if (report.read > s.n)
		check_add(c, "unusable gaussians", (long long)(report.read - s.n));
	free(report.dropped);
	return 0;
}

int check_npy(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(npy_close) struct npy a = {0};

	if (npy_open(&a, path, e))
		return -1;
	c->kind = "npy";
	check_add(c, "dimensions", a.dims);
	check_add(c, "values", (long long)a.count);
	return 0;
}

int check_npz(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(npz_close) struct npz z = {0};
	long long values = 0;
	int bad = 0;

	if (npz_open(&z, path, e))
		return -1;
	for (size_t i = 0; i < z.zip.n && !bad; i++) {
		SCOPED_BY(npy_close) struct npy a = {0};
		bad = npz_entry(&z, i, &a, NULL, e);
		values += (long long)a.count;
	}
	c->kind = "npz";
	check_add(c, "arrays", (long long)z.zip.n);
	check_add(c, "values", values);
	return bad;
}

int check_parser(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(parser_weights_free) struct parser_weights w = {0};

	if (parser_weights_read(&w, path, e))
		return -1;
	check_add(c, "parameters", (long long)w.count);
	return 0;
}

int check_image(struct check *c, const char *path, struct err *e)
{
	SCOPED uint8_t *rgb = NULL;

	if (image_read_rgb(path, &rgb, &c->height, &c->width, e))
		return -1;
	c->kind = "image";
	return 0;
}

int check_cameras(struct check *c, const char *path, const char *kind, cameras_reader *read, struct err *e)
{
	SCOPED_BY(cameras_free) struct cameras views = {0};

	if (read(&views, path, e))
		return -1;
	c->kind = kind;
	check_add_views(c, &views);
	return 0;
}
