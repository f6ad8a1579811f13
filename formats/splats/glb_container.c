/* The container of a .glb, and what of glTF stands around the Gaussians: chunks, accessors, nodes. */
#include "base/little.h"
#include "base/mem.h"
#include "formats/records/json.h"
#include "formats/splats/glb.h"
#include "geom/rotation.h"

#include <math.h>
#include <stdio.h>

/* Nodes above a node, at most: more are a circle. */
enum { DEPTH_MOST = 64 };
/* A node's axes may differ so much from even ones, beside their length. */
static const double evenness = 1e-4;

int glb_is(const struct file_map *map)
{
	return map->len >= 4 && little_get(map->data, 4) == GLB_MAGIC;
}

/* The chunk at *at, which moves behind it; its type is checked. */
static int next_chunk(const struct glb *f, size_t *at, uint32_t type, const unsigned char **data,
	size_t *length, struct err *e)
{
	const size_t left = f->map->len - *at;

	if (left < GLB_CHUNK)
		return err_file(e, f->name, "no chunk at offset %zu", *at);
	*length = (size_t)little_get(f->map->data + *at, 4);
	if (little_get(f->map->data + *at + 4, 4) != type)
		return err_file(e, f->name, "the chunk at offset %zu is not of type %s", *at,
			type == GLB_JSON ? "JSON" : "BIN");
	if (*length > left - GLB_CHUNK)
		return err_file(e, f->name, "a chunk of %zu from offset %zu does not fit a file of %zu",
			*length, *at, f->map->len);
	*data = f->map->data + *at + GLB_CHUNK;
	*at += GLB_CHUNK + *length;
	return 0;
}

static int parse_json(struct glb *f, const unsigned char *data, size_t length, struct err *e)
{
	SCOPED char *text = mem_alloc(length + 1, 1, f->name, e);

	if (!text)
		return -1;
	memcpy(text, data, length);
	text[length] = 0;
	f->root = json_parse(text, length, f->name, e);
	return f->root ? 0 : -1;
}

int glb_open(struct glb *f, const char *name, const struct file_map *map, struct err *e)
{
	const unsigned char *json;
	size_t length, at = GLB_HEADER;

	*f = (struct glb){.name = name, .map = map, .bin = map->data};
	if (map->len < GLB_HEADER)
		return err_file(e, name, "%zu bytes, the header has %d", map->len, GLB_HEADER);
	if (!glb_is(map))
		return err_file(e, name, "not a .glb: it does not begin with 'glTF'");
	if (little_get(map->data + 4, 4) != 2)
		return err_file(
			e, name, "version %u of glTF, expected 2", (unsigned)little_get(map->data + 4, 4));
	if (little_get(map->data + 8, 4) != map->len)
		return err_file(e, name, "has %zu bytes, its header says %u", map->len,
			(unsigned)little_get(map->data + 8, 4));
	if (next_chunk(f, &at, GLB_JSON, &json, &length, e) ||
		(at < map->len && next_chunk(f, &at, GLB_BIN, &f->bin, &f->bin_length, e)))
		return -1;
	return parse_json(f, json, length, e);
}

void glb_close(struct glb *f)
{
	cJSON_Delete(f->root);
}

/* A whole number of an object from 0 on, at most 2^53. */
static int get_count(const struct glb *f, const cJSON *object, const char *key, int need, size_t *value,
	const char *what, struct err *e)
{
	const cJSON *item = json_get(object, key);
	const double x = cJSON_IsNumber(item) ? item->valuedouble : -1;

	if (!item && !need) {
		*value = 0;
		return 0;
	}
	if (!(x >= 0 && x <= 0x1p53 && x == floor(x)))
		return err_file(e, f->name, "%s: key '%s' is not a whole number from 0", what, key);
	*value = (size_t)x;
	return 0;
}

/* Item i of one of the root's lists. */
static const cJSON *item_of(const struct glb *f, const char *list, size_t i, struct err *e)
{
	const cJSON *items = json_get(f->root, list),
		    *item = i <= INT32_MAX ? cJSON_GetArrayItem(items, (int)i) : NULL;

	if (!cJSON_IsObject(item))
		err_file(e, f->name, "no item %zu in '%s'", i, list);
	return cJSON_IsObject(item) ? item : NULL;
}

static int component_size(int component)
{
	return component == GLB_F32 ? 4 : component < GLB_I16 ? 1 : 2;
}

/* The bytes of the accessor's buffer view, from its own offset on; v has the rest. */
static int find_bytes(
	const struct glb *f, const cJSON *accessor, const char *name, struct glb_values *v, struct err *e)
{
	const size_t item = (size_t)v->width * (size_t)component_size(v->component);
	size_t view_index = 0, buffer = 0, from = 0, begin = 0, length = 0;

	if (get_count(f, accessor, "bufferView", 1, &view_index, name, e) ||
		get_count(f, accessor, "byteOffset", 0, &from, name, e))
		return -1;
	const cJSON *view = item_of(f, "bufferViews", view_index, e);
	if (!view || get_count(f, view, "buffer", 1, &buffer, name, e) ||
		get_count(f, view, "byteOffset", 0, &begin, name, e) ||
		get_count(f, view, "byteLength", 1, &length, name, e) ||
		get_count(f, view, "byteStride", 0, &v->stride, name, e))
		return -1;
	if (buffer || json_get(view, "extensions"))
		return err_file(e, f->name, "%s: its bytes are not in the file as they are", name);
	v->stride = v->stride ? v->stride : item;
	if (begin > f->bin_length || length > f->bin_length - begin)
		return err_file(e, f->name, "%s: %zu bytes from offset %zu do not fit a binary chunk of %zu",
			name, length, begin, f->bin_length);
	if (!item || v->stride < item || from > length ||
		(v->n && (length - from < item || (length - from - item) / v->stride < v->n - 1)))
		return err_file(e, f->name, "%s: %zu items of %zu bytes do not fit %zu", name, v->n,
			v->stride, length - (from > length ? length : from));
	v->data = f->bin + begin + from;
	return 0;
}

int glb_attribute(const struct glb *f, const cJSON *primitive, const char *name, int width,
	unsigned components, struct glb_values *v, struct err *e)
{
	static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
	const cJSON *attributes = json_get(primitive, "attributes");
	size_t index = 0, component = 0;

	*v = (struct glb_values){.width = width};
	if (!json_get(attributes, name))
		return 0;
	if (get_count(f, attributes, name, 1, &index, "attributes", e))
		return -1;
	const cJSON *accessor = item_of(f, "accessors", index, e);
	if (!accessor || get_count(f, accessor, "count", 1, &v->n, name, e) ||
		get_count(f, accessor, "componentType", 1, &component, name, e))
		return -1;
	const char *type = cJSON_GetStringValue(json_get(accessor, "type"));
	if (!type || strcmp(type, types[width]))
		return err_file(e, f->name, "%s: is of type %.40s, expected %s", name, type ? type : "none",
			types[width]);
	v->is_normalized = cJSON_IsTrue(json_get(accessor, "normalized"));
	if (component < GLB_I8 || component > GLB_F32 || !(components >> (component - GLB_I8) & 1))
		return err_file(e, f->name, "%s: has components of type %zu", name, component);
	if (json_get(accessor, "sparse"))
		return err_file(e, f->name, "%s: is sparse", name);
	v->component = (int)component;
	return find_bytes(f, accessor, name, v, e);
}

double glb_value(const struct glb_values *v, size_t i, int k)
{
	const unsigned char *p = v->data + i * v->stride + (size_t)k * (size_t)component_size(v->component);

	switch (v->component) {
	case GLB_I8:
		return v->is_normalized ? fmax((int8_t)*p / 127.0, -1) : (int8_t)*p;
	case GLB_U8:
		return v->is_normalized ? *p / 255.0 : *p;
	case GLB_I16: {
		const double x = (int16_t)little_get(p, 2);
		return v->is_normalized ? fmax(x / 32767, -1) : x;
	}
	case GLB_U16: {
		const double x = (double)little_get(p, 2);
		return v->is_normalized ? x / 65535 : x;
	}
	default:
		return (double)little_get_f32(p);
	}
}

/* A node's own matrix (3 rows of 4): its matrix, column by column, or its scale, rotation and translation. */
static int read_node(const struct glb *f, const cJSON *node, int i, double m[3][4], struct err *e)
{
	double columns[16], shift[3] = {0}, quat[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
	double wxyz[4], rotation[3][3];
	char at[256];
	const struct {
		const char *key;
		int n;
		double *to;
	} parts[] = {{"translation", 3, shift}, {"rotation", 4, quat}, {"scale", 3, scale}};

	snprintf(at, sizeof at, "%.200s: node %d", f->name, i);
	if (json_get(node, "matrix")) {
		if (json_matrix(node, "matrix", 16, 0, columns, at, e))
			return -1;
		for (int r = 0; r < 3; r++)
			for (int c = 0; c < 4; c++)
				m[r][c] = columns[4 * c + r];
		return 0;
	}
	for (int k = 0; k < 3; k++)
		if (json_get(node, parts[k].key) &&
			json_matrix(node, parts[k].key, parts[k].n, 0, parts[k].to, at, e))
			return -1;
	if (quat[0] == 0 && quat[1] == 0 && quat[2] == 0 && quat[3] == 0)
		return err_file(e, at, "key 'rotation' is zero");
	for (int k = 0; k < 4; k++)
		wxyz[k] = quat[(k + 3) % 4];
	rotation_of_quat(wxyz, rotation);
	for (int r = 0; r < 3; r++) {
		for (int c = 0; c < 3; c++)
			m[r][c] = rotation[r][c] * scale[c];
		m[r][3] = shift[r];
	}
	return 0;
}

/* m = above m, both with a last row 0 0 0 1. */
static void put_under(double m[3][4], double above[3][4])
{
	double product[3][4];

	for (int r = 0; r < 3; r++)
		for (int c = 0; c < 4; c++) {
			product[r][c] = c == 3 ? above[r][3] : 0;
			for (int k = 0; k < 3; k++)
				product[r][c] += above[r][k] * m[k][c];
		}
	memcpy(m, product, sizeof product);
}

/* The node that has `child`, or the mesh where child is negative; -1 where none has. *count gets how many. */
static int find_node(const struct glb *f, int child, int mesh, int *count)
{
	const cJSON *node, *item;
	int i = 0, found = -1;

	*count = 0;
	cJSON_ArrayForEach(node, json_get(f->root, "nodes"))
	{
		int is_it = 0;
		if (child < 0) {
			item = json_get(node, "mesh");
			is_it = cJSON_IsNumber(item) && item->valuedouble == mesh;
		} else {
			cJSON_ArrayForEach(item, json_get(node, "children")) is_it |=
				cJSON_IsNumber(item) && item->valuedouble == child;
		}
		*count += is_it;
		found = is_it ? i : found;
		i++;
	}
	return found;
}

/* The scale, the rotation and the shift of a matrix that is nothing else. */
static int take_apart(struct glb_place *place, double m[3][4], const struct glb *f, int node, struct err *e)
{
	const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
				   m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
				   m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
	int is_even = determinant > 0 && isfinite(determinant);

	place->scale = cbrt(determinant);
	for (int r = 0; r < 3; r++) {
		place->shift[r] = m[r][3];
		for (int c = 0; c < 3; c++)
			place->rotation[r][c] = m[r][c] / place->scale;
	}
	for (int a = 0; a < 3; a++)
		for (int b = 0; b <= a; b++) {
			double dot = a == b ? -1 : 0;
			for (int k = 0; k < 3; k++)
				dot += place->rotation[a][k] * place->rotation[b][k];
			is_even &= fabs(dot) < evenness;
		}
	return is_even ? 0
		       : err_file(e, f->name,
				 "node %d: is mirrored or scaled unevenly, which Gaussians cannot be", node);
}

int glb_find_place(struct glb_place *place, const struct glb *f, int mesh, struct err *e)
{
	double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, own[3][4] = {{0}};
	int count, first = find_node(f, -1, mesh, &count);

	if (count > 1)
		return err_file(e, f->name, "the Gaussians are in %d places, expected one", count);
	for (int node = first, depth = 0; node >= 0; node = find_node(f, node, 0, &count)) {
		const cJSON *item = item_of(f, "nodes", (size_t)node, e);
		if (!item || read_node(f, item, node, own, e))
			return -1;
		if (depth++ == DEPTH_MOST)
			return err_file(
				e, f->name, "node %d: more than %d nodes above a node", first, DEPTH_MOST);
		put_under(m, own);
	}
	return take_apart(place, m, f, first, e);
}
