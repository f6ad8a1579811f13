#include "formats/parser_weights.h"

#include "base/mem.h"
#include "formats/fingerprint.h"
#include "formats/safetensors.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The default weights are part of the program, so that every tool has them:
 * formats/parser_default.safetensors. */
#define EMBED(name, file)                                                                                    \
	__asm__(".section .rodata\n"                                                                         \
		".balign 64\n"                                                                               \
		".globl " #name "_begin\n.hidden " #name "_begin\n" #name "_begin:\n"                        \
		".incbin \"" file "\"\n"                                                                     \
		".globl " #name "_end\n.hidden " #name "_end\n" #name "_end:\n"                              \
		".byte 0\n"                                                                                  \
		".previous\n")
EMBED(parser_default, "formats/parser_default.safetensors");
extern const unsigned char parser_default_begin[], parser_default_end[];

enum { MEMBERS_MOST = 8, NAME_LENGTH = 40 };

/* "vector.weight" of the first member, "1.vector.weight" of the next. */
static const char *name_of(char out[NAME_LENGTH], int member, const char *part)
{
	if (member)
		snprintf(out, NAME_LENGTH, "%d.%s", member, part);
	else
		snprintf(out, NAME_LENGTH, "%s", part);
	return out;
}

/* *w has been made. */
static int take_member(struct parser_weights *w, int member, const struct safetensors *st, struct err *e)
{
	struct parser_part parts[PARSER_PARTS];
	char name[NAME_LENGTH];
	float *at = w->slab;

	parser_parts(w->width, parts);
	for (int i = 0; i < PARSER_PARTS; i++) {
		const size_t n = parts[i].rows * (parts[i].columns ? parts[i].columns : 1);
		const int64_t shape[2] = {(int64_t)parts[i].rows, (int64_t)parts[i].columns};
		const struct st_tensor *t = safetensors_need(
			st, name_of(name, member, parts[i].name), ST_F16, parts[i].columns ? 2 : 1, shape, e);
		if (!t || safetensors_to_float(t, at, n, e))
			return -1;
		for (size_t k = 0; k < n; k++)
			if (!isfinite(at[k]))
				return err_set(e, ERR_FORMAT, "%s: tensor '%s': item %zu is not finite",
					st->path, name, k);
		at += n;
	}
	return 0;
}

static int take_tensors(struct parser_weights *w, const struct safetensors *st, struct err *e)
{
	const struct st_tensor *t;
	struct fingerprint encoder;
	char name[NAME_LENGTH];

	if (safetensors_need_format(st, "refer.parser", 1, e) ||
		!(t = safetensors_need(st, "vector.weight", ST_F16, 2, (int64_t[]){NET_HIDDEN, -1}, e)))
		return -1;
	if (t->shape[1] < 1 || t->shape[1] > 65536)
		return err_set(e, ERR_FORMAT, "%s: tensor 'vector.weight': width %lld is not in 1 to 65536",
			st->path, (long long)t->shape[1]);
	const int width = (int)t->shape[1];
	if (fingerprint_read(&encoder, st, "encoder", e) || parser_weights_make(w, width, e))
		return -1;
	memcpy(w->encoder, encoder.hex, sizeof w->encoder);
	for (int member = 0;; member++) {
		if (take_member(w, member, st, e))
			return -1;
		if (member + 1 == MEMBERS_MOST ||
			!safetensors_find(st, name_of(name, member + 1, "vector.weight")))
			return 0;
		w->next = mem_zalloc(1, sizeof *w->next, "parser's weights", e);
		if (!w->next || parser_weights_make(w->next, width, e))
			return -1;
		w = w->next;
	}
}

static int take(struct parser_weights *w, struct safetensors *st, struct err *e)
{
	int bad = take_tensors(w, st, e);

	safetensors_close(st);
	if (bad)
		parser_weights_free(w);
	return bad;
}

int parser_weights_read(struct parser_weights *w, const char *path, struct err *e)
{
	struct safetensors st;

	*w = (struct parser_weights){0};
	return safetensors_open(&st, path, e) ? -1 : take(w, &st, e);
}

int parser_weights_default(struct parser_weights *w, struct err *e)
{
	struct safetensors st;

	*w = (struct parser_weights){0};
	return safetensors_open_bytes(&st, "the parser's own weights", parser_default_begin,
		       (size_t)(parser_default_end - parser_default_begin), e)
		       ? -1
		       : take(w, &st, e);
}

/* Its tensors, of names and values that stay the caller's. */
static int put_member(const struct parser_weights *w, int member, struct st_tensor *tensors,
	char (*names)[NAME_LENGTH], struct err *e)
{
	struct parser_part parts[PARSER_PARTS];
	uint16_t *half = mem_alloc(w->count, sizeof *half, "parser's weights", e), *at = half;

	if (!half)
		return -1;
	for (size_t i = 0; i < w->count; i++)
		half[i] = st_float_to_half(w->slab[i]);
	parser_parts(w->width, parts);
	for (int i = 0; i < PARSER_PARTS; i++) {
		tensors[i] = (struct st_tensor){.name = name_of(names[i], member, parts[i].name),
			.dtype = ST_F16,
			.dims = parts[i].columns ? 2 : 1,
			.shape = {(int64_t)parts[i].rows, (int64_t)parts[i].columns},
			.data = at};
		at += parts[i].rows * (parts[i].columns ? parts[i].columns : 1);
	}
	return 0;
}

int parser_weights_write(const struct parser_weights *w, const char *path, const char *options,
	long long seed, const char *source, struct err *e)
{
	struct st_tensor tensors[MEMBERS_MOST * PARSER_PARTS] = {{0}};
	char names[MEMBERS_MOST * PARSER_PARTS][NAME_LENGTH], seed_text[32];
	const struct parser_weights *m = w;
	int members = 0, bad = 0;

	for (; m && members < MEMBERS_MOST && !bad; m = m->next, members++)
		bad = put_member(
			m, members, tensors + members * PARSER_PARTS, names + members * PARSER_PARTS, e);
	snprintf(seed_text, sizeof seed_text, "%lld", seed);
	const struct st_meta meta[] = {{"format", "refer.parser"}, {"version", "1"}, {"tool", "parse-train"},
		{"options", options}, {"seed", seed_text}, {"source", source},
		{"encoder", w->encoder[0] ? w->encoder : NULL}};
	if (!bad)
		bad = safetensors_write(
			path, tensors, (size_t)members * PARSER_PARTS, meta, sizeof meta / sizeof *meta, e);
	for (int k = 0; k < members; k++)
		free((void *)tensors[k * PARSER_PARTS].data);
	return bad ? -1 : 0;
}
