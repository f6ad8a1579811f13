/* Writing .glb: JSON with a buffer view and an accessor for each attribute, then the attributes one after the
 * other, as floats. formats/splats/glb.md. */
#include "base/file.h"
#include "base/little.h"
#include "base/mem.h"
#include "formats/splats/glb.h"

#include <math.h>

enum { FLOAT = 4, ATTRIBUTES_MOST = 4 + 16 };

/* x and y are turned round, as in glb.c. */
static const double signs[3] = {-1, -1, 1};

struct attribute {
	char name[64];
	int width;
};

/* POSITION, ROTATION, SCALE, OPACITY and then the harmonics; returns how many. */
static int list_attributes(struct attribute a[ATTRIBUTES_MOST], int coefficients)
{
	int n = 4;

	a[0] = (struct attribute){"POSITION", 3};
	a[1] = (struct attribute){GLB_EXTENSION ":ROTATION", 4};
	a[2] = (struct attribute){GLB_EXTENSION ":SCALE", 3};
	a[3] = (struct attribute){GLB_EXTENSION ":OPACITY", 1};
	for (int degree = 0; degree * degree < coefficients; degree++)
		for (int c = 0; c <= 2 * degree; c++, n++) {
			a[n].width = 3;
			snprintf(a[n].name, sizeof a[n].name, GLB_EXTENSION ":SH_DEGREE_%d_COEF_%d", degree,
				c);
		}
	return n;
}

/* The numbers of attribute k of Gaussian i. */
static void attribute_of(float *to, const struct splats *s, size_t i, int k)
{
	const float *quat = s->quats + 4 * i;
	const double turned[4] = {-quat[2], quat[1], quat[0], -quat[3]}; /* half a turn about z */
	double length = 0;

	switch (k) {
	case 0:
		for (int c = 0; c < 3; c++)
			to[c] = (float)(signs[c] * (double)s->means[3 * i + (size_t)c]);
		return;
	case 1:
		for (int c = 0; c < 4; c++)
			length += (double)quat[c] * quat[c];
		for (int c = 0; c < 4; c++)
			to[c] = (float)(turned[c] / sqrt(length));
		return;
	case 2:
		memcpy(to, s->scales + 3 * i, 3 * sizeof *to);
		return;
	case 3:
		to[0] = s->opacities[i];
		return;
	default:
		for (int c = 0; c < 3; c++)
			to[c] = (float)gaussian_flip_sign(k - 4, FLIP_X | FLIP_Y) *
				s->sh[3 * ((size_t)s->sh_coefficients * i + (size_t)(k - 4)) + (size_t)c];
	}
}

static void print_list(FILE *out, const char *key, const double x[3])
{
	fprintf(out, ",\"%s\":[%.9g,%.9g,%.9g]", key, x[0], x[1], x[2]);
}

/* The bounds of POSITION, which glTF asks for. */
static void print_bounds(FILE *out, const struct splats *s)
{
	double low[3] = {0}, high[3] = {0};

	for (size_t i = 0; i < s->n; i++) {
		float mean[3];
		attribute_of(mean, s, i, 0);
		for (int c = 0; c < 3; c++) {
			low[c] = i ? fmin(low[c], mean[c]) : mean[c];
			high[c] = i ? fmax(high[c], mean[c]) : mean[c];
		}
	}
	print_list(out, "min", low);
	print_list(out, "max", high);
}

static void print_node(FILE *out, const double offset[3])
{
	fputs("\"nodes\":[{\"mesh\":0", out);
	if (offset[0] != 0 || offset[1] != 0 || offset[2] != 0) {
		fputs(",\"translation\":[", out);
		for (int c = 0; c < 3; c++)
			fprintf(out, "%s%.17g", c ? "," : "", signs[c] * offset[c] + 0.0);
		fputc(']', out);
	}
	fputs("}],", out);
}

static void print_json(FILE *out, const struct splats *s, const double offset[3], const struct attribute *a,
	int n, size_t bytes)
{
	size_t at = 0;

	fputs("{\"asset\":{\"version\":\"2.0\",\"generator\":\"refersplat\"},\"extensionsUsed\":[\"" GLB_EXTENSION
	      "\"],\"scene\":0,\"scenes\":[{\"nodes\":[0]}],",
		out);
	print_node(out, offset);
	fputs("\"meshes\":[{\"primitives\":[{\"mode\":0,\"attributes\":{", out);
	for (int k = 0; k < n; k++)
		fprintf(out, "%s\"%s\":%d", k ? "," : "", a[k].name, k);
	fputs("},\"extensions\":{\"" GLB_EXTENSION
	      "\":{\"kernel\":\"ellipse\",\"colorSpace\":\"srgb_rec709_display\","
	      "\"projection\":\"perspective\",\"sortingMethod\":\"cameraDistance\"}}}]}],",
		out);
	fprintf(out, "\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[", bytes);
	for (int k = 0; k < n; k++) {
		const size_t length = s->n * (size_t)a[k].width * FLOAT;
		fprintf(out, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":34962}",
			k ? "," : "", at, length);
		at += length;
	}
	fputs("],\"accessors\":[", out);
	for (int k = 0; k < n; k++) {
		fprintf(out, "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"",
			k ? "," : "", k, GLB_F32, s->n,
			a[k].width == 1	  ? "SCALAR"
			: a[k].width == 3 ? "VEC3"
					  : "VEC4");
		if (!k)
			print_bounds(out, s);
		fputc('}', out);
	}
	fputs("]}", out);
}

static void put_numbers(FILE *out, const struct splats *s, const struct attribute *a, int n)
{
	unsigned char bytes[4 * FLOAT], *p;
	float values[4];

	for (int k = 0; k < n; k++)
		for (size_t i = 0; i < s->n; i++) {
			attribute_of(values, s, i, k);
			p = bytes;
			for (int c = 0; c < a[k].width; c++)
				p = little_put_f32(p, values[c]);
			fwrite(bytes, 1, (size_t)(p - bytes), out);
		}
}

static void put_word(FILE *out, uint64_t word)
{
	unsigned char bytes[4];

	little_put(bytes, word, 4);
	fwrite(bytes, 1, sizeof bytes, out);
}

/* The JSON, padded with blanks to whole words: free() it. */
static char *make_json(size_t *length, const struct splats *s, const double offset[3],
	const struct attribute *a, int n, size_t bytes, const char *path, struct err *e)
{
	char *text = NULL;
	FILE *out = open_memstream(&text, length);

	if (out)
		print_json(out, s, offset, a, n, bytes);
	while (out && !fflush(out) && *length % 4)
		fputc(' ', out);
	return mem_text_end(out, &text, 0, file_name(path), e);
}

int glb_write(const struct splats *s, const double offset[3], const char *path, struct err *e)
{
	struct attribute attributes[ATTRIBUTES_MOST];
	const int n = list_attributes(attributes, s->sh_coefficients);
	const size_t row = (3 + 4 + 3 + 1 + 3 * (size_t)s->sh_coefficients) * FLOAT;
	struct file_out out;
	size_t length = 0;

	if (s->n > (UINT32_MAX - (1 << 16)) / row)
		return err_file(e, file_name(path), "%zu Gaussians of %zu bytes do not fit a .glb, of 4 GiB",
			s->n, row);
	SCOPED char *json = make_json(&length, s, offset, attributes, n, s->n * row, path, e);
	if (!json || file_out_open(&out, path, e))
		return -1;
	put_word(out.stream, GLB_MAGIC);
	put_word(out.stream, 2);
	put_word(out.stream, GLB_HEADER + 2 * GLB_CHUNK + length + s->n * row);
	put_word(out.stream, length);
	put_word(out.stream, GLB_JSON);
	fwrite(json, 1, length, out.stream);
	put_word(out.stream, s->n * row);
	put_word(out.stream, GLB_BIN);
	put_numbers(out.stream, s, attributes, n);
	return file_out_commit(&out, e);
}
