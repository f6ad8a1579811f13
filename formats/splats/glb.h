/* .glb: Gaussians in glTF, by the extension KHR_gaussian_splatting. formats/splats/glb.md. */
#pragma once

#include "base/err.h"
#include "base/file.h"
#include "splat/gaussian_rows.h"
#include "splat/splats.h"

#include <cjson/cJSON.h>
#include <stdint.h>

#define GLB_EXTENSION "KHR_gaussian_splatting"

enum { GLB_MAGIC = 0x46546c67, GLB_JSON = 0x4e4f534a, GLB_BIN = 0x004e4942, GLB_HEADER = 12, GLB_CHUNK = 8 };

/* glTF's numbers for types of components. */
enum glb_component { GLB_I8 = 5120, GLB_U8, GLB_I16, GLB_U16, GLB_F32 = 5126 };

/* A file in memory, taken apart. */
struct glb {
	const char *name; /* as messages name it; it must outlive f */
	const struct file_map *map;
	cJSON *root;
	const unsigned char *bin; /* the binary chunk, in the map */
	size_t bin_length;
};

/* Reads the header, the chunks and the JSON. Returns 0, or -1 with *e set and nothing to release. */
int glb_open(struct glb *f, const char *name, const struct file_map *map, struct err *e);
void glb_close(struct glb *f);

/* Numbers of an accessor, `width` for each of n items. */
struct glb_values {
	const unsigned char *data; /* NULL: the primitive does not have this attribute */
	size_t n, stride;
	int width, component, is_normalized;
};

/* The attribute of a primitive by its name: 0 with v->data NULL where it has none. `components` says which
 * types it may have: bits by glb_component - GLB_I8. */
int glb_attribute(const struct glb *f, const cJSON *primitive, const char *name, int width,
	unsigned components, struct glb_values *v, struct err *e);
double glb_value(const struct glb_values *v, size_t i, int k);

/* Where a mesh is: its node's place and those of the nodes above. x becomes scale * rotation x + shift. The
 * identity where no node has it. ERR_FORMAT where several have, or a node does more than that. */
struct glb_place {
	double scale, rotation[3][3], shift[3];
};
int glb_find_place(struct glb_place *place, const struct glb *f, int mesh, struct err *e);

/* Whether a file begins as one. */
int glb_is(const struct file_map *map);

/* An anysplats_reader. */
int glb_read_map(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, struct err *e);

/* Writes numbers as floats; where offset is not 0 it is the shift of the node. "-" is stdout. Returns 0, or
 * -1 with *e set. */
int glb_write(const struct splats *s, const double offset[3], const char *path, struct err *e);
