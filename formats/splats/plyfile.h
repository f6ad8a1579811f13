/* The PLY container: a text header that names elements and their properties, then their rows. What the rows
 * mean is formats/splats/ply.h's business. formats/splats/ply.md has the grammar. */
#pragma once

#include "base/err.h"
#include "base/file.h"

enum plyfile_type { PLY_I8, PLY_U8, PLY_I16, PLY_U16, PLY_I32, PLY_U32, PLY_F32, PLY_F64, PLY_TYPES };
enum plyfile_encoding { PLY_ASCII, PLY_LITTLE, PLY_BIG };

/* Bytes of a value in a binary file. */
size_t plyfile_type_size(enum plyfile_type type);

struct plyfile_property {
	const char *name;
	int line; /* of the header */
	enum plyfile_type type;
	int is_list; /* then each value is a count of type `count_type`, and that many items of `type` */
	enum plyfile_type count_type;
};

struct plyfile_element {
	const char *name;
	int line; /* of the header */
	size_t rows;
	size_t n, capacity; /* properties */
	struct plyfile_property *properties;
	int has_list;
	size_t min_bytes; /* of one row: its size where it has no list */
};

struct plyfile {
	const char *path; /* as messages name it */
	enum plyfile_encoding encoding;
	size_t n, capacity; /* elements, in the file's order */
	struct plyfile_element *elements;
	const char *mode; /* the comment that it is to be rendered in another way: SplatRenderMode: mip */
	char *header;	  /* the names point into it */
	struct file_map map;
	size_t at; /* offset of the next row */
};

/* Reads the header of a file that is in memory, which is f's from then on. `name`, which must outlive f, is
 * what messages say. Returns 0, or -1 with *e ("name:LINE: reason"); plyfile_close after either. */
int plyfile_open(struct plyfile *f, const char *name, struct file_map *map, struct err *e);
void plyfile_close(struct plyfile *f);

/* The element / property of that name, or NULL / -1. */
const struct plyfile_element *plyfile_find(const struct plyfile *f, const char *element);
long plyfile_property(const struct plyfile_element *el, const char *name);

/* As plyfile_property, with -1 and *e where the element has none of that name or it is a list. */
long plyfile_need(const struct plyfile *f, const struct plyfile_element *el, const char *name, struct err *e);

/* Whether all rows of el, which begin at f->at, can be in the file: for use before anything is allocated. */
int plyfile_check_rows(const struct plyfile *f, const struct plyfile_element *el, struct err *e);

/* Reads row `row` (for messages) of el: values (el->n); a list gives its count, its items are passed over.
 * Values of every type are exact in a double. */
int plyfile_row(
	struct plyfile *f, const struct plyfile_element *el, size_t row, double *values, struct err *e);

/* The value at an offset of a binary file. */
double plyfile_value(const struct plyfile *f, size_t at, enum plyfile_type type);

/* Passes over all rows of el. */
int plyfile_skip(struct plyfile *f, const struct plyfile_element *el, struct err *e);

/* After the last element: anything but white space (in ascii) is an error. */
int plyfile_end(const struct plyfile *f, struct err *e);
