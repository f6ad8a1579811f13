#include "formats/scene/scene.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/names.h"
#include "formats/arrays/arrays_out.h"
#include "formats/arrays/safetensors.h"
#include "formats/records/json.h"
#include "formats/records/jsonl.h"
#include "geom/lens.h"
#include "geom/views.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>

static int check_values(const struct splats *s, const char *path, struct err *e)
{
	for (size_t i = 0; i < s->n; i++) {
		const float *m = s->means + 3 * i, *c = s->scales + 3 * i, *q = s->quats + 4 * i;
		double length = (double)fabsf(q[0]) + fabsf(q[1]) + fabsf(q[2]) + fabsf(q[3]);
		if (!isfinite(m[0]) || !isfinite(m[1]) || !isfinite(m[2]))
			return err_file(e, path, "tensor 'means': Gaussian %zu is not finite", i);
		if (!(c[0] >= 0 && c[1] >= 0 && c[2] >= 0) || !isfinite((double)c[0] + c[1] + c[2]))
			return err_file(
				e, path, "tensor 'scales': Gaussian %zu is negative or not finite", i);
		if (!(length > 0) || !isfinite(length))
			return err_file(e, path, "tensor 'quats': Gaussian %zu is zero or not finite", i);
		if (!(s->opacities[i] >= 0 && s->opacities[i] <= 1))
			return err_file(e, path, "tensor 'opacities': Gaussian %zu is not in [0,1]", i);
	}
	for (size_t i = 0; i < s->n * (size_t)s->sh_coefficients * 3; i++)
		if (!isfinite(s->sh[i]))
			return err_file(e, path, "tensor 'sh': value %zu is not finite", i);
	return 0;
}

/* The means and the near plane say it; the file's own word of it, where there is one, must be the same. */
static int take_fingerprint(struct scene *s, const struct safetensors *st, struct err *e)
{
	struct fingerprint own;

	s->fingerprint = fingerprint_scene(&s->splats);
	if (fingerprint_read(&own, st, "scene", e))
		return -1;
	if (*own.hex && strcmp(own.hex, s->fingerprint.hex))
		return err_file(e, st->path,
			"metadata 'scene' is %s, but the means and the near plane have %s", own.hex,
			s->fingerprint.hex);
	return 0;
}

static int take_splats(struct scene *s, const struct safetensors *st, struct err *e)
{
	const char *offset = safetensors_meta(st, "offset"), *near = safetensors_meta(st, "near"),
		   *unit = safetensors_meta(st, "unit");
	const struct st_tensor *t[5];
	char after;

	if (safetensors_need_format(st, "refer.splats", 1, e) ||
		!(t[0] = safetensors_need(st, "means", ST_F32, 2, (int64_t[]){-1, 3}, e)))
		return -1;
	const int64_t n = t[0]->shape[0];
	if (!(t[1] = safetensors_need(st, "scales", ST_F32, 2, (int64_t[]){n, 3}, e)) ||
		!(t[2] = safetensors_need(st, "quats", ST_F32, 2, (int64_t[]){n, 4}, e)) ||
		!(t[3] = safetensors_need(st, "opacities", ST_F32, 1, (int64_t[]){n}, e)) ||
		!(t[4] = safetensors_need(st, "sh", ST_F32, 3, (int64_t[]){n, -1, 3}, e)))
		return -1;
	const int64_t k = t[4]->shape[1];
	if (k != 1 && k != 4 && k != 9 && k != 16)
		return err_file(
			e, st->path, "tensor 'sh': %lld coefficients, expected 1, 4, 9 or 16", (long long)k);
	if (offset && (sscanf(offset, "[%lf,%lf,%lf]", &s->offset[0], &s->offset[1], &s->offset[2]) != 3 ||
			      !isfinite(s->offset[0]) || !isfinite(s->offset[1]) || !isfinite(s->offset[2])))
		return err_file(e, st->path, "metadata 'offset' is not three numbers");
	if (splats_alloc(&s->splats, (size_t)n, (int)k, e))
		return -1;
	if (near && (sscanf(near, "%lf%c", &s->splats.near, &after) != 1 || !(s->splats.near > 0) ||
			    !isfinite(s->splats.near)))
		return err_file(e, st->path, "metadata 'near' is not a number above 0");
	if (unit && strcmp(unit, "m") != 0)
		return err_file(e, st->path, "metadata 'unit' is '%s', expected 'm'", unit);
	s->is_metric = unit != NULL;
	float *to[5] = {
		s->splats.means, s->splats.scales, s->splats.quats, s->splats.opacities, s->splats.sh};
	for (int i = 0; i < 5; i++)
		memcpy(to[i], t[i]->data, t[i]->bytes);
	return -(check_values(&s->splats, st->path, e) || take_fingerprint(s, st, e));
}

int scene_read_splats(struct scene *s, const char *path, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	if (safetensors_open(&st, path, e))
		return -1;
	const int bad = take_splats(s, &st, e);
	return bad;
}

static int read_name(struct camera *c, const cJSON *view, const char *where, struct err *e)
{
	const cJSON *name = json_get(view, "name");
	char fault[NAME_FAULT];

	if (!cJSON_IsString(name))
		return err_file(e, where, "key 'name' is not a string");
	const char *reason = name_fault(name->valuestring, NAME_VIEW, fault);
	if (reason)
		return err_file(e, where, "key 'name' %s", reason);
	c->name = name_copy(name->valuestring, e);
	return c->name ? 0 : -1;
}

/* The photograph's camera, where it is not the view's pinhole. */
static int read_lens(struct lens *l, const cJSON *view, const char *of, struct err *e)
{
	const cJSON *lens = json_member(view, "lens");
	const char *model;
	double width, height;
	char where[512];

	if (!lens)
		return 0;
	snprintf(where, sizeof where, "%.480s: key 'lens'", of);
	if (json_string(lens, "model", 1, &model, where, e) < 0 ||
		json_number(lens, "width", 1, &width, where, e) < 0 ||
		json_number(lens, "height", 1, &height, where, e) < 0)
		return -1;
	if (!(l->model = lens_model_named(model, strlen(model))))
		return err_file(e, where, "camera model '%.60s' is unknown", model);
	struct camera size;
	if (view_set_size(&size, width, height))
		return err_file(e, where, "size %gx%g is not whole numbers in 1 to 65536", width, height);
	l->width = size.width;
	l->height = size.height;
	if (json_matrix(lens, "parameters", lens_model_parameters(l->model), 0, l->parameters, where, e))
		return -1;
	for (int i = 0; i < lens_model_focals(l->model); i++)
		if (!(l->parameters[i] > 0))
			return err_file(e, where, "focal length is not positive");
	return 0;
}

static int read_view(struct camera *c, const cJSON *view, const char *where, struct err *e)
{
	const cJSON *split = json_get(view, "split");
	const char *image = NULL, *source = NULL;
	double width, height;

	if (read_name(c, view, where, e) || json_number(view, "width", 1, &width, where, e) < 0 ||
		json_number(view, "height", 1, &height, where, e) < 0 ||
		json_number(view, "fx", 1, &c->fx, where, e) < 0 ||
		json_number(view, "fy", 1, &c->fy, where, e) < 0 ||
		json_number(view, "cx", 1, &c->cx, where, e) < 0 ||
		json_number(view, "cy", 1, &c->cy, where, e) < 0 ||
		json_matrix(view, "world_to_camera", 4, 4, c->world_to_camera[0], where, e) ||
		read_lens(&c->lens, view, where, e) || json_string(view, "image", 0, &image, where, e) < 0 ||
		json_string(view, "source", 0, &source, where, e) < 0 ||
		(c->has_time = json_number(view, "time", 0, &c->time, where, e)) < 0)
		return -1;
	if (view_set_size(c, width, height))
		return err_file(e, where, "size %gx%g is not whole numbers in 1 to 65536", width, height);
	const char *fault = view_fault(c);
	if (fault)
		return err_file(e, where, "%s", fault);
	if (!cJSON_IsString(split) ||
		(strcmp(split->valuestring, "train") && strcmp(split->valuestring, "test")))
		return err_file(e, where, "key 'split' is not \"train\" or \"test\"");
	c->split = !strcmp(split->valuestring, "test") ? SPLIT_TEST : SPLIT_TRAIN;
	return -((image && !(c->image = mem_strdup(image, e))) ||
		 (source && !(c->source = mem_strdup(source, e))));
}

static int check_unique(const struct cameras *c, const char *path, struct err *e)
{
	size_t twice, earlier;

	if (names_find_twice(
		    c->views, sizeof *c->views, offsetof(struct camera, name), c->n, &twice, &earlier, e))
		return -1;
	return twice == NAMES_NONE ? 0
				   : err_file(e, path, "view name '%s' appears twice", c->views[twice].name);
}

static int read_views(struct cameras *c, const cJSON *list, const char *path, struct err *e)
{
	const cJSON *view;
	char where[512];

	if (!cJSON_IsArray(list))
		return err_file(e, path, "not a list of views");
	c->views = mem_zalloc((size_t)cJSON_GetArraySize(list), sizeof *c->views, path, e);
	if (!c->views)
		return -1;
	cJSON_ArrayForEach(view, list)
	{
		snprintf(where, sizeof where, "%.480s: view %zu", path, c->n);
		if (read_view(&c->views[c->n++], view, where, e))
			return -1;
	}
	return check_unique(c, path, e);
}

int scene_read_cameras_file(struct cameras *c, const char *path, struct err *e)
{
	SCOPED_BY(json_release) cJSON *list = json_read(path, e);

	*c = (struct cameras){0};
	int bad = list ? read_views(c, list, file_name(path), e) : -1;
	return bad;
}

int scene_read_cameras(struct cameras *c, const char *dir, struct err *e)
{
	SCOPED char *path = file_join(dir, "cameras.json", "", e);
	return path ? scene_read_cameras_file(c, path, e) : -1;
}

/* The moved Gaussians of the first time are the scene's, and views are of its times. */
static int check_motion(const struct scene *s, const char *splats, struct err *e)
{
	const struct motion *m = &s->motion;

	if (fingerprint_check("scene", m->file.path, &m->scene, splats, &s->fingerprint, e))
		return -1;
	if (m->gaussians != s->splats.n)
		return err_file(e, m->file.path, "is of %zu Gaussians, %s has %zu", m->gaussians, splats,
			s->splats.n);
	for (size_t k = 0; k < m->moved; k++)
		if (motion_differs(m->means + 3 * k, s->splats.means + 3 * (size_t)m->ids[k], 3))
			return err_file(e, m->file.path,
				"tensor 'means': Gaussian %d is at its first time elsewhere than in %s",
				(int)m->ids[k], splats);
	for (size_t i = 0; i < s->cameras.n; i++) {
		const struct camera *c = &s->cameras.views[i];
		size_t frame;
		if (c->has_time && motion_find(m, c->time, &frame, e))
			return err_prefix(e, c->name);
	}
	return 0;
}

static int read_motion(struct scene *s, const char *dir, const char *splats, struct err *e)
{
	SCOPED char *path = file_join(dir, "motion.safetensors", "", e);

	if (!path)
		return -1;
	if (!file_exists(path)) {
		for (size_t i = 0; i < s->cameras.n; i++)
			s->cameras.views[i].has_time = 0;
		return 0;
	}
	return -(motion_open(&s->motion, path, e) || check_motion(s, splats, e));
}

int scene_read(struct scene *s, const char *dir, struct err *e)
{
	SCOPED char *path = file_join(dir, "splats.safetensors", "", e);

	*s = (struct scene){0};
	return -(!path || scene_read_splats(s, path, e) || !(s->path = mem_strdup(dir, e)) ||
		 scene_read_cameras(&s->cameras, dir, e) || read_motion(s, dir, path, e));
}

int scene_check(const struct scene *s, const char *path, size_t gaussians, const struct fingerprint *of,
	struct err *e)
{
	if (gaussians != s->splats.n)
		return err_set(e, ERR_FORMAT, "%s: is of a scene of %zu Gaussians, %s has %zu", path,
			gaussians, s->path, s->splats.n);
	return fingerprint_check("scene", path, of, s->path, &s->fingerprint, e);
}

void scene_free(struct scene *s)
{
	free(s->path);
	splats_free(&s->splats);
	cameras_free(&s->cameras);
	motion_close(&s->motion);
	*s = (struct scene){0};
}

static void put_lens(FILE *out, const struct lens *l)
{
	fprintf(out, ",\n  \"lens\":{\"model\":\"%s\",\"width\":%d,\"height\":%d,\"parameters\":",
		lens_model_name(l->model), l->width, l->height);
	for (int i = 0; i < lens_model_parameters(l->model); i++)
		fprintf(out, "%c%.17g", i ? ',' : '[', l->parameters[i]);
	fputs("]}", out);
}

static void put_view(FILE *out, const struct camera *c)
{
	jsonl_put_string(out, "{\"name\":", c->name);
	fprintf(out,
		",\"width\":%d,\"height\":%d,\"fx\":%.17g,\"fy\":%.17g,\"cx\":%.17g,\"cy\":%.17g,\n"
		"  \"world_to_camera\":[",
		c->width, c->height, c->fx, c->fy, c->cx, c->cy);
	for (int r = 0; r < 4; r++) {
		const double *row = c->world_to_camera[r];
		fprintf(out, "%s[%.17g,%.17g,%.17g,%.17g]", r ? "," : "", row[0], row[1], row[2], row[3]);
	}
	fprintf(out, "],\n  \"split\":\"%s\",\"image\":", c->split == SPLIT_TEST ? "test" : "train");
	if (c->image)
		jsonl_put_string(out, "", c->image);
	else
		fputs("null", out);
	if (c->source)
		jsonl_put_string(out, ",\"source\":", c->source);
	if (c->has_time)
		fprintf(out, ",\"time\":%.17g", c->time);
	if (c->lens.model)
		put_lens(out, &c->lens);
	fputs("}", out);
}

static void put_cameras(FILE *out, const void *cameras)
{
	const struct cameras *c = cameras;

	fputs("[", out);
	for (size_t i = 0; i < c->n; i++) {
		fputs(i ? ",\n " : "\n ", out);
		put_view(out, &c->views[i]);
	}
	fputs("\n]\n", out);
}

static int write_splats(const struct scene *s, const char *path, const char *options, struct err *e)
{
	const struct splats *p = &s->splats;
	const int64_t n = (int64_t)p->n;
	const struct fingerprint own = fingerprint_scene(p);
	struct arrays_out out;

	arrays_out_begin(&out, path, "refer.splats", "1", "gs-import", options, 0, e);
	arrays_out_text(&out, "offset",
		arrays_out_print(&out, "[%.17g,%.17g,%.17g]", s->offset[0], s->offset[1], s->offset[2]));
	arrays_out_text(&out, "scene", own.hex);
	if (p->near != SPLATS_NEAR)
		arrays_out_text(&out, "near", arrays_out_print(&out, "%.17g", p->near));
	if (s->is_metric)
		arrays_out_text(&out, "unit", "m");
	arrays_out_put(&out, st_matrix("means", ST_F32, n, 3, p->means));
	arrays_out_put(&out, st_matrix("scales", ST_F32, n, 3, p->scales));
	arrays_out_put(&out, st_matrix("quats", ST_F32, n, 4, p->quats));
	arrays_out_put(&out, st_vector("opacities", ST_F32, n, p->opacities));
	arrays_out_put(&out, (struct st_tensor){"sh", ST_F32, 3, {n, p->sh_coefficients, 3}, p->sh, 0});
	return arrays_out_end(&out);
}

int scene_write(const struct scene *s, const char *dir, const char *options, struct err *e)
{
	if (file_make_dir(dir, e))
		return -1;
	SCOPED char *splats = file_join(dir, "splats.safetensors", "", e),
		    *cameras = file_join(dir, "cameras.json", "", e);
	if (!splats || !cameras || write_splats(s, splats, options, e))
		return -1;
	return file_out_put(cameras, put_cameras, &s->cameras, e);
}
