#include "cmd/report/reporting.h"

#include "base/hash.h"
#include "base/mem.h"
#include "mask/trace.h"

/* Sides are level and upright by turns, the last one up to where the line began. */
static char *path_of(const struct trace *t, struct err *e)
{
	char *text = NULL;
	size_t length;
	FILE *out = open_memstream(&text, &length);

	for (size_t i = 0; i < t->n && out; i++) {
		const struct trace_corner *c = &t->corners[i];
		if (c->is_first)
			fprintf(out, "%sM%d %d", i ? "z" : "", c->x, c->y);
		else if (c->y == c[-1].y)
			fprintf(out, "h%d", c->x - c[-1].x);
		else
			fprintf(out, "v%d", c->y - c[-1].y);
	}
	if (out && t->n)
		fputc('z', out);
	if (out && !fclose(out))
		return text;
	err_set(e, ERR_SYSTEM, "outline: out of memory");
	free(text);
	return NULL;
}

static char *trace_path(const struct rle *mask, int height, int width, struct err *e)
{
	SCOPED_BY(rle_free) struct rle small = {0};
	SCOPED_BY(trace_free) struct trace t = {0};
	SCOPED uint8_t *pixels = mem_alloc((size_t)height, (size_t)width, "mask", e);
	char *path = NULL;

	if (pixels && !rle_resize(&small, mask, height, width, e)) {
		rle_decode(&small, pixels);
		path = trace_mask(&t, pixels, height, width, e) ? NULL : path_of(&t, e);
	}
	return path;
}

int report_outline(struct report_outlines *o, const struct rle *mask, int height, int width, size_t *index,
	struct err *e)
{
	char *path = trace_path(mask, height, width, e);

	if (!path)
		return -1;
	const uint64_t hash = hash64(path, strlen(path), 0);
	for (*index = 0; *index < o->n; ++*index)
		if (o->items[*index].hash == hash && !strcmp(o->items[*index].path, path)) {
			free(path);
			return 0;
		}
	if (mem_grow((void **)&o->items, &o->capacity, o->n + 1, sizeof *o->items, "outlines", e)) {
		free(path);
		return -1;
	}
	o->items[o->n++] = (struct report_outline){path, hash};
	return 0;
}

void report_outlines_free(struct report_outlines *o)
{
	for (size_t i = 0; i < o->n; i++)
		free(o->items[i].path);
	free(o->items);
	*o = (struct report_outlines){0};
}
