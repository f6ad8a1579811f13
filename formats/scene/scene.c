#include "formats/scene/scene.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/name.h"
#include "base/names.h"
#include "formats/arrays/safetensors.h"
#include "formats/records/json.h"
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
		err_file(e, path, "tensor 'sh': %lld coefficients, expected 1, 4, 9 or 16", (long long)k);
		goto done;
	}
	const char *offset = safetensors_meta(&st, "offset");
	if (offset &&
		(sscanf(offset, "[%lf,%lf,%lf]", &s->offset[0], &s->offset[1], &s->offset[2]) != 3 ||
			!isfinite(s->offset[0]) || !isfinite(s->offset[1]) || !isfinite(s->offset[2]))) {
		err_file(e, path, "metadata 'offset' is not three numbers");
		goto done;
	}
	if (splats_alloc(&s->splats, (size_t)n, (int)k, e))
		goto done;
	const char *near = safetensors_meta(&st, "near");
	char after;
	if (near && (sscanf(near, "%lf%c", &s->splats.near, &after) != 1 || !(s->splats.near > 0) ||
			    !isfinite(s->splats.near))) {
		err_file(e, path, "metadata 'near' is not a number above 0");
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
	const cJSON *v = json_get(view, key);

	if (!cJSON_IsNumber(v) || !isfinite(v->valuedouble))
		return err_file(e, path, "view %d: key '%s' is not a number", index, key);
	*out = v->valuedouble;
	return 0;
}

/* A rotation and a translation, nothing else. */
static int check_rigid(const struct camera *c, const char *path, int index, struct err *e)
{
	const double(*m)[4] = (const double(*)[4])c->world_to_camera;

	if (m[3][0] != 0 || m[3][1] != 0 || m[3][2] != 0 || m[3][3] != 1)
		return err_file(e, path, "view %d: world_to_camera's last row is not 0 0 0 1", index);
	for (int a = 0; a < 3; a++)
		for (int b = 0; b < 3; b++) {
			const double *x = m[a], *y = m[b];
			double dot = x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
			if (fabs(dot - (a == b)) > 1e-4)
				return err_file(e, path, "view %d: world_to_camera is not a rotation", index);
		}
	double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
		     m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
		     m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
	if (det < 0)
		return err_file(e, path, "view %d: world_to_camera is a reflection", index);
	return 0;
}

static int read_pose(struct camera *c, const cJSON *view, const char *path, int index, struct err *e)
{
	const cJSON *rows = json_get(view, "world_to_camera"), *row = NULL;
	int r = 0;

	if (cJSON_GetArraySize(rows) != 4)
		return err_file(e, path, "view %d: key 'world_to_camera' is not 4x4", index);
	cJSON_ArrayForEach(row, rows)
	{
		if (cJSON_GetArraySize(row) != 4)
			return err_file(e, path, "view %d: key 'world_to_camera' is not 4x4", index);
		for (int k = 0; k < 4; k++) {
			const cJSON *v = cJSON_GetArrayItem(row, k);
			if (!cJSON_IsNumber(v) || !isfinite(v->valuedouble))
				return err_file(e, path, "view %d: world_to_camera[%d][%d] is not a number",
					index, r, k);
			c->world_to_camera[r][k] = v->valuedouble;
		}
		r++;
	}
	return check_rigid(c, path, index, e);
}

static int read_name(struct camera *c, const cJSON *view, const char *path, int index, struct err *e)
{
	const cJSON *name = json_get(view, "name");
	char fault[NAME_FAULT];

	if (!cJSON_IsString(name))
		return err_file(e, path, "view %d: key 'name' is not a string", index);
	const char *reason = name_fault(name->valuestring, NAME_VIEW, fault);
	if (reason)
		return err_file(e, path, "view %d: key 'name' %s", index, reason);
	c->name = name_copy(name->valuestring, e);
	return c->name ? 0 : -1;
}

/* The photograph's camera, where it is not the view's pinhole. */
static int read_lens(struct lens *l, const cJSON *view, const char *path, int index, struct err *e)
{
	const cJSON *lens = json_get(view, "lens");
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

/* A string that may be absent. */
static int read_path(
	char **to, const cJSON *view, const char *key, const char *path, int index, struct err *e)
{
	const cJSON *value = json_get(view, key);

	if (!value || cJSON_IsNull(value))
		return 0;
	if (!cJSON_IsString(value))
		return err_file(e, path, "view %d: key '%s' is not a string", index, key);
	return (*to = mem_strdup(value->valuestring, e)) ? 0 : -1;
}

static int read_view(struct camera *c, const cJSON *view, const char *path, int index, struct err *e)
{
	const cJSON *split = json_get(view, "split");
	double width = 0, height = 0;
	const struct {
		const char *key;
		double *to;
	} numbers[] = {{"width", &width}, {"height", &height}, {"fx", &c->fx}, {"fy", &c->fy}, {"cx", &c->cx},
		{"cy", &c->cy}};

	if (read_name(c, view, path, index, e))
		return -1;
	for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
		if (view_number(view, numbers[i].key, path, index, numbers[i].to, e))
			return -1;
	if (read_pose(c, view, path, index, e) || read_lens(&c->lens, view, path, index, e))
		return -1;
	if (view_set_size(c, width, height))
		return err_file(e, path, "view %d: size %gx%g is not whole numbers in 1 to 65536", index,
			width, height);
	if (!(c->fx > 0 && c->fy > 0))
		return err_file(e, path, "view %d: focal length is not positive", index);
	if (!cJSON_IsString(split) ||
		(strcmp(split->valuestring, "train") && strcmp(split->valuestring, "test")))
		return err_file(e, path, "view %d: key 'split' is not \"train\" or \"test\"", index);
	c->split = !strcmp(split->valuestring, "test") ? SPLIT_TEST : SPLIT_TRAIN;
	return read_path(&c->image, view, "image", path, index, e) ||
	       read_path(&c->source, view, "source", path, index, e);
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

	if (!cJSON_IsArray(list))
		return err_file(e, path, "not a list of views");
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
