#include "formats/splats/anysplats.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"
#include "base/quantile.h"
#include "formats/records/foreign.h"
#include "formats/splats/glb.h"
#include "formats/splats/ply.h"
#include "formats/splats/sog.h"
#include "formats/splats/splat.h"
#include "formats/splats/spz.h"

#include <math.h>
#include <stdio.h>

int anysplats_is_meta(const char *path)
{
	int length;

	return !strcmp(path_last(path, &length), "meta.json");
}

/* In the order of enum anysplats_format. A .splat begins as anything, and .spz is written in versions. */
static const struct {
	const char *tail;
	int (*begins)(const struct file_map *map);
	anysplats_reader *read;
	int (*write)(const struct splats *s, const double offset[3], const char *path, struct err *e);
} formats[ANYSPLATS_FORMATS] = {{".ply", NULL, NULL, ply_write},
	{".splat", NULL, splat_read_map, splat_write}, {".spz", spz_is, spz_read_map, NULL},
	{".glb", glb_is, glb_read_map, glb_write}, {".sog", sog_is, sog_read_map, sog_write}};

static int read_any(struct splats *s, double offset[3], struct rows_report *report, const char *path,
	const struct ply_like *like, struct err *e)
{
	const char *name = file_name(path);
	SCOPED_BY(file_unmap) struct file_map map = {0};

	if (anysplats_is_meta(path))
		return sog_read_meta(s, offset, report, path, e);
	if (file_map(path, &map, e))
		return -1;
	if (map.len >= 4 && (!memcmp(map.data, "ply\n", 4) || !memcmp(map.data, "ply\r", 4)))
		return ply_read_like(s, offset, report, name, &map, like, e);
	if (!spz_is(&map) && !glb_is(&map) && foreign_file(name, FOREIGN_SPLATS, map.data, map.len, e))
		return -1;
	for (int i = ANYSPLATS_FORMATS - 1; i > ANYSPLATS_PLY; i--)
		if ((formats[i].begins && formats[i].begins(&map)) || path_ends(name, formats[i].tail))
			return formats[i].read(s, offset, report, name, &map, e);
	return ply_read_like(s, offset, report, name, &map, like, e);
}

int anysplats_read_like(struct splats *s, double offset[3], struct rows_report *report, const char *path,
	const struct ply_like *like, struct err *e)
{
	struct rows_report local = {0};

	*s = (struct splats){0};
	const int bad = read_any(s, offset, &local, path, like, e);
	if (bad)
		splats_free(s);
	if (bad || !report)
		free(local.dropped);
	if (report)
		*report = bad ? (struct rows_report){0} : local;
	return bad ? -1 : 0;
}

int anysplats_read(
	struct splats *s, double offset[3], struct rows_report *report, const char *path, struct err *e)
{
	return anysplats_read_like(s, offset, report, path, NULL, e);
}

int anysplats_format_of(const char *path)
{
	for (int i = 0; i < ANYSPLATS_FORMATS; i++)
		if (path_ends(path, formats[i].tail))
			return i;
	return -1;
}

int anysplats_write(const struct splats *s, const double offset[3], enum anysplats_format format,
	int spz_version, const char *path, struct err *e)
{
	return format == ANYSPLATS_SPZ ? spz_write(s, offset, spz_version, path, e)
				       : formats[format].write(s, offset, path, e);
}

/* What a format of splats does not keep. A place is rounded to a step: of .splat single precision, of .spz a
 * fixed point, of SOG a 65535th of the range of its logarithm. .spz has steps of standard deviations. */

/* A step that is more of the largest standard deviation of half of the Gaussians, or so many that become
 * larger or smaller, shows in pictures. */
static const double STEP_MOST = 0.5, RESIZED_MOST = 0.01;
static const double SPZ_SMALLEST = 4.5e-5, SPZ_LARGEST = 380; /* exp(-10), exp(255 / 16 - 10) */

/* sog: SOG's step where the logarithm does not change it. */
static double step_at(enum anysplats_format format, double spz, double sog, double x)
{
	const float at = (float)fabs(x);

	return format == ANYSPLATS_SPZ	   ? spz
	       : format == ANYSPLATS_SOG   ? sog * (1 + fabs(x))
	       : format == ANYSPLATS_SPLAT ? (double)nextafterf(at, INFINITY) - (double)at
					   : 0;
}

static int tell(char text[ANYSPLATS_LOSS], double step, double size, size_t resized, size_t n)
{
	if ((double)resized > RESIZED_MOST * (double)n)
		return snprintf(text, ANYSPLATS_LOSS,
			"%zu of %zu Gaussians are not within %g to %g, all that .spz has, and become larger or smaller: give the scene another unit with --scale, or write a .ply",
			resized, n, SPZ_SMALLEST, SPZ_LARGEST);
	return snprintf(text, ANYSPLATS_LOSS,
		"places are rounded to steps of %.2g, and half of the Gaussians are smaller than %.2g, so that they show off their places: move the scene to the origin or give it another unit (--translate, --scale), or write a .ply",
		step, size);
}

int anysplats_loss(const struct splats *s, const double offset[3], enum anysplats_format format,
	char text[ANYSPLATS_LOSS], struct err *e)
{
	SCOPED struct quantile_item *shares = mem_alloc(s->n, sizeof *shares, "splats", e),
				    *sizes = mem_alloc(s->n, sizeof *sizes, "splats", e);
	double spz = 0, low[3], high[3], sog[3] = {0};
	size_t resized = 0;
	int found = shares && sizes ? 0 : -1;

	if (!found && s->n) {
		spz = ldexp(1, -spz_fraction(s, offset));
		sog_bounds(low, high, s, offset);
		for (int k = 0; k < 3; k++)
			sog[k] = (high[k] - low[k]) / 65535;
	}
	for (size_t i = 0; i < s->n && !found; i++) {
		const float *scale = s->scales + 3 * i;
		const double size = (double)fmaxf(fmaxf(scale[0], scale[1]), scale[2]);
		double step = 0;
		for (size_t k = 0; k < 3; k++)
			step = fmax(
				step, step_at(format, spz, sog[k], (double)s->means[3 * i + k] + offset[k]));
		shares[i] = (struct quantile_item){step / fmax(size, 1e-300), 1};
		sizes[i] = (struct quantile_item){size, 1};
		resized += format == ANYSPLATS_SPZ && (size < SPZ_SMALLEST || size > SPZ_LARGEST);
	}
	if (!found && s->n) {
		const double share = quantile_weighted(shares, s->n, 0.5),
			     size = quantile_weighted(sizes, s->n, 0.5);
		found = share > STEP_MOST || (double)resized > RESIZED_MOST * (double)s->n;
		if (found)
			tell(text, share * size, size, resized, s->n);
	}
	return found;
}
