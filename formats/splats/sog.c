#include "formats/splats/sog.h"

#include "base/mem.h"
#include "formats/arrays/archive.h"
#include "formats/images/webp.h"
#include "formats/records/json.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>

enum { MEANS_LOW, MEANS_HIGH, QUATS, SCALES, COLORS, CENTROIDS, LABELS, IMAGES };
enum { CODES = 256, PALETTE_ROW = 64, PALETTE_MOST = 65536 };

/* No scene packs so well: lossless WebP takes at least a byte of the means for so many Gaussians. Images
 * may have some pixels more than Gaussians. */
enum { GAUSSIANS_A_BYTE = 1024, SPARE_PIXELS = 4096 };

struct codebook {
	int n;
	double values[CODES];
};

struct sog {
	struct archive files;
	const char *name; /* of what messages are about */
	size_t n;
	double low[3], high[3]; /* of the means, logarithms */
	struct codebook scales, colors, sh;
	size_t palette;
	int per_channel; /* harmonics from degree 1 on */
	struct webp images[IMAGES];
};

int sog_is(const struct file_map *map)
{
	return map->len >= 4 && !memcmp(map->data, "PK\3\4", 4);
}

/* Where the values of a file's key are, for messages. */
static const char *where(const struct sog *f, const char *part, char text[static 320])
{
	snprintf(text, 320, "%.200s: meta.json: '%s'", f->name, part);
	return text;
}

static int read_codebook(
	const struct sog *f, const cJSON *part, const char *key, struct codebook *c, struct err *e)
{
	const cJSON *list = json_get(part, "codebook"), *item;
	char at[320];

	c->n = cJSON_GetArraySize(list);
	if (c->n < 1 || c->n > CODES)
		return err_file(
			e, where(f, key, at), "key 'codebook' is not a list of 1 to %d numbers", CODES);
	int i = 0;
	cJSON_ArrayForEach(item, list)
	{
		if (!cJSON_IsNumber(item) || !isfinite(item->valuedouble))
			return err_file(e, where(f, key, at), "codebook[%d] is not a number", i);
		c->values[i++] = item->valuedouble;
	}
	return 0;
}

/* The i-th image of a part, with at least `pixels` pixels. */
static int read_image(
	struct sog *f, const cJSON *part, const char *key, int i, int image, size_t pixels, struct err *e)
{
	const cJSON *file = cJSON_GetArrayItem(json_get(part, "files"), i);
	struct webp *to = &f->images[image];
	SCOPED char *data = NULL;
	char at[320];
	size_t len;

	if (!cJSON_IsString(file))
		return err_file(e, where(f, key, at), "key 'files' has no name %d", i);
	if (archive_read(&f->files, file->valuestring, &data, &len, e))
		return -1;
	const size_t most = image == CENTROIDS ? (size_t)PALETTE_MOST * 15 : 4 * f->n + SPARE_PIXELS;
	int bad = 0;
	if (image == MEANS_LOW && f->n / GAUSSIANS_A_BYTE > len)
		bad = err_file(e, f->name, "%zu Gaussians do not fit %zu packed bytes of means", f->n, len);
	bad = bad || webp_decode(to, data, len, most, f->name, file->valuestring, e);
	if (bad)
		return -1;
	if ((size_t)to->width * (size_t)to->height < pixels)
		return err_file(e, f->name, "image '%.80s' has %dx%d pixels for %zu values",
			file->valuestring, to->width, to->height, pixels);
	return 0;
}

/* The harmonics: a palette of them, and a label for each Gaussian. */
static int read_palette(struct sog *f, const cJSON *part, struct err *e)
{
	double bands = 0, count = 0;
	char at[320];

	where(f, "shN", at);
	if (json_number(part, "bands", 1, &bands, at, e) < 0 ||
		json_number(part, "count", 1, &count, at, e) < 0 || read_codebook(f, part, "shN", &f->sh, e))
		return -1;
	if (bands != 1 && bands != 2 && bands != 3)
		return err_file(e, at, "%g bands, expected 1 to 3", bands);
	if (!(count >= 1 && count <= PALETTE_MOST && count == floor(count)))
		return err_file(e, at, "a palette of %g, expected 1 to %d", count, PALETTE_MOST);
	f->per_channel = ((int)bands + 1) * ((int)bands + 1) - 1;
	f->palette = (size_t)count;
	if (read_image(f, part, "shN", 0, CENTROIDS, 1, e) || read_image(f, part, "shN", 1, LABELS, f->n, e))
		return -1;
	if (f->images[CENTROIDS].width != PALETTE_ROW * f->per_channel)
		return err_file(e, at, "%d pixels a row of the palette, expected %d",
			f->images[CENTROIDS].width, PALETTE_ROW * f->per_channel);
	return 0;
}

static int read_header(struct sog *f, const cJSON *meta, struct err *e)
{
	double version = 0, count = 0;
	char at[320];

	snprintf(at, sizeof at, "%.200s: meta.json", f->name);
	const int has_version = json_number(meta, "version", 0, &version, at, e);
	if (has_version < 0)
		return -1;
	if (version != 2)
		return err_file(e, at, "%s of SOG, expected version 2",
			has_version ? "another version" : "version 1");
	if (cJSON_IsTrue(json_get(meta, "antialias")))
		return err_file(e, at,
			"trained for another way of rendering ('antialias'), which would be wrong here: train it without that mode");
	if (json_number(meta, "count", 1, &count, at, e) < 0)
		return -1;
	if (!(count >= 0 && count <= UINT32_MAX && count == floor(count)))
		return err_file(e, at, "key 'count' is not a whole number from 0 to 4294967295");
	f->n = (size_t)count;
	return 0;
}

static int read_parts(struct sog *f, const cJSON *meta, struct err *e)
{
	const cJSON *means = json_get(meta, "means"), *scales = json_get(meta, "scales"),
		    *quats = json_get(meta, "quats"), *colors = json_get(meta, "sh0"),
		    *rest = json_get(meta, "shN");
	char at[320];

	where(f, "means", at);
	if (read_header(f, meta, e) || json_matrix(means, "mins", 3, 0, f->low, at, e) ||
		json_matrix(means, "maxs", 3, 0, f->high, at, e) ||
		read_codebook(f, scales, "scales", &f->scales, e) ||
		read_codebook(f, colors, "sh0", &f->colors, e))
		return -1;
	if (read_image(f, means, "means", 0, MEANS_LOW, f->n, e) ||
		read_image(f, means, "means", 1, MEANS_HIGH, f->n, e) ||
		read_image(f, scales, "scales", 0, SCALES, f->n, e) ||
		read_image(f, quats, "quats", 0, QUATS, f->n, e) ||
		read_image(f, colors, "sh0", 0, COLORS, f->n, e))
		return -1;
	return rest && !cJSON_IsNull(rest) ? read_palette(f, rest, e) : 0;
}

static const unsigned char *pixel(const struct sog *f, int image, size_t i)
{
	return f->images[image].rgba + 4 * i;
}

/* The last byte less 252 says which of w x y z is the largest, the others are in order. */
static int unpack_quat(const struct sog *f, size_t row, double *wxyz, struct err *e)
{
	const unsigned char *p = pixel(f, QUATS, row);
	const int largest = p[3] - 252;
	double rest = 1;

	if (largest < 0)
		return err_file(e, f->name,
			"Gaussian %zu: the rotation's last byte is %d, expected 252 to 255", row, p[3]);
	for (int k = 0; k < 4; k++) {
		if (k == largest)
			continue;
		wxyz[k] = (*p++ / 255.0 * 2 - 1) * sqrt(0.5);
		rest -= wxyz[k] * wxyz[k];
	}
	wxyz[largest] = sqrt(fmax(0, rest));
	return 0;
}

static double look_up(const struct codebook *c, int code)
{
	return code < c->n ? c->values[code] : NAN;
}

static int unpack_sh(const struct sog *f, size_t row, double *rest, struct err *e)
{
	const unsigned char *p = pixel(f, LABELS, row);
	const size_t label = p[0] | (size_t)p[1] << 8, at = label / PALETTE_ROW;

	if (label >= f->palette || at >= (size_t)f->images[CENTROIDS].height)
		return err_file(
			e, f->name, "Gaussian %zu: label %zu of a palette of %zu", row, label, f->palette);
	p = pixel(f, CENTROIDS, label * (size_t)f->per_channel);
	for (int k = 0; k < f->per_channel; k++, p += 4)
		for (int c = 0; c < 3; c++)
			rest[c * f->per_channel + k] = look_up(&f->sh, p[c]);
	return 0;
}

static int next_row(void *reader, size_t row, double *values, struct err *e)
{
	const struct sog *f = reader;
	const unsigned char *low = pixel(f, MEANS_LOW, row), *high = pixel(f, MEANS_HIGH, row),
			    *scales = pixel(f, SCALES, row), *colors = pixel(f, COLORS, row);

	for (int k = 0; k < 3; k++) {
		const double t = (low[k] | high[k] << 8) / 65535.0, v = f->low[k] * (1 - t) + f->high[k] * t;
		values[ROW_MEAN + k] = copysign(expm1(fabs(v)), v);
		values[ROW_SCALE + k] = look_up(&f->scales, scales[k]);
		values[ROW_DC + k] = look_up(&f->colors, colors[k]);
	}
	values[ROW_OPACITY] = gaussian_logit(colors[3] / 255.0);
	if (unpack_quat(f, row, values + ROW_ROT, e))
		return -1;
	return f->per_channel ? unpack_sh(f, row, values + ROW_REST, e) : 0;
}

static void release(struct sog *f)
{
	for (int i = 0; i < IMAGES; i++)
		webp_free(&f->images[i]);
	archive_close(&f->files);
}

/* From f->files. */
static int read_all(
	struct sog *f, struct splats *s, double offset[3], struct rows_report *report, struct err *e)
{
	SCOPED char *text = NULL;
	size_t len;

	f->name = f->files.name;
	if (archive_read(&f->files, "meta.json", &text, &len, e))
		return -1;
	SCOPED_BY(json_release) cJSON *meta = json_parse(text, len, f->name, e);
	if (!meta || read_parts(f, meta, e))
		return -1;
	const struct gaussian_rows rows = {f->name, f->n, 3 * f->per_channel, next_row, f, NULL};
	return gaussian_rows_read(s, offset, report, &rows, e);
}

int sog_read_map(struct splats *s, double offset[3], struct rows_report *report, const char *name,
	struct file_map *map, struct err *e)
{
	SCOPED_BY(release) struct sog f = {0};

	return archive_open_zip(&f.files, name, map, e) ? -1 : read_all(&f, s, offset, report, e);
}

int sog_read_meta(
	struct splats *s, double offset[3], struct rows_report *report, const char *meta, struct err *e)
{
	SCOPED_BY(release) struct sog f = {0};
	SCOPED char *folder = file_dir(meta, e);

	if (!folder)
		return -1;
	archive_open_folder(&f.files, folder);
	return read_all(&f, s, offset, report, e);
}
