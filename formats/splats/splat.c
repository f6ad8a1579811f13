#include "formats/splats/splat.h"

#include "base/compare.h"
#include "base/little.h"
#include "base/mem.h"
#include "splat/sh.h"

#include <ctype.h>
#include <math.h>

static unsigned char to_byte(double x)
{
	return (unsigned char)lrint(fmin(fmax(x, 0), 255));
}

static int next_row(void *reader, size_t row, double *values, struct err *e)
{
	const struct file_map *map = reader;
	const unsigned char *p = map->data + SPLAT_BYTES * row;

	(void)e;
	for (int k = 0; k < 3; k++) {
		values[ROW_MEAN + k] = little_get_f32(p + 4 * k);
		values[ROW_SCALE + k] = log((double)little_get_f32(p + 12 + 4 * k));
		values[ROW_DC + k] = (p[24 + k] / 255.0 - 0.5) / SH_C0;
	}
	values[ROW_OPACITY] = gaussian_logit(p[27] / 255.0);
	for (int k = 0; k < 4; k++)
		values[ROW_ROT + k] = (p[28 + k] - 128) / 128.0;
	return 0;
}

int splat_read_map(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, struct err *e)
{
	const struct gaussian_rows rows = {name, map->len / SPLAT_BYTES, 0, next_row, map, NULL};
	size_t text = 0;

	while (text < map->len && text < SPLAT_BYTES &&
		(isprint(map->data[text]) || isspace(map->data[text])))
		text++;
	if (map->len % SPLAT_BYTES)
		return err_file(e, name, "%zu bytes are not a whole number of Gaussians of %d", map->len,
			SPLAT_BYTES);
	if (gaussian_rows_read(s, offset, report, &rows, e))
		return -1;
	return text < SPLAT_BYTES && 2 * report->not_finite <= report->read
		       ? 0
		       : err_file(e, name, "not a .splat: %zu of %zu Gaussians are not finite%s",
				 report->not_finite, report->read,
				 text == SPLAT_BYTES ? ", and it begins as text" : "");
}

void splat_pack(unsigned char bytes[SPLAT_BYTES], const struct splats *s, size_t i)
{
	unsigned char *p = bytes;
	const float *sh = s->sh + 3 * (size_t)s->sh_coefficients * i, *q = s->quats + 4 * i;
	const double w = q[0], x = q[1], y = q[2], z = q[3], length = sqrt(w * w + x * x + y * y + z * z);

	for (size_t k = 0; k < 3; k++)
		p = little_put_f32(p, s->means[3 * i + k]);
	for (size_t k = 0; k < 3; k++)
		p = little_put_f32(p, s->scales[3 * i + k]);
	for (int c = 0; c < 3; c++)
		*p++ = to_byte(255 * (0.5 + SH_C0 * (double)sh[c]));
	*p++ = to_byte(255 * (double)s->opacities[i]);
	for (int k = 0; k < 4; k++)
		*p++ = to_byte(128 + 128 * (double)q[k] / length);
}

int splat_write(const struct splats *s, const double offset[3], const char *path, struct err *e)
{
	SCOPED struct ranked *places = mem_alloc(s->n, sizeof *places, "splats", e);
	struct file_out out;

	if (!places)
		return -1;
	for (size_t i = 0; i < s->n; i++) { /* by volume times opacity */
		const float *scale = s->scales + 3 * i;
		places[i] =
			(struct ranked){(double)scale[0] * scale[1] * scale[2] * (double)s->opacities[i], i};
	}
	qsort(places, s->n, sizeof *places, ranked_falling);
	int bad = file_out_open(&out, path, e);
	for (size_t i = 0; i < s->n && !bad; i++) {
		unsigned char record[SPLAT_BYTES];
		splat_pack(record, s, places[i].at);
		for (size_t k = 0; k < 3; k++)
			little_put_f32(record + 4 * k, (double)s->means[3 * places[i].at + k] + offset[k]);
		fwrite(record, 1, sizeof record, out.stream);
	}
	return bad ? -1 : file_out_commit(&out, e);
}
