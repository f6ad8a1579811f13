/* A safetensors file in the making: metadata and tensors are put into it one after another, with the memory
 * of what is made for it. Once something goes wrong the rest is passed over, and arrays_out_end fails.
 * formats/arrays/safetensors.md. */
#pragma once

#include "formats/arrays/safetensors.h"

struct arrays_out {
	const char *path;
	struct err *e;
	int bad;
	size_t n, room, meta_count, meta_room, owned_count, owned_room;
	struct st_tensor *tensors;
	struct st_meta *meta;
	void **owned;
};

/* With the keys that files of ours begin with; options NULL leaves out it and the seed. */
void arrays_out_begin(struct arrays_out *out, const char *path, const char *format, const char *version,
	const char *tool, const char *options, long long seed, struct err *e);

/* A printed text of at most 1023 bytes, that lasts until the end. */
const char *arrays_out_print(struct arrays_out *out, const char *format, ...)
	__attribute__((format(printf, 2, 3)));

/* Metadata: a text that lasts until the end, or a list of strings; NULL is left out. */
void arrays_out_text(struct arrays_out *out, const char *key, const char *value);
void arrays_out_list(struct arrays_out *out, const char *key, char *const *strings, size_t n);

/* A tensor whose name and data last until the end. */
void arrays_out_put(struct arrays_out *out, struct st_tensor tensor);

/* Memory until the end; NULL where something went wrong. */
void *arrays_out_memory(struct arrays_out *out, size_t n, size_t size);

/* Writes the file, unless something went wrong, and releases all memory. Returns 0, or -1 with *e. */
int arrays_out_end(struct arrays_out *out);
