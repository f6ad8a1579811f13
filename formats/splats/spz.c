#include "formats/splats/spz.h"

#include "base/little.h"

#include <math.h>

/* x, y, z of the quaternion in a byte each; w, which is not negative, is what makes the length 1. */
static void unpack_first_three(const unsigned char *p, double xyzw[4])
{
	double rest = 1;

	for (int k = 0; k < 3; k++) {
		xyzw[k] = p[k] / 127.5 - 1;
		rest -= xyzw[k] * xyzw[k];
	}
	xyzw[3] = sqrt(fmax(0, rest));
}

/* The highest two bits say which of x y z w is the largest; the others, in order, have a sign and 9 bits
 * each. */
static void unpack_smallest_three(const unsigned char *p, double xyzw[4])
{
	const uint32_t word = (uint32_t)little_get(p, 4);
	const int largest = (int)(word >> 30);
	double rest = 1;
	int shift = 20;

	for (int k = 0; k < 4; k++) {
		if (k == largest)
			continue;
		const uint32_t field = word >> shift & 0x3ff;
		xyzw[k] = (field & 0x1ff) / 511.0 * sqrt(0.5) * (field & 0x200 ? -1 : 1);
		rest -= xyzw[k] * xyzw[k];
		shift -= 10;
	}
	xyzw[largest] = sqrt(fmax(0, rest));
}

static void unpack_quat(const struct spz *f, size_t row, double *wxyz)
{
	static const int others[3] = {FLIP_Y | FLIP_Z, FLIP_X | FLIP_Z, FLIP_X | FLIP_Y};
	const unsigned char *p = f->part[SPZ_QUATS] + row * spz_width(f, SPZ_QUATS);
	double xyzw[4];

	if (f->version == 2)
		unpack_first_three(p, xyzw);
	else
		unpack_smallest_three(p, xyzw);
	wxyz[0] = xyzw[3];
	/* A turn about x goes the other way where one of y and z is turned round, and so on. */
	for (int k = 0; k < 3; k++) {
		const int turned = f->axes & others[k];
		wxyz[1 + k] = turned && turned != others[k] ? -xyzw[k] : xyzw[k];
	}
}

static void unpack_sh(const struct spz *f, size_t row, double *rest)
{
	const int per_channel = (f->degree + 1) * (f->degree + 1) - 1;
	const unsigned char *p = f->part[SPZ_SH] + row * spz_width(f, SPZ_SH);

	for (int k = 0; k < per_channel; k++)
		for (int c = 0; c < 3; c++)
			rest[c * per_channel + k] =
				gaussian_flip_sign(k + 1, f->axes) * (p[3 * k + c] - 128) / 128.0;
}

static int next_row(void *reader, size_t row, double *values, struct err *e)
{
	const struct spz *f = reader;

	(void)e;
	for (size_t k = 0; k < 3; k++) {
		/* Two's complement of 24 bits. */
		const long bits = (long)little_get(f->part[SPZ_MEANS] + 9 * row + 3 * k, 3);
		const double mean =
			ldexp((double)(bits & 0x800000 ? bits - 0x1000000 : bits), -f->fraction_bits);
		values[ROW_MEAN + k] = f->axes >> k & 1 ? -mean : mean;
		values[ROW_SCALE + k] = f->part[SPZ_SCALES][3 * row + k] / 16.0 - 10;
		values[ROW_DC + k] = (f->part[SPZ_COLORS][3 * row + k] / 255.0 - 0.5) / 0.15;
	}
	values[ROW_OPACITY] = gaussian_logit(f->part[SPZ_OPACITIES][row] / 255.0);
	unpack_quat(f, row, values + ROW_ROT);
	unpack_sh(f, row, values + ROW_REST);
	return 0;
}

int spz_read_map(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, struct err *e)
{
	struct spz f;

	*s = (struct splats){0};
	if (report)
		*report = (struct rows_report){0};
	int bad = spz_open(&f, name, map, e);
	file_unmap(map);
	if (bad)
		return -1;
	const int rest = 3 * ((f.degree + 1) * (f.degree + 1) - 1);
	const struct gaussian_rows rows = {f.name, f.n, rest, next_row, &f};
	bad = gaussian_rows_read(s, offset, report, &rows, e);
	spz_close(&f);
	return bad;
}
