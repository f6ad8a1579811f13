/* Writing of scene folders. */
#include "base/file.h"
#include "formats/arrays/arrays_out.h"
#include "formats/scene/scene.h"
#include "geom/lens.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>

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
	char *splats = file_join(dir, "splats.safetensors", "", e),
	     *cameras = file_join(dir, "cameras.json", "", e);
	const int bad = !splats || !cameras || write_splats(s, splats, options, e) ||
			write_cameras(&s->cameras, cameras, e);
	free(splats);
	free(cameras);
	return bad ? -1 : 0;
}
