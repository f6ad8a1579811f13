#include "formats/encoders/parser_weights.h"

#include "base/embed.h"
#include "base/half.h"
#include "base/mem.h"
#include "formats/arrays/arrays_in.h"

#include <math.h>
#include <stdio.h>

/* The default weights are part of the program, so that every tool has them:
 * formats/encoders/parser_default.safetensors. */
EMBED(parser_default, "formats/encoders/parser_default.safetensors");
extern const unsigned char parser_default_begin[], parser_default_end[];

enum { NAME_LENGTH = 48, VERSION_READ = 7, GRAMMAR = -1 };

/* "vector.weight" of the first member, "1.vector.weight" of the next, "grammar.vector.weight" of GRAMMAR;
 * tail: "", or ".scale" for the factors of a matrix's rows. */
static const char *name_of(char out[NAME_LENGTH], int member, const char *part, const char *tail)
{
	char number[12] = "";

	if (member)
		snprintf(number, sizeof number, "%d.", member);
	snprintf(out, NAME_LENGTH, "%s%s%s", member == GRAMMAR ? "grammar." : number, part, tail);
	return out;
}

static int take_matrix(
	const struct safetensors *st, int member, const struct parser_part *p, float *out, struct err *e)
{
	char name[NAME_LENGTH], scale[NAME_LENGTH];
	const size_t rows = p->rows, columns = p->columns;
	const int64_t shape[2] = {(int64_t)rows, (int64_t)columns};
	const struct st_tensor *t =
		safetensors_need(st, name_of(name, member, p->name, ""), ST_I8, 2, shape, e);
	const struct st_tensor *f =
		t ? safetensors_need(st, name_of(scale, member, p->name, ".scale"), ST_F32, 1, shape, e)
		  : NULL;

	if (!f)
		return -1;
	const int8_t *whole = t->data;
	const float *factor = f->data;
	if (safetensors_check_finite(st, scale, factor, rows, e))
		return -1;
	for (size_t i = 0; i < rows * columns; i++)
		out[i] = factor[i / columns] * (float)whole[i];
	return 0;
}

static int take_vector(
	const struct safetensors *st, int member, const struct parser_part *p, float *out, struct err *e)
{
	char name[NAME_LENGTH];
	const size_t n = p->rows;

	name_of(name, member, p->name, "");
	const struct st_tensor *t = safetensors_need(st, name, ST_F16, 1, (int64_t[]){(int64_t)n}, e);

	return -(!t || safetensors_to_float(t, out, n, e) || safetensors_check_finite(st, name, out, n, e));
}

/* *w has been made. */
static int take_member(struct parser_weights *w, int member, const struct safetensors *st, struct err *e)
{
	struct parser_part parts[PARSER_PARTS];
	float *at = w->slab;

	parser_parts(w->width, parts);
	for (int i = 0; i < PARSER_PARTS; i++) {
		const struct parser_part *p = &parts[i];
		if (p->columns ? take_matrix(st, member, p, at, e) : take_vector(st, member, p, at, e))
			return -1;
		at += p->rows * (p->columns ? p->columns : 1);
	}
	return 0;
}

static int take_tensors(struct parser_weights *w, const struct safetensors *st, struct err *e)
{
	struct fingerprint encoder;
	struct arrays_in in;
	char name[NAME_LENGTH];
	size_t rows;

	arrays_in_begin(&in, st, "refer.parser", VERSION_READ, e);
	const char *version = safetensors_meta(st, "version");
	if (!in.bad && atoi(version) < VERSION_READ) /* of another network */
		return err_file(e, st->path, "refer.parser version %s is older than this program reads (%d)",
			version, VERSION_READ);
	const int width = arrays_in_width(&in, "vector.weight", ST_I8, &rows);
	if (in.bad || fingerprint_read(&encoder, st, "encoder", e) || parser_weights_make(w, width, e))
		return -1;
	memcpy(w->encoder, encoder.hex, sizeof w->encoder);
	if (parser_weights_add(&w->grammar, 0, e) || take_member(w->grammar, GRAMMAR, st, e))
		return -1;
	for (int member = 0;; member++, w = w->next) {
		if (take_member(w, member, st, e))
			return -1;
		if (member + 1 == PARSER_MEMBERS ||
			!safetensors_find(st, name_of(name, member + 1, "vector.weight", "")))
			return 0;
		if (parser_weights_add(&w->next, width, e))
			return -1;
	}
}

int parser_weights_read(struct parser_weights *w, const char *path, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	*w = (struct parser_weights){0};
	return -(safetensors_open(&st, path, e) || take_tensors(w, &st, e));
}

int parser_weights_default(struct parser_weights *w, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	*w = (struct parser_weights){0};
	return -(safetensors_open_bytes(&st, "the parser's own weights", parser_default_begin,
			 (size_t)(parser_default_end - parser_default_begin), e) ||
		 take_tensors(w, &st, e));
}

/* A row's largest number is 127 times its factor. */
static void round_matrix(const float *x, size_t rows, size_t columns, int8_t *whole, float *factor)
{
	for (size_t r = 0; r < rows; r++) {
		float most = 0;
		for (size_t c = 0; c < columns; c++)
			most = fmaxf(most, fabsf(x[r * columns + c]));
		factor[r] = most / 127;
		for (size_t c = 0; c < columns; c++)
			whole[r * columns + c] =
				(int8_t)(most > 0 ? lrintf(x[r * columns + c] / factor[r]) : 0);
	}
}

static void put_part(struct arrays_out *out, int member, const struct parser_part *p, const float *from)
{
	const size_t n = p->rows, columns = p->columns;
	char name[NAME_LENGTH];
	const char *own = arrays_out_print(out, "%s", name_of(name, member, p->name, "")),
		   *scale = arrays_out_print(out, "%s", name_of(name, member, p->name, ".scale"));

	if (columns) {
		int8_t *whole = arrays_out_memory(out, n * columns, sizeof *whole);
		float *factor = arrays_out_memory(out, n, sizeof *factor);
		if (factor)
			round_matrix(from, n, columns, whole, factor);
		arrays_out_put(out, st_matrix(own, ST_I8, (int64_t)n, (int64_t)columns, whole));
		arrays_out_put(out, st_vector(scale, ST_F32, (int64_t)n, factor));
	} else {
		uint16_t *half = arrays_out_memory(out, n, sizeof *half);
		for (size_t k = 0; k < n && half; k++)
			half[k] = half_of_float(from[k]);
		arrays_out_put(out, st_vector(own, ST_F16, (int64_t)n, half));
	}
}

static void put_member(struct arrays_out *out, int member, const struct parser_weights *w)
{
	struct parser_part parts[PARSER_PARTS];
	const float *from = w->slab;

	parser_parts(w->width, parts);
	for (int i = 0; i < PARSER_PARTS; i++) {
		put_part(out, member, &parts[i], from);
		from += parts[i].rows * (parts[i].columns ? parts[i].columns : 1);
	}
}

int parser_weights_write(
	const struct parser_weights *w, const char *path, long long seed, const char *source, struct err *e)
{
	struct arrays_out out;

	arrays_out_begin(&out, path, "refer.parser", "7", "parse-train", "", seed, e);
	arrays_out_text(&out, "source", source);
	arrays_out_text(&out, "encoder", w->encoder[0] ? w->encoder : NULL);
	if (w->grammar)
		put_member(&out, GRAMMAR, w->grammar);
	for (int member = 0; w && member < PARSER_MEMBERS; member++, w = w->next)
		put_member(&out, member, w);
	return arrays_out_end(&out);
}

int parser_weights_need_middle(const struct parser_weights *w, const char *path, const float *middle,
	const struct fingerprint *encoder, struct err *e)
{
	if (middle || strcmp(w->encoder, encoder->hex) != 0)
		return 0;
	return err_file(e, path,
		"tensor 'middle' is missing, by which sentences are taken apart: make the file anew");
}
