#include "formats/parser.h"

#include "base/mem.h"
#include "formats/safetensors.h"

#include <stdio.h>
#include <stdlib.h>

int parser_read(struct parser_weights *w, const char *path, struct err *e)
{
	struct parser_part parts[PARSER_PARTS];
	struct safetensors st;
	const struct st_tensor *t;
	int bad = 0;
	float *at;

	*w = (struct parser_weights){0};
	if (safetensors_open(&st, path, e))
		return -1;
	if (safetensors_need_format(&st, "refer.parser", 1, e) ||
		!(t = safetensors_need(&st, "vector.weight", ST_F16, 2, (int64_t[]){NET_HIDDEN, -1}, e)) ||
		parser_weights_make(w, (int)t->shape[1], e))
		goto fail;
	parser_parts(w->width, parts);
	at = w->slab;
	for (int i = 0; i < PARSER_PARTS && !bad; i++) {
		size_t n = parts[i].rows * (parts[i].columns ? parts[i].columns : 1);
		const int64_t shape[2] = {(int64_t)parts[i].rows, (int64_t)parts[i].columns};
		t = safetensors_need(&st, parts[i].name, ST_F16, parts[i].columns ? 2 : 1, shape, e);
		bad = !t || safetensors_to_float(t, at, n, e);
		at += n;
	}
	if (bad)
		goto fail;
	safetensors_close(&st);
	return 0;
fail:
	parser_weights_free(w);
	safetensors_close(&st);
	return -1;
}

int parser_write(const struct parser_weights *w, const char *path, const char *options, long long seed,
	const char *source, struct err *e)
{
	struct parser_part parts[PARSER_PARTS];
	struct st_tensor tensors[PARSER_PARTS];
	uint16_t *half = mem_alloc(w->count, sizeof *half, path, e), *at = half;
	char seed_text[32];
	int bad;

	if (!half)
		return -1;
	for (size_t i = 0; i < w->count; i++)
		half[i] = st_float_to_half(w->slab[i]);
	parser_parts(w->width, parts);
	for (int i = 0; i < PARSER_PARTS; i++) {
		tensors[i] = (struct st_tensor){.name = parts[i].name,
			.dtype = ST_F16,
			.dims = parts[i].columns ? 2 : 1,
			.shape = {(int64_t)parts[i].rows, (int64_t)parts[i].columns},
			.data = at};
		at += parts[i].rows * (parts[i].columns ? parts[i].columns : 1);
	}
	snprintf(seed_text, sizeof seed_text, "%lld", seed);
	const struct st_meta meta[] = {{"format", "refer.parser"}, {"version", "1"}, {"tool", "parse-train"},
		{"options", options}, {"seed", seed_text}, {"source", source}};
	bad = safetensors_write(path, tensors, PARSER_PARTS, meta, sizeof meta / sizeof *meta, e);
	free(half);
	return bad;
}
