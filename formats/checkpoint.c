#include "formats/checkpoint.h"

#include "formats/safetensors.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int checkpoint_write(const struct train_state *t, const char *path, const char *identity, struct err *e)
{
	const int64_t count = (int64_t)t->count;
	const struct st_tensor tensors[] = {
		{.name = "values", .dtype = ST_F32, .dims = 1, .shape = {count}, .data = t->values},
		{.name = "first_moment", .dtype = ST_F32, .dims = 1, .shape = {count}, .data = t->m},
		{.name = "second_moment", .dtype = ST_F32, .dims = 1, .shape = {count}, .data = t->v}};
	char iteration[32];
	const struct st_meta meta[] = {{"format", "refer.checkpoint"}, {"version", "1"}, {"tool", "refer-train"},
		{"iteration", iteration}, {"identity", identity}};

	snprintf(iteration, sizeof iteration, "%ld", t->iteration);
	return safetensors_write(path, tensors, 3, meta, sizeof meta / sizeof *meta, e);
}

static int read_state(struct train_state *t, const struct safetensors *st, const char *identity, struct err *e)
{
	static const char *const names[3] = {"values", "first_moment", "second_moment"};
	float *to[3] = {t->values, t->m, t->v};
	char *end = NULL;

	if (safetensors_need_format(st, "refer.checkpoint", 1, e))
		return -1;
	const char *own = safetensors_meta(st, "identity"), *text = safetensors_meta(st, "iteration");
	if (!own || strcmp(own, identity))
		return err_set(e, ERR_FORMAT,
			"%s: is of another training (its options or inputs differ); remove it or train without --resume", st->path);
	t->iteration = text ? strtol(text, &end, 10) : -1;
	if (t->iteration < 0 || *end)
		return err_set(e, ERR_FORMAT, "%s: metadata 'iteration' is not a count", st->path);
	for (int i = 0; i < 3; i++) {
		const struct st_tensor *tensor =
			safetensors_need(st, names[i], ST_F32, 1, (int64_t[]){(int64_t)t->count}, e);
		if (!tensor)
			return -1;
		memcpy(to[i], tensor->data, tensor->bytes);
	}
	return 0;
}

int checkpoint_read(struct train_state *t, const char *path, const char *identity, struct err *e)
{
	struct safetensors st;

	if (safetensors_open(&st, path, e))
		return -1;
	int bad = read_state(t, &st, identity, e);
	safetensors_close(&st);
	return bad;
}
