/* Modules and splats stand in the page packed (zlib) and as base64, in scripts of no language;
 * report_viewer.js unpacks them when the scene is first looked at. */
#include "cmd/report/reporting.h"

#include "base/base64.h"
#include "base/file.h"
#include "base/mem.h"
#include "cmd/text/encode.h"
#include "cmd/run/object_extents.h"
#include "geom/up.h"

#include <math.h>
#include <zlib.h>

__asm__(".section .rodata\n"
	".globl report_viewer_begin\nreport_viewer_begin:\n"
	".incbin \"cmd/report/report_viewer.js\"\n"
	".byte 0\n"
	".previous\n");
extern const char report_viewer_begin[];

/* What `make viewer` puts into its folder, by the names under which they import each other. */
static const struct {
	const char *name, *file;
} modules[] = {
	{"./three.core.min.js", "three.core.min.js"},
	{"three", "three.module.min.js"},
	{"three/addons/postprocessing/Pass.js", "Pass.js"},
	{"orbit", "OrbitControls.js"},
	{"spark", "spark.module.min.js"},
};

static int put_packed(FILE *out, const char *attributes, const void *bytes, size_t n, struct err *e)
{
	uLongf length = compressBound((uLong)n);
	SCOPED uint8_t *packed = mem_alloc(length, 1, "viewer", e);
	SCOPED char *text = NULL;

	if (packed && compress2(packed, &length, bytes, (uLong)n, Z_BEST_COMPRESSION) != Z_OK)
		err_set(e, ERR_SYSTEM, "viewer: cannot be packed");
	else if (packed)
		text = base64_text("", packed, length, e);
	if (text)
		fprintf(out, "<script type=\"text/plain\" %s>%s</script>\n", attributes, text);
	return text ? 0 : -1;
}

static int put_modules(FILE *out, const char *dir, struct err *e)
{
	for (size_t k = 0; k < sizeof modules / sizeof *modules; k++) {
		SCOPED char *path = file_join(dir, modules[k].file, "", e), *bytes = NULL;
		char attributes[80];
		size_t n;
		snprintf(attributes, sizeof attributes, "data-module=\"%s\"", modules[k].name);
		const int bad =
			!path || file_read(path, &bytes, &n, e) || put_packed(out, attributes, bytes, n, e);
		if (bad)
			return -1;
	}
	return 0;
}

/* To six digits of the largest. */
static cJSON *numbers(const double *x, int n)
{
	double rounded[3], most = 0;

	for (int k = 0; k < n; k++)
		most = fmax(most, fabs(x[k]));
	const double digits = most > 0 ? pow(10, 5 - floor(log10(most))) : 1;
	for (int k = 0; k < n; k++)
		rounded[k] = round(x[k] * digits) / digits;
	return cJSON_CreateDoubleArray(rounded, n);
}

static int add_box(cJSON *to, const struct box *b)
{
	cJSON *box = cJSON_AddObjectToObject(to, "box"), *axes = cJSON_AddArrayToObject(box, "axes");
	int fine = report_add(box, "centre", numbers(b->centre, 3)) &&
		   report_add(box, "half", numbers(b->half, 3));

	for (int k = 0; k < 3 && fine; k++)
		fine = cJSON_AddItemToArray(axes, numbers(b->axes[k], 3));
	return fine;
}

static int add_groups(
	cJSON *to, const struct report_run *r, const struct report_splats *s, const struct extent *extents)
{
	cJSON *list = cJSON_AddArrayToObject(to, "groups");
	int fine = list != NULL;

	for (size_t g = 0; g < s->groups && fine; g++) {
		cJSON *one = cJSON_CreateObject();
		fine = cJSON_AddItemToArray(list, one) &&
		       cJSON_AddNumberToObject(one, "count", (double)s->counts[g]);
		if (g && fine)
			fine = cJSON_AddStringToObject(one, "name", r->lifted.lifted.names[g - 1]) &&
			       (!extents[g - 1].n || add_box(one, &extents[g - 1].turned));
	}
	return fine;
}

/* Where the viewer begins: the first view that has a picture. */
static int add_camera(cJSON *to, const struct report_run *r)
{
	const struct camera *c = r->shown_count ? &r->shown[0] : NULL;
	cJSON *camera = cJSON_AddObjectToObject(to, "camera");
	double centre[3], up[3];

	cameras_up(&r->scene.cameras, up);
	if (!report_add(to, "up", numbers(up, 3)) || !c)
		return camera != NULL;
	camera_centre(c, centre);
	return cJSON_AddStringToObject(camera, "name", c->name) &&
	       report_add(camera, "centre", numbers(centre, 3)) &&
	       report_add(camera, "forward", numbers(c->world_to_camera[2], 3)) &&
	       report_add(camera, "tan_x", cJSON_CreateNumber(round(5e4 * c->width / c->fx) / 1e5)) &&
	       report_add(camera, "tan_y", cJSON_CreateNumber(round(5e4 * c->height / c->fy) / 1e5));
}

/* Both ask to be handed on with their licences. */
static int add_licences(cJSON *to, const char *dir, struct err *e)
{
	static const char *const files[] = {"LICENSE.spark", "LICENSE.three"};
	cJSON *list = cJSON_AddArrayToObject(to, "licences");
	int bad = 0;

	for (size_t k = 0; k < 2 && !bad; k++) {
		SCOPED char *path = file_join(dir, files[k], "", e), *text = NULL;
		size_t n;
		bad = !path || file_read(path, &text, &n, e);
		if (!bad && !cJSON_AddItemToArray(list, cJSON_CreateString(text)))
			bad = err_set(e, ERR_SYSTEM, "viewer: out of memory");
	}
	return bad ? -1 : 0;
}

static int put_scene(FILE *out, const struct report_run *r, const struct report_splats *s,
	const struct extent *extents, const char *dir, struct err *e)
{
	cJSON *scene = cJSON_CreateObject();
	int bad = !cJSON_AddNumberToObject(scene, "count", (double)s->n) ||
		  !cJSON_AddNumberToObject(scene, "most", (double)r->options->splats) ||
		  !cJSON_AddNumberToObject(scene, "all", (double)r->scene.splats.n) ||
		  !cJSON_AddNumberToObject(
			  scene, "least_opacity", round(1e4 * (double)REPORT_LEAST_OPACITY) / 1e4) ||
		  !add_groups(scene, r, s, extents) || !add_camera(scene, r);

	bad = bad ? err_set(e, ERR_SYSTEM, "viewer: out of memory") : add_licences(scene, dir, e);
	fputs("<script type=\"application/json\" id=\"scene\">", out);
	bad = bad || report_json_put(out, scene, e);
	fputs("</script>\n", out);
	cJSON_Delete(scene);
	return bad ? -1 : 0;
}

static int put_viewer(FILE *out, const struct report_run *r, const char *dir, struct err *e)
{
	struct report_splats s = {0};
	struct extent *extents = NULL;
	const struct lifted *l = &r->lifted.lifted;
	int bad = report_splats_make(&s, r, e) ||
		  (r->has_lifted && !(extents = object_extents(l, &r->scene.splats, &r->scene.cameras, e))) ||
		  put_modules(out, dir, e) || put_scene(out, r, &s, extents, dir, e) ||
		  put_packed(out, "id=\"splats\"", s.bytes, 32 * s.n, e);

	if (!bad)
		fprintf(out, "<script>\n%s</script>\n", report_viewer_begin);
	object_extents_free(extents, l->objects);
	report_splats_free(&s);
	return bad ? -1 : 0;
}

int report_viewer_put(FILE *out, const struct report_run *r, const struct report *to, struct err *e)
{
	const char *given = r->options->viewer;

	if (r->options->is_plain)
		return 0;
	SCOPED char *dir = given ? mem_strdup(given, e) : cache_folder("viewer", e);
	if (!dir)
		return given ? -1 : 0;
	int bad = 0;
	if (given || file_is_dir(dir))
		bad = put_viewer(out, r, dir, e);
	else
		report_note(to, 1, "%s: no viewer there: 'make viewer' fetches one", dir);
	return bad;
}
