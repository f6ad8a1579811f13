/* Writing safetensors: the header with a checksum for each tensor, then the tensors, widest type first. */
#include "base/little.h"
#include "base/mem.h"
#include "formats/arrays/safetensors.h"

#include <cjson/cJSON.h>
#include <libdeflate.h>

char *st_crc_key(const char *tensor, struct err *e)
{
	const size_t room = sizeof "crc32." + strlen(tensor);
	char *key = mem_alloc(room, 1, "tensor name", e);

	if (key)
		snprintf(key, room, "crc32.%s", tensor);
	return key;
}

static size_t tensor_bytes(const struct st_tensor *t)
{
	size_t bytes = st_dtype_size(t->dtype);

	for (int i = 0; i < t->dims; i++)
		bytes *= (size_t)t->shape[i];
	return bytes;
}

/* The header with the tensors in the order `order`; NULL with *e set when memory is out. */
static char *make_header(const struct st_tensor *tensors, const size_t *order, size_t n,
	const struct st_meta *meta, size_t meta_count, struct err *e)
{
	cJSON *root = cJSON_CreateObject(), *m = cJSON_AddObjectToObject(root, "__metadata__");
	size_t at = 0;

	for (size_t i = 0; i < meta_count; i++)
		if (meta[i].value)
			cJSON_AddStringToObject(m, meta[i].key, meta[i].value);
	for (size_t k = 0; k < n; k++) {
		const struct st_tensor *t = &tensors[order[k]];
		size_t bytes = tensor_bytes(t);
		char value[16], *key = st_crc_key(t->name, e);
		if (!key) {
			cJSON_Delete(root);
			return NULL;
		}
		snprintf(value, sizeof value, "%08x", libdeflate_crc32(0, t->data, bytes));
		cJSON_AddStringToObject(m, key, value);
		free(key);
		cJSON *item = cJSON_AddObjectToObject(root, t->name);
		cJSON_AddStringToObject(item, "dtype", st_dtype_name(t->dtype));
		cJSON *shape = cJSON_AddArrayToObject(item, "shape");
		for (int i = 0; i < t->dims; i++)
			cJSON_AddItemToArray(shape, cJSON_CreateNumber((double)t->shape[i]));
		cJSON *range = cJSON_AddArrayToObject(item, "data_offsets");
		cJSON_AddItemToArray(range, cJSON_CreateNumber((double)at));
		at += bytes;
		cJSON_AddItemToArray(range, cJSON_CreateNumber((double)at));
	}
	char *text = cJSON_PrintUnformatted(root);
	cJSON_Delete(root);
	if (!text)
		err_set(e, ERR_SYSTEM, "out of memory for the header");
	return text;
}

/* A failed write is found out at once, while errno still says why. */
static int put(struct file_out *out, const void *data, size_t bytes, struct err *e)
{
	return bytes && fwrite(data, 1, bytes, out->stream) != bytes
		       ? err_errno(e, "%s", file_name(out->path))
		       : 0;
}

int safetensors_write(const char *path, const struct st_tensor *tensors, size_t n, const struct st_meta *meta,
	size_t meta_count, struct err *e)
{
	static const char spaces[64] = "                                                                ";
	SCOPED size_t *order = mem_alloc(n, sizeof *order, path, e);
	struct file_out out = {0};
	size_t k = 0;

	if (!order)
		return -1;
	for (size_t size = 8; size; size /= 2)
		for (size_t i = 0; i < n; i++)
			if (st_dtype_size(tensors[i].dtype) == size)
				order[k++] = i;
	SCOPED char *header = make_header(tensors, order, n, meta, meta_count, e);
	if (!header)
		return err_prefix(e, path);
	if (file_out_open(&out, path, e))
		return -1;
	size_t used = strlen(header), padded = (used + 8 + 63) / 64 * 64 - 8;
	unsigned char length[8];
	little_put(length, padded, 8);
	int bad =
		put(&out, length, 8, e) || put(&out, header, used, e) || put(&out, spaces, padded - used, e);
	for (k = 0; k < n && !bad; k++)
		bad = put(&out, tensors[order[k]].data, tensor_bytes(&tensors[order[k]]), e);
	return file_out_end(&out, bad, e);
}
