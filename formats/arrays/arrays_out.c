#include "formats/arrays/arrays_out.h"

#include "base/mem.h"
#include "formats/arrays/metalist.h"

#include <stdarg.h>
#include <stdio.h>

void arrays_out_begin(struct arrays_out *out, const char *path, const char *format, const char *version,
	const char *tool, const char *options, long long seed, struct err *e)
{
	*out = (struct arrays_out){.path = path, .e = e};
	arrays_out_text(out, "format", format);
	arrays_out_text(out, "version", version);
	arrays_out_text(out, "tool", tool);
	arrays_out_text(out, "options", options);
	arrays_out_text(out, "seed", options ? arrays_out_print(out, "%lld", seed) : NULL);
}

/* A block that is the file's from then on, and released where that fails. */
static void *own(struct arrays_out *out, void *block)
{
	if (out->bad || mem_grow((void **)&out->owned, &out->owned_room, out->owned_count + 1,
				sizeof *out->owned, out->path, out->e)) {
		free(block);
		out->bad = 1;
		return NULL;
	}
	return out->owned[out->owned_count++] = block;
}

void *arrays_out_memory(struct arrays_out *out, size_t n, size_t size)
{
	void *block = out->bad ? NULL : mem_alloc(n, size, out->path, out->e);

	out->bad |= !block;
	return own(out, block);
}

void arrays_out_text(struct arrays_out *out, const char *key, const char *value)
{
	out->bad = out->bad || mem_grow((void **)&out->meta, &out->meta_room, out->meta_count + 1,
				       sizeof *out->meta, out->path, out->e);
	if (!out->bad)
		out->meta[out->meta_count++] = (struct st_meta){key, value};
}

const char *arrays_out_print(struct arrays_out *out, const char *format, ...)
{
	char text[1024];
	va_list ap;

	va_start(ap, format);
	const int length = vsnprintf(text, sizeof text, format, ap);
	va_end(ap);
	char *copy = arrays_out_memory(out, (size_t)length + 1, 1);
	if (copy)
		snprintf(copy, (size_t)length + 1, "%s", text);
	return copy;
}

void arrays_out_list(struct arrays_out *out, const char *key, char *const *strings, size_t n)
{
	char *value = strings && !out->bad ? metalist_print(strings, n) : NULL;

	if (strings && !out->bad && !value)
		out->bad = err_set(out->e, ERR_SYSTEM, "%s: out of memory", out->path);
	if (strings)
		arrays_out_text(out, key, own(out, value));
}

void arrays_out_put(struct arrays_out *out, struct st_tensor tensor)
{
	out->bad = out->bad ||
		   mem_grow((void **)&out->tensors, &out->room, out->n + 1, sizeof tensor, out->path, out->e);
	if (!out->bad)
		out->tensors[out->n++] = tensor;
}

int arrays_out_end(struct arrays_out *out)
{
	out->bad = out->bad ||
		   safetensors_write(out->path, out->tensors, out->n, out->meta, out->meta_count, out->e);
	for (size_t i = 0; i < out->owned_count; i++)
		free(out->owned[i]);
	mem_free_all(out->owned, out->tensors, out->meta);
	return out->bad ? -1 : 0;
}
