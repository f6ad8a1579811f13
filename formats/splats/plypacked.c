#include "formats/splats/plypacked.h"

#include "base/mem.h"
#include "splat/sh.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>

enum { CHUNK_ROWS = 256 };

/* Where bounds has the least values of each kind; the greatest ones are 3 further on. */
enum { BOUNDS_POSITION = 0, BOUNDS_SCALE = 6, BOUNDS_COLOR = 12 };

static const char *const bound_names[PLYPACKED_BOUNDS] = {"min_x", "min_y", "min_z", "max_x", "max_y",
	"max_z", "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
	"min_r", "min_g", "min_b", "max_r", "max_g", "max_b"};

int plypacked_is(const struct plyfile *f)
{
	const struct plyfile_element *vertex = plyfile_find(f, "vertex");

	return vertex && plyfile_property(vertex, "packed_position") >= 0;
}

static int find_packed(
	struct plypacked *p, const struct plyfile *f, const struct plyfile_element *vertex, struct err *e)
{
	static const char *const names[] = {
		"packed_position", "packed_rotation", "packed_scale", "packed_color"};

	for (int i = 0; i < 4; i++) {
		p->slot[i] = plyfile_need(f, vertex, names[i], e);
		if (p->slot[i] < 0)
			return -1;
		if (vertex->properties[p->slot[i]].type != PLY_U32)
			return err_file(e, f->path, "property '%s' is not uint", names[i]);
	}
	return 0;
}

static int read_chunks(struct plypacked *p, const struct plyfile *f, const struct plyfile_element *vertex,
	size_t at, struct err *e)
{
	const struct plyfile_element *chunk = plyfile_find(f, "chunk");
	struct plyfile rows = *f;
	long slot[PLYPACKED_BOUNDS];
	int has_color, bad = 0;

	if (!chunk || chunk > vertex)
		return err_file(e, f->path, "no element 'chunk' before element 'vertex'");
	has_color = plyfile_property(chunk, bound_names[BOUNDS_COLOR]) >= 0;
	for (int i = 0; i < (has_color ? PLYPACKED_BOUNDS : BOUNDS_COLOR); i++) {
		slot[i] = plyfile_need(f, chunk, bound_names[i], e);
		if (slot[i] < 0)
			return -1;
	}
	p->chunks = chunk->rows;
	if (p->chunks < vertex->rows / CHUNK_ROWS + (vertex->rows % CHUNK_ROWS != 0))
		return err_file(e, f->path, "%zu chunks of %d for %zu Gaussians", p->chunks, CHUNK_ROWS,
			vertex->rows);
	rows.at = at;
	p->bounds = mem_alloc(p->chunks, PLYPACKED_BOUNDS * sizeof *p->bounds, "chunks", e);
	SCOPED double *row = mem_alloc(chunk->n, sizeof *row, "chunks", e);
	if (!p->bounds || !row)
		bad = -1;
	for (size_t i = 0; !bad && i < p->chunks; i++) {
		double *to = p->bounds + PLYPACKED_BOUNDS * i;
		bad = plyfile_row(&rows, chunk, i, row, e);
		for (int k = 0; !bad && k < PLYPACKED_BOUNDS; k++) {
			/* Colours without bounds are in [0,1]. */
			int is_given = has_color || k < BOUNDS_COLOR;
			to[k] = is_given ? row[slot[k]] : (double)(k >= BOUNDS_COLOR + 3);
		}
	}
	return bad;
}

static int find_sh(
	struct plypacked *p, const struct plyfile *f, const struct plyfile_element *vertex, struct err *e)
{
	char name[32];

	p->sh = plyfile_find(f, "sh");
	if (!p->sh)
		return 0;
	if (p->sh != vertex + 1)
		return err_file(e, f->path, "element 'sh' does not follow element 'vertex'");
	if (p->sh->rows != vertex->rows)
		return err_file(
			e, f->path, "element 'sh' has %zu rows for %zu Gaussians", p->sh->rows, vertex->rows);
	if (p->sh->n != 9 && p->sh->n != 24 && p->sh->n != 45)
		return err_file(
			e, f->path, "element 'sh' has %zu properties, expected 9, 24 or 45", p->sh->n);
	for (size_t i = 0; i < p->sh->n; i++) {
		const struct plyfile_property *one = &p->sh->properties[i];
		snprintf(name, sizeof name, "f_rest_%zu", i);
		if (strcmp(one->name, name) != 0 || one->is_list || one->type != PLY_U8)
			return err_file(e, f->path, "element 'sh': property %zu is not uchar %s", i, name);
	}
	p->rest = (int)p->sh->n;
	p->sh_rows = *f;
	p->sh_rows.at = f->at + vertex->rows * vertex->min_bytes;
	return plyfile_check_rows(&p->sh_rows, p->sh, e);
}

int plypacked_open(struct plypacked *p, const struct plyfile *f, const struct plyfile_element *vertex,
	size_t chunks, struct err *e)
{
	*p = (struct plypacked){0};
	if (f->encoding == PLY_ASCII || vertex->has_list)
		return err_file(e, f->path, "packed Gaussians in ascii or with lists");
	if (find_packed(p, f, vertex, e) || plyfile_check_rows(f, vertex, e) ||
		read_chunks(p, f, vertex, chunks, e) || find_sh(p, f, vertex, e))
		return -1;
	p->row = mem_alloc(vertex->n, sizeof *p->row, f->path, e);
	p->sh_row = mem_alloc((size_t)p->rest, sizeof *p->sh_row, f->path, e);
	return p->row && p->sh_row ? 0 : -1;
}

void plypacked_close(struct plypacked *p)
{
	mem_free_all(p->bounds, p->row, p->sh_row);
	*p = (struct plypacked){0};
}

/* `bits` bits of v from bit `shift` on, as a number in [0,1]. */
static double fraction(uint32_t v, int shift, int bits)
{
	uint32_t most = (1u << bits) - 1;

	return (double)(v >> shift & most) / most;
}

static double between(const double *bounds, double t)
{
	return bounds[0] * (1 - t) + bounds[3] * t;
}

/* 11, 10 and 11 bits. */
static void unpack_vector(uint32_t v, const double *bounds, double *out)
{
	out[0] = between(bounds, fraction(v, 21, 11));
	out[1] = between(bounds + 1, fraction(v, 11, 10));
	out[2] = between(bounds + 2, fraction(v, 0, 11));
}

/* Two bits say which of w x y z is the largest; the others, in order, are in 10 bits each, from -1/sqrt 2 on.
 */
static void unpack_rotation(uint32_t v, double *out)
{
	double rest = 1;
	int largest = (int)(v >> 30), shift = 20;

	for (int k = 0; k < 4; k++) {
		if (k == largest)
			continue;
		out[k] = (fraction(v, shift, 10) - 0.5) * sqrt(2);
		rest -= out[k] * out[k];
		shift -= 10;
	}
	out[largest] = sqrt(fmax(0, rest));
}

int plypacked_row(struct plypacked *p, struct plyfile *f, const struct plyfile_element *vertex, size_t row,
	double *values, struct err *e)
{
	const double *bounds = p->bounds + PLYPACKED_BOUNDS * (row / CHUNK_ROWS);
	uint32_t word[4];

	if (plyfile_row(f, vertex, row, p->row, e) ||
		(p->rest && plyfile_row(&p->sh_rows, p->sh, row, p->sh_row, e)))
		return -1;
	for (int i = 0; i < 4; i++)
		word[i] = (uint32_t)p->row[p->slot[i]];
	unpack_vector(word[0], bounds + BOUNDS_POSITION, values);
	for (int c = 0; c < 3; c++)
		values[3 + c] =
			(between(bounds + BOUNDS_COLOR + c, fraction(word[3], 24 - 8 * c, 8)) - 0.5) / SH_C0;
	values[6] = fraction(word[3], 0, 8);
	unpack_vector(word[2], bounds + BOUNDS_SCALE, values + 7);
	unpack_rotation(word[1], values + 10);
	for (int i = 0; i < p->rest; i++)
		values[PLYPACKED_VALUES + i] = p->sh_row[i] * 8 / 255 - 4;
	return 0;
}
