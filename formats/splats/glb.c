#include "formats/splats/glb.h"

#include "formats/records/json.h"
#include "geom/rotation.h"
#include "splat/move.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COMPONENT(type) (1u << (GLB_##type - GLB_I8))
enum { SH_DEGREE_MOST = 3, SH_COEFFICIENTS = 16 };

/* glTF's y is up and its z front, a .ply's are down and front: x and y are turned round. */
static const double signs[3] = {-1, -1, 1};

struct source {
	struct glb file;
	struct glb_values means, scales, quats, opacities, sh[SH_COEFFICIENTS];
	int coefficients;
	double before[3]; /* added to means before they are turned and scaled */
};

/* The one primitive that has Gaussians, and its mesh. */
static const cJSON *find_primitive(const struct glb *f, int *mesh, struct err *e)
{
	const cJSON *found = NULL, *of_mesh, *primitive;
	int count = 0, i = 0;

	cJSON_ArrayForEach(of_mesh, json_get(f->root, "meshes"))
	{
		cJSON_ArrayForEach(primitive, json_get(of_mesh, "primitives"))
		{
			const cJSON *extensions = json_get(primitive, "extensions");
			if (!json_get(extensions, GLB_EXTENSION))
				continue;
			found = primitive;
			*mesh = i;
			count++;
		}
		i++;
	}
	if (count == 1)
		return found;
	err_file(e, f->name, "%d primitives with " GLB_EXTENSION ", expected 1%s", count,
		count ? "" : ": it is no scene of Gaussians");
	return NULL;
}

/* What else the file needs its reader to know. */
static int check_required(const struct glb *f, struct err *e)
{
	const cJSON *name;

	cJSON_ArrayForEach(name, json_get(f->root, "extensionsRequired"))
	{
		const char *text = cJSON_GetStringValue(name);
		if (!text || strcmp(text, GLB_EXTENSION))
			return err_file(e, f->name, "needs the extension '%.80s', which is not read",
				text ? text : "?");
	}
	return 0;
}

/* A key of the extension that must have one of two values; absent: it has. */
static int check_key(const struct glb *f, const cJSON *object, const char *key, const char *expected,
	const char *also, struct err *e)
{
	const cJSON *item = json_get(object, key);
	const char *text = cJSON_GetStringValue(item);

	if (!item || (text && (!strcmp(text, expected) || !strcmp(text, also))))
		return 0;
	return err_file(e, f->name, "key '%s' is '%.80s', expected '%s'", key, text ? text : "?", expected);
}

static int check_primitive(const struct glb *f, const cJSON *primitive, struct err *e)
{
	const cJSON *extension = json_get(json_get(primitive, "extensions"), GLB_EXTENSION),
		    *packed = json_get(extension, "extensions");
	char at[256];
	double mode = 4;

	snprintf(at, sizeof at, "%.200s: primitive", f->name);
	if (json_number(primitive, "mode", 0, &mode, at, e) < 0)
		return -1;
	if (mode != 0)
		return err_file(e, f->name, "the primitive's mode is %g, expected 0 (points)", mode);
	if (cJSON_GetArraySize(packed))
		return err_file(e, f->name, "Gaussians of the extension '%.80s', which is not read",
			packed->child->string);
	return -(check_key(f, extension, "kernel", "ellipse", "ellipse", e) ||
		 check_key(f, extension, "projection", "perspective", "perspective", e) ||
		 check_key(f, extension, "colorSpace", "srgb_rec709_display", "BT.709", e));
}

/* An attribute that has to be there, of all Gaussians. */
static int need(struct source *in, const cJSON *primitive, const char *name, int width, unsigned components,
	struct glb_values *v, struct err *e)
{
	if (glb_attribute(&in->file, primitive, name, width, components, v, e))
		return -1;
	if (!v->data && !v->n)
		return err_file(e, in->file.name, "no attribute %s", name);
	if (v->n != in->means.n)
		return err_file(e, in->file.name, "%s: %zu items for %zu Gaussians", name, v->n, in->means.n);
	return 0;
}

/* Harmonics of whole degrees, as many as there are. */
static int find_harmonics(struct source *in, const cJSON *primitive, struct err *e)
{
	const cJSON *attributes = json_get(primitive, "attributes");
	char name[64];

	for (int degree = 0, k = 0; degree <= SH_DEGREE_MOST; degree++) {
		snprintf(name, sizeof name, GLB_EXTENSION ":SH_DEGREE_%d_COEF_0", degree);
		if (degree && !json_get(attributes, name))
			return 0;
		for (int c = 0; c <= 2 * degree; c++, k++) {
			snprintf(name, sizeof name, GLB_EXTENSION ":SH_DEGREE_%d_COEF_%d", degree, c);
			if (need(in, primitive, name, 3, COMPONENT(F32), &in->sh[k], e))
				return -1;
		}
		in->coefficients = k;
	}
	return 0;
}

static int find_attributes(struct source *in, const cJSON *primitive, struct err *e)
{
	const unsigned signed_ones = COMPONENT(F32) | COMPONENT(I8) | COMPONENT(I16);
	const unsigned unsigned_ones = COMPONENT(F32) | COMPONENT(U8) | COMPONENT(U16);

	if (glb_attribute(&in->file, primitive, "POSITION", 3, COMPONENT(F32), &in->means, e))
		return -1;
	return -(
		need(in, primitive, "POSITION", 3, COMPONENT(F32), &in->means, e) ||
		need(in, primitive, GLB_EXTENSION ":SCALE", 3, signed_ones | unsigned_ones, &in->scales, e) ||
		need(in, primitive, GLB_EXTENSION ":ROTATION", 4, signed_ones, &in->quats, e) ||
		need(in, primitive, GLB_EXTENSION ":OPACITY", 1, unsigned_ones, &in->opacities, e) ||
		find_harmonics(in, primitive, e));
}

/* From x, y, z, w, after half a turn about z. */
static void take_quat(const struct source *in, size_t row, double *wxyz)
{
	wxyz[0] = glb_value(&in->quats, row, 2);
	wxyz[1] = glb_value(&in->quats, row, 1);
	wxyz[2] = -glb_value(&in->quats, row, 0);
	wxyz[3] = -glb_value(&in->quats, row, 3);
}

static int next_row(void *reader, size_t row, double *values, struct err *e)
{
	const struct source *in = reader;
	const int rest = in->coefficients - 1;

	for (int k = 0; k < 3; k++) {
		const double scale = glb_value(&in->scales, row, k);
		if (scale < 0)
			return err_file(e, in->file.name,
				"Gaussian %zu: a scale of %g: drafts of " GLB_EXTENSION
				" had logarithms, which are not read",
				row, scale);
		values[ROW_MEAN + k] = signs[k] * (glb_value(&in->means, row, k) + in->before[k]);
		values[ROW_SCALE + k] = log(scale);
		values[ROW_DC + k] = glb_value(&in->sh[0], row, k);
	}
	values[ROW_OPACITY] = gaussian_logit(glb_value(&in->opacities, row, 0));
	take_quat(in, row, values + ROW_ROT);
	for (int k = 0; k < rest; k++)
		for (int c = 0; c < 3; c++)
			values[ROW_REST + c * rest + k] = gaussian_flip_sign(k + 1, FLIP_X | FLIP_Y) *
							  glb_value(&in->sh[k + 1], row, c);
	return 0;
}

/* scale R x + shift = scale R (x + before): means are shifted first, in double, where a scene far from the
 * origin gets its offset. */
static void shift_before(struct source *in, const struct glb_place *place)
{
	for (int k = 0; k < 3; k++) {
		in->before[k] = 0;
		for (int j = 0; j < 3; j++)
			in->before[k] += place->rotation[j][k] * place->shift[j] / place->scale;
	}
}

static void turn(struct splats *s, double offset[3], const struct glb_place *place)
{
	struct move m = {.scale = place->scale};
	double rotation[3][3];

	for (int r = 0; r < 3; r++)
		for (int c = 0; c < 3; c++)
			rotation[r][c] = signs[r] * signs[c] * place->rotation[r][c];
	rotation_to_quat((const double(*)[3])rotation, m.quat);
	if (m.scale != 1 || m.quat[1] != 0 || m.quat[2] != 0 || m.quat[3] != 0)
		splats_move(s, offset, &m);
}

static int read_all(
	struct source *in, struct splats *s, double offset[3], struct rows_report *report, struct err *e)
{
	struct glb_place place;
	int mesh = 0;

	if (check_required(&in->file, e))
		return -1;
	const cJSON *primitive = find_primitive(&in->file, &mesh, e);
	if (!primitive || check_primitive(&in->file, primitive, e) || find_attributes(in, primitive, e) ||
		glb_find_place(&place, &in->file, mesh, e))
		return -1;
	shift_before(in, &place);
	const struct gaussian_rows rows = {
		in->file.name, in->means.n, 3 * (in->coefficients - 1), next_row, in, NULL};
	if (gaussian_rows_read(s, offset, report, &rows, e))
		return -1;
	turn(s, offset, &place);
	return 0;
}

int glb_read_map(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, struct err *e)
{
	struct source in = {0};
	const int bad = glb_open(&in.file, name, map, e) || read_all(&in, s, offset, report, e);

	glb_close(&in.file);
	return bad;
}
