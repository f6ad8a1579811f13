#include "formats/scene/scene.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/names.h"
#include "formats/records/json.h"
#include "formats/arrays/safetensors.h"
#include "geom/lens.h"
#include "geom/views.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int check_values(const struct splats *s, const char *path, struct err *e)
{
	for (size_t i = 0; i < s->n; i++) {
		const float *m = s->means + 3 * i, *c = s->scales + 3 * i, *q = s->quats + 4 * i;
		double length = (double)fabsf(q[0]) + fabsf(q[1]) + fabsf(q[2]) + fabsf(q[3]);
		if (!isfinite(m[0]) || !isfinite(m[1]) || !isfinite(m[2]))
			return err_set(
				e, ERR_FORMAT, "%s: tensor 'means': Gaussian %zu is not finite", path, i);
		if (!(c[0] >= 0 && c[1] >= 0 && c[2] >= 0) || !isfinite((double)c[0] + c[1] + c[2]))
			return err_set(e, ERR_FORMAT,
				"%s: tensor 'scales': Gaussian %zu is negative or not finite", path, i);
		if (!(length > 0) || !isfinite(length))
			return err_set(e, ERR_FORMAT,
				"%s: tensor 'quats': Gaussian %zu is zero or not finite", path, i);
		if (!(s->opacities[i] >= 0 && s->opacities[i] <= 1))
			return err_set(e, ERR_FORMAT, "%s: tensor 'opacities': Gaussian %zu is not in [0,1]",
				path, i);
	}
	for (size_t i = 0; i < s->n * (size_t)s->sh_coefficients * 3; i++)
		if (!isfinite(s->sh[i]))
			return err_set(e, ERR_FORMAT, "%s: tensor 'sh': value %zu is not finite", path, i);
	return 0;
}

/* The means say it; the file's own word of it, where there is one, must be the same. */
static int take_fingerprint(struct scene *s, const struct safetensors *st, struct err *e)
{
	struct fingerprint own;

	s->fingerprint = fingerprint_scene(s->splats.means, s->splats.n);
	if (fingerprint_read(&own, st, "scene", e))
		return -1;
	if (*own.hex && strcmp(own.hex, s->fingerprint.hex))
		return err_set(e, ERR_FORMAT, "%s: metadata 'scene' is %s, but the means have %s", st->path,
			own.hex, s->fingerprint.hex);
	return 0;
}

int scene_read_splats(struct scene *s, const char *path, struct err *e)
{
	struct safetensors st;
	const struct st_tensor *t[5];
	int bad = -1;

	if (safetensors_open(&st, path, e))
		return -1;
	if (safetensors_need_format(&st, "refer.splats", 1, e) ||
		!(t[0] = safetensors_need(&st, "means", ST_F32, 2, (int64_t[]){-1, 3}, e)))
		goto done;
	int64_t n = t[0]->shape[0];
	if (!(t[1] = safetensors_need(&st, "scales", ST_F32, 2, (int64_t[]){n, 3}, e)) ||
		!(t[2] = safetensors_need(&st, "quats", ST_F32, 2, (int64_t[]){n, 4}, e)) ||
		!(t[3] = safetensors_need(&st, "opacities", ST_F32, 1, (int64_t[]){n}, e)) ||
		!(t[4] = safetensors_need(&st, "sh", ST_F32, 3, (int64_t[]){n, -1, 3}, e)))
		goto done;
	int64_t k = t[4]->shape[1];
	if (k != 1 && k != 4 && k != 9 && k != 16) {
		err_set(e, ERR_FORMAT, "%s: tensor 'sh': %lld coefficients, expected 1, 4, 9 or 16", path,
			(long long)k);
		goto done;
	}
	const char *offset = safetensors_meta(&st, "offset");
	if (offset &&
		(sscanf(offset, "[%lf,%lf,%lf]", &s->offset[0], &s->offset[1], &s->offset[2]) != 3 ||
			!isfinite(s->offset[0]) || !isfinite(s->offset[1]) || !isfinite(s->offset[2]))) {
		err_set(e, ERR_FORMAT, "%s: metadata 'offset' is not three numbers", path);
		goto done;
	}
	if (splats_alloc(&s->splats, (size_t)n, (int)k, e))
		goto done;
	const char *near = safetensors_meta(&st, "near");
	char after;
	if (near && (sscanf(near, "%lf%c", &s->splats.near, &after) != 1 || !(s->splats.near > 0) ||
			    !isfinite(s->splats.near))) {
		err_set(e, ERR_FORMAT, "%s: metadata 'near' is not a number above 0", path);
		goto done;
	}
	float *to[5] = {
		s->splats.means, s->splats.scales, s->splats.quats, s->splats.opacities, s->splats.sh};
	for (int i = 0; i < 5; i++)
		memcpy(to[i], t[i]->data, t[i]->bytes);
	bad = check_values(&s->splats, path, e) || take_fingerprint(s, &st, e) ? -1 : 0;
done:
	safetensors_close(&st);
	if (bad)
		splats_free(&s->splats);
	return bad;
}

/* A number, or an ERR_FORMAT that names the view and key. */
static int view_number(
	const cJSON *view, const char *key, const char *path, int index, double *out, struct err *e)
{
	const cJSON *v = cJSON_GetObjectItemCaseSensitive(view, key);

	if (!cJSON_IsNumber(v) || !isfinite(v->valuedouble))
		return err_set(e, ERR_FORMAT, "%s: view %d: key '%s' is not a number", path, index, key);
	*out = v->valuedouble;
	return 0;
}

/* A rotation and a translation, nothing else. */
static int check_rigid(const struct camera *c, const char *path, int index, struct err *e)
{
	const double(*m)[4] = (const double(*)[4])c->world_to_camera;

	if (m[3][0] != 0 || m[3][1] != 0 || m[3][2] != 0 || m[3][3] != 1)
		return err_set(
			e, ERR_FORMAT, "%s: view %d: world_to_camera's last row is not 0 0 0 1", path, index);
	for (int a = 0; a < 3; a++)
		for (int b = 0; b < 3; b++) {
			const double *x = m[a], *y = m[b];
			double dot = x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
			if (fabs(dot - (a == b)) > 1e-4)
				return err_set(e, ERR_FORMAT,
					"%s: view %d: world_to_camera is not a rotation", path, index);
		}
	double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
		     m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
		     m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
	if (det < 0)
		return err_set(e, ERR_FORMAT, "%s: view %d: world_to_camera is a reflection", path, index);
	return 0;
}

static int read_pose(struct camera *c, const cJSON *view, const char *path, int index, struct err *e)
{
	const cJSON *rows = cJSON_GetObjectItemCaseSensitive(view, "world_to_camera"), *row = NULL;
	int r = 0;

	if (cJSON_GetArraySize(rows) != 4)
		return err_set(e, ERR_FORMAT, "%s: view %d: key 'world_to_camera' is not 4x4", path, index);
	cJSON_ArrayForEach(row, rows)
	{
		if (cJSON_GetArraySize(row) != 4)
			return err_set(
				e, ERR_FORMAT, "%s: view %d: key 'world_to_camera' is not 4x4", path, index);
		for (int k = 0; k < 4; k++) {
			const cJSON *v = cJSON_GetArrayItem(row, k);
			if (!cJSON_IsNumber(v) || !isfinite(v->valuedouble))
				return err_set(e, ERR_FORMAT,
					"%s: view %d: world_to_camera[%d][%d] is not a number", path, index,
					r, k);
			c->world_to_camera[r][k] = v->valuedouble;
		}
		r++;
	}
	return check_rigid(c, path, index, e);
}

static int read_name(struct camera *c, const cJSON *view, const char *path, int index, struct err *e)
{
	const cJSON *name = cJSON_GetObjectItemCaseSensitive(view, "name");
	char fault[NAME_FAULT];

	if (!cJSON_IsString(name))
		return err_set(e, ERR_FORMAT, "%s: view %d: key 'name' is not a string", path, index);
	const char *reason = name_fault(name->valuestring, NAME_VIEW, fault);
	if (reason)
		return err_set(e, ERR_FORMAT, "%s: view %d: key 'name' %s", path, index, reason);
	c->name = name_copy(name->valuestring, e);
	return c->name ? 0 : -1;
}

/* The photograph's camera, where it is not the view's pinhole. */
static int read_lens(struct lens *l, const cJSON *view, const char *path, int index, struct err *e)
{
	const cJSON *lens = cJSON_GetObjectItemCaseSensitive(view, "lens");
	const char *model;
	double width, height;
	char where[512];

	if (!lens || cJSON_IsNull(lens))
		return 0;
	snprintf(where, sizeof where, "%s: view %d: key 'lens'", path, index);
	if (json_string(lens, "model", 1, &model, where, e) < 0 ||
		json_number(lens, "width", 1, &width, where, e) < 0 ||
		json_number(lens, "height", 1, &height, where, e) < 0)
		return -1;
	if (!(l->model = lens_model_named(model, strlen(model))))
		return err_set(e, ERR_FORMAT, "%s: camera model '%.60s' is unknown", where, model);
	struct camera size;
	if (view_set_size(&size, width, height))
		return err_set(e, ERR_FORMAT, "%s: size %gx%g is not whole numbers in 1 to 65536", where,
			width, height);
	l->width = size.width;
	l->height = size.height;
	if (json_matrix(lens, "parameters", lens_model_parameters(l->model), 0, l->parameters, where, e))
		return -1;
	for (int i = 0; i < lens_model_focals(l->model); i++)
		if (!(l->parameters[i] > 0))
			return err_set(e, ERR_FORMAT, "%s: focal length is not positive", where);
	return 0;
}

/* A string that may be absent. */
static int read_path(
	char **to, const cJSON *view, const char *key, const char *path, int index, struct err *e)
{
	const cJSON *value = cJSON_GetObjectItemCaseSensitive(view, key);

	if (!value || cJSON_IsNull(value))
		return 0;
	if (!cJSON_IsString(value))
		return err_set(e, ERR_FORMAT, "%s: view %d: key '%s' is not a string", path, index, key);
	return (*to = mem_strdup(value->valuestring, e)) ? 0 : -1;
}

static int read_view(struct camera *c, const cJSON *view, const char *path, int index, struct err *e)
{
	const cJSON *split = cJSON_GetObjectItemCaseSensitive(view, "split");
	double width = 0, height = 0;

	if (read_name(c, view, path, index, e) || view_number(view, "width", path, index, &width, e) ||
		view_number(view, "height", path, index, &height, e) ||
		view_number(view, "fx", path, index, &c->fx, e) ||
		view_number(view, "fy", path, index, &c->fy, e) ||
		view_number(view, "cx", path, index, &c->cx, e) ||
		view_number(view, "cy", path, index, &c->cy, e) || read_pose(c, view, path, index, e) ||
		read_lens(&c->lens, view, path, index, e))
		return -1;
	if (!(width >= 1 && width <= 65536 && width == floor(width) && height >= 1 && height <= 65536 &&
		    height == floor(height)))
		return err_set(e, ERR_FORMAT, "%s: view %d: size %gx%g is not whole numbers in 1 to 65536",
			path, index, width, height);
	if (!(c->fx > 0 && c->fy > 0))
		return err_set(e, ERR_FORMAT, "%s: view %d: focal length is not positive", path, index);
	c->width = (int)width;
	c->height = (int)height;
	if (!cJSON_IsString(split) ||
		(strcmp(split->valuestring, "train") && strcmp(split->valuestring, "test")))
		return err_set(
			e, ERR_FORMAT, "%s: view %d: key 'split' is not \"train\" or \"test\"", path, index);
	c->split = !strcmp(split->valuestring, "test") ? SPLIT_TEST : SPLIT_TRAIN;
	return read_path(&c->image, view, "image", path, index, e) ||
	       read_path(&c->source, view, "source", path, index, e);
}

static int check_unique(const struct cameras *c, const char *path, struct err *e)
{
	struct names names;
	size_t earlier;

	if (names_make(&names, c->views, sizeof *c->views, offsetof(struct camera, name), c->n, e))
		return -1;
	const size_t twice = names_twice(&names, &earlier);
	names_free(&names);
	return twice == NAMES_NONE ? 0
				   : err_set(e, ERR_FORMAT, "%s: view name '%s' appears twice", path,
					     c->views[twice].name);
}

static int read_views(struct cameras *c, const cJSON *list, const char *path, struct err *e)
{
	const cJSON *view;

	if (!cJSON_IsArray(list))
		return err_set(e, ERR_FORMAT, "%s: not a list of views", path);
	c->views = mem_zalloc((size_t)cJSON_GetArraySize(list), sizeof *c->views, path, e);
	if (!c->views)
		return -1;
	cJSON_ArrayForEach(view, list)
	{
		struct camera *one = &c->views[c->n++];
		if (read_view(one, view, path, (int)c->n - 1, e))
			return -1;
	}
	return check_unique(c, path, e);
}

int scene_read_cameras_file(struct cameras *c, const char *path, struct err *e)
{
	cJSON *list = json_read(path, e);

	*c = (struct cameras){0};
	int bad = list ? read_views(c, list, file_name(path), e) : -1;
	cJSON_Delete(list);
	if (bad)
		cameras_free(c);
	return bad;
}

static int read_cameras(struct cameras *c, const char *dir, struct err *e)
{
	char *path = file_join(dir, "cameras.json", "", e);
	int bad = path ? scene_read_cameras_file(c, path, e) : -1;

	free(path);
	return bad;
}

int scene_read(struct scene *s, const char *dir, struct err *e)
{
	char *path = file_join(dir, "splats.safetensors", "", e);

	*s = (struct scene){0};
	int bad = path ? scene_read_splats(s, path, e) : -1;
	free(path);
	if (bad || !(s->path = mem_strdup(dir, e)) || read_cameras(&s->cameras, dir, e)) {
		scene_free(s);
		return -1;
	}
	return 0;
}

void scene_free(struct scene *s)
{
	free(s->path);
	splats_free(&s->splats);
	cameras_free(&s->cameras);
	*s = (struct scene){0};
}

/* A JSON string, null for NULL. Returns -1 when memory is out. */
static int put_string(FILE *out, const char *text)
{
	cJSON *item = text ? cJSON_CreateString(text) : cJSON_CreateNull();
	char *json = cJSON_PrintUnformatted(item);
	int bad = !json || fputs(json, out) < 0;

	cJSON_Delete(item);
	free(json);
	return -bad;
}

static void put_lens(FILE *out, const struct lens *l)
{
	fprintf(out, ",\n  \"lens\":{\"model\":\"%s\",\"width\":%d,\"height\":%d,\"parameters\":",
		lens_model_name(l->model), l->width, l->height);
	for (int i = 0; i < lens_model_parameters(l->model); i++)
		fprintf(out, "%c%.17g", i ? ',' : '[', l->parameters[i]);
	fputs("]}", out);
}

static int put_view(FILE *out, const struct camera *c)
{
	fputs("{\"name\":", out);
	if (put_string(out, c->name))
		return -1;
	fprintf(out,
		",\"width\":%d,\"height\":%d,\"fx\":%.17g,\"fy\":%.17g,\"cx\":%.17g,\"cy\":%.17g,\n"
		"  \"world_to_camera\":[",
		c->width, c->height, c->fx, c->fy, c->cx, c->cy);
	for (int r = 0; r < 4; r++) {
		const double *row = c->world_to_camera[r];
		fprintf(out, "%s[%.17g,%.17g,%.17g,%.17g]", r ? "," : "", row[0], row[1], row[2], row[3]);
	}
	fprintf(out, "],\n  \"split\":\"%s\",\"image\":", c->split == SPLIT_TEST ? "test" : "train");
	int bad = put_string(out, c->image);
	if (c->source) {
		fputs(",\"source\":", out);
		bad = bad || put_string(out, c->source);
	}
	if (c->lens.model)
		put_lens(out, &c->lens);
	fputs("}", out);
	return bad;
}

static int write_cameras(const struct cameras *c, const char *path, struct err *e)
{
	struct file_out out;

	if (file_out_open(&out, path, e))
		return -1;
	fputs("[", out.stream);
	for (size_t i = 0; i < c->n; i++) {
		fputs(i ? ",\n " : "\n ", out.stream);
		if (put_view(out.stream, &c->views[i])) {
			file_out_abort(&out);
			return err_set(e, ERR_SYSTEM, "%s: out of memory", path);
		}
	}
	fputs("\n]\n", out.stream);
	return file_out_commit(&out, e);
}

int scene_write(const struct scene *s, const char *dir, const char *options, struct err *e)
{
	const struct splats *p = &s->splats;
	int64_t n = (int64_t)p->n;
	const struct fingerprint own = fingerprint_scene(p->means, p->n);
	char offset[128], near[32];
	struct st_tensor tensors[] = {
		{.name = "means", .dtype = ST_F32, .dims = 2, .shape = {n, 3}, .data = p->means},
		{.name = "scales", .dtype = ST_F32, .dims = 2, .shape = {n, 3}, .data = p->scales},
		{.name = "quats", .dtype = ST_F32, .dims = 2, .shape = {n, 4}, .data = p->quats},
		{.name = "opacities", .dtype = ST_F32, .dims = 1, .shape = {n}, .data = p->opacities},
		{.name = "sh",
			.dtype = ST_F32,
			.dims = 3,
			.shape = {n, p->sh_coefficients, 3},
			.data = p->sh},
	};
	struct st_meta meta[] = {{"format", "refer.splats"}, {"version", "1"}, {"tool", "gs-import"},
		{"options", options}, {"seed", "0"}, {"offset", offset}, {"scene", own.hex}, {"near", near}};
	const size_t keys = sizeof meta / sizeof *meta - (p->near == SPLATS_NEAR);

	snprintf(near, sizeof near, "%.17g", p->near);
	snprintf(offset, sizeof offset, "[%.17g,%.17g,%.17g]", s->offset[0], s->offset[1], s->offset[2]);
	if (file_make_dir(dir, e))
		return -1;
	char *splats = file_join(dir, "splats.safetensors", "", e),
	     *cameras = file_join(dir, "cameras.json", "", e);
	int bad = !splats || !cameras || safetensors_write(splats, tensors, 5, meta, keys, e) ||
		  write_cameras(&s->cameras, cameras, e);
	free(splats);
	free(cameras);
	return bad ? -1 : 0;
}
