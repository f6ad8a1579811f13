#include "formats/splats/spz.h"

#include "base/little.h"
#include "base/mem.h"

#include <math.h>
#include <zlib.h>
#include <zstd.h>

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

/* The highest two bits say which of x y z w is the largest; the others have a sign and 9 bits each. */
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
	SCOPED_BY(spz_close) struct spz f = {0};

	if (spz_open(&f, name, map, e))
		return -1;
	const int rest = 3 * ((f.degree + 1) * (f.degree + 1) - 1);
	const struct gaussian_rows rows = {f.name, f.n, rest, next_row, &f, NULL};
	return gaussian_rows_read(s, offset, report, &rows, e);
}

/* Coordinates get as many fraction bits as leave room for the farthest mean; more than these say nothing, but
 * in scenes of a unit so large that most Gaussians are smaller than so many steps. Harmonics are rounded to 5
 * bits of degree 1 and 4 of the others, as the format's own library does: noise does not compress. */
enum {
	FRACTION_USUAL = 16,
	FRACTION_MOST = 24,
	STEPS = 32,
	STEP_DEGREE_1 = 8,
	STEP_REST = 16,
	ZSTD_LEVEL = 12
};

static unsigned char to_byte(double x)
{
	return (unsigned char)lrint(fmin(fmax(x, 0), 255));
}

int spz_fraction(const struct splats *s, const double offset[3])
{
	double farthest = 0;
	int bits = FRACTION_USUAL;

	for (size_t large = 0; bits < FRACTION_MOST; bits++, large = 0) {
		for (size_t i = 0; i < s->n; i++) {
			const float *scale = s->scales + 3 * i;
			large += ldexp((double)fmaxf(fmaxf(scale[0], scale[1]), scale[2]), bits) >= STEPS;
		}
		if (2 * large >= s->n)
			break;
	}
	for (size_t i = 0; i < 3 * s->n; i++)
		farthest = fmax(farthest, fabs((double)s->means[i] + offset[i % 3]));
	while (bits >= 0 && ldexp(farthest, bits) >= (1 << 23) - 1)
		bits--;
	return bits;
}

static void pack_first_three(unsigned char *p, const double xyzw[4])
{
	for (int k = 0; k < 3; k++)
		p[k] = to_byte((xyzw[3] < 0 ? -127.5 : 127.5) * xyzw[k] + 127.5);
}

static void pack_smallest_three(unsigned char *p, const double xyzw[4])
{
	int largest = 0;

	for (int k = 1; k < 4; k++)
		if (fabs(xyzw[k]) > fabs(xyzw[largest]))
			largest = k;
	uint32_t word = (uint32_t)largest;
	for (int k = 0; k < 4; k++) {
		if (k == largest)
			continue;
		const uint32_t sign = (xyzw[k] < 0) != (xyzw[largest] < 0);
		word = word << 10 | sign << 9 |
		       (uint32_t)fmin(511, floor(511 * fabs(xyzw[k]) / sqrt(0.5) + 0.5));
	}
	little_put(p, word, 4);
}

/* In the file y is up and z is back; here they are down and front. */
static void pack_quat(unsigned char *p, const double *wxyz, int version)
{
	const double length =
		sqrt(wxyz[0] * wxyz[0] + wxyz[1] * wxyz[1] + wxyz[2] * wxyz[2] + wxyz[3] * wxyz[3]);
	const double xyzw[4] = {wxyz[1] / length, -wxyz[2] / length, -wxyz[3] / length, wxyz[0] / length};

	if (version == 2)
		pack_first_three(p, xyzw);
	else
		pack_smallest_three(p, xyzw);
}

static void pack_sh(unsigned char *p, const double *rest, int per_channel)
{
	for (int k = 0; k < per_channel; k++)
		for (int c = 0; c < 3; c++) {
			const double v =
				gaussian_flip_sign(k + 1, FLIP_Y | FLIP_Z) * rest[c * per_channel + k];
			const int step = k < 3 ? STEP_DEGREE_1 : STEP_REST;
			p[3 * k + c] = to_byte(128 + step * rint(v * 128 / step));
		}
}

static void pack_row(const struct spz *f, size_t row, const double *values)
{
	unsigned char *p[SPZ_PARTS];

	for (int i = 0; i < SPZ_PARTS; i++)
		p[i] = f->bytes + (f->part[i] - f->bytes) + row * spz_width(f, (enum spz_part)i);
	for (int k = 0; k < 3; k++) {
		const double mean = k ? -values[ROW_MEAN + k] : values[ROW_MEAN + k];
		little_put(p[SPZ_MEANS] + 3 * k, (uint64_t)llrint(ldexp(mean, f->fraction_bits)), 3);
		p[SPZ_SCALES][k] = to_byte((values[ROW_SCALE + k] + 10) * 16);
		p[SPZ_COLORS][k] = to_byte((values[ROW_DC + k] * 0.15 + 0.5) * 255);
	}
	*p[SPZ_OPACITIES] = to_byte(255 / (1 + exp(-values[ROW_OPACITY])));
	pack_quat(p[SPZ_QUATS], values + ROW_ROT, f->version);
	pack_sh(p[SPZ_SH], values + ROW_REST, (f->degree + 1) * (f->degree + 1) - 1);
}

/* The arrays, after `room` bytes for the header. */
static int pack(struct spz *f, const struct splats *s, const double offset[3], size_t room, size_t *len,
	struct err *e)
{
	double values[ROW_MAX];
	size_t total;

	if (mem_size(s->n, spz_row(f), &total))
		return err_set(e, ERR_SYSTEM, "%s: %zu Gaussians do not fit in memory", f->name, s->n);
	f->bytes = mem_alloc(room + total, 1, f->name, e);
	if (!f->bytes)
		return -1;
	spz_place(f, f->bytes + room);
	for (size_t i = 0; i < s->n; i++) {
		gaussian_row_of(s, i, values);
		for (int k = 0; k < 3; k++)
			values[ROW_MEAN + k] += offset[k];
		pack_row(f, i, values);
	}
	*len = room + total;
	return 0;
}

/* What both headers begin with. */
static void put_header(unsigned char *h, const struct spz *f)
{
	little_put(h, SPZ_MAGIC, 4);
	little_put(h + 4, (uint64_t)f->version, 4);
	little_put(h + 8, f->n, 4);
	h[12] = (unsigned char)f->degree;
	h[13] = (unsigned char)f->fraction_bits;
	h[14] = h[15] = 0;
}

static int write_gzip(struct spz *f, size_t len, FILE *out, struct err *e)
{
	z_stream z = {.next_in = f->bytes};
	unsigned char block[65536];
	int status = Z_OK;

	put_header(f->bytes, f);
	if (len > (uInt)-1)
		return err_file(
			e, f->name, "%zu Gaussians are too many for version %d of .spz", f->n, f->version);
	z.avail_in = (uInt)len;
	if (deflateInit2(&z, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 9, Z_DEFAULT_STRATEGY) !=
		Z_OK)
		return err_set(e, ERR_SYSTEM, "%s: out of memory", f->name);
	while (status == Z_OK) {
		z.next_out = block;
		z.avail_out = sizeof block;
		status = deflate(&z, Z_FINISH);
		fwrite(block, 1, sizeof block - z.avail_out, out);
	}
	deflateEnd(&z);
	return status == Z_STREAM_END ? 0 : err_set(e, ERR_SYSTEM, "%s: cannot be packed", f->name);
}

/* The streams into `to`, their sizes into the table; their end, or NULL with *e. */
static unsigned char *pack_streams(
	const struct spz *f, unsigned char *table, unsigned char *to, const unsigned char *end, struct err *e)
{
	for (int i = 0; i < SPZ_PARTS; i++) {
		const size_t bytes = f->n * spz_width(f, (enum spz_part)i);
		if (!bytes)
			continue;
		const size_t packed = ZSTD_compress(to, (size_t)(end - to), f->part[i], bytes, ZSTD_LEVEL);
		if (ZSTD_isError(packed)) {
			err_set(e, ERR_SYSTEM, "%s: %s", f->name, ZSTD_getErrorName(packed));
			return NULL;
		}
		table = little_put(little_put(table, packed, 8), bytes, 8);
		to += packed;
	}
	return to;
}

static int write_plain(struct spz *f, FILE *out, struct err *e)
{
	size_t most = 32 + 16 * SPZ_PARTS, streams = 0;

	for (int i = 0; i < SPZ_PARTS; i++) {
		const size_t bytes = f->n * spz_width(f, (enum spz_part)i);
		most += ZSTD_compressBound(bytes);
		streams += bytes != 0;
	}
	SCOPED unsigned char *all = mem_zalloc(most, 1, f->name, e);
	if (!all)
		return -1;
	put_header(all, f);
	all[15] = (unsigned char)streams;
	little_put(all + 16, 32, 4);
	const unsigned char *end = pack_streams(f, all + 32, all + 32 + 16 * streams, all + most, e);
	if (end)
		fwrite(all, 1, (size_t)(end - all), out);
	return end ? 0 : -1;
}

int spz_write(const struct splats *s, const double offset[3], int version, const char *path, struct err *e)
{
	SCOPED_BY(spz_close) struct spz f = {.name = file_name(path), .version = version, .n = s->n};
	const size_t room = version < 4 ? 16 : 0;
	struct file_out out;
	size_t len = 0;

	while ((f.degree + 1) * (f.degree + 1) < s->sh_coefficients)
		f.degree++;
	f.fraction_bits = spz_fraction(s, offset);
	if (f.fraction_bits < 0 || s->n > UINT32_MAX)
		return err_file(e, f.name,
			"means beyond 8388606, or more than 4294967295 Gaussians, do not fit an .spz");
	int bad = pack(&f, s, offset, room, &len, e) || file_out_open(&out, path, e);
	if (!bad) {
		bad = version < 4 ? write_gzip(&f, len, out.stream, e) : write_plain(&f, out.stream, e);
		bad = file_out_end(&out, bad, e);
	}
	return bad ? -1 : 0;
}
