/* The writer's bytes, the way back, and what a reader of our own formats may rely on. Broken files are tried
 * by tests/format/safetensors.bats. */
#include "unit.h"

#include "formats/arrays/safetensors.h"

#include <unistd.h>

static const char golden[] = "tests/golden/good/small.safetensors";

static const float matrix[4] = {1, -2.5f, 0, 1e10f};
static const int32_t ids[3] = {7, -1, 2147483647};
static const uint8_t bytes[3] = {1, 2, 255};

static const struct st_tensor tensors[] = {
	{.name = "bytes", .dtype = ST_U8, .dims = 1, .shape = {3}, .data = bytes},
	{.name = "ids", .dtype = ST_I32, .dims = 1, .shape = {3}, .data = ids},
	{.name = "matrix", .dtype = ST_F32, .dims = 2, .shape = {2, 2}, .data = matrix},
	{.name = "none", .dtype = ST_F32, .dims = 2, .shape = {0, 2}, .data = matrix},
	{.name = "one", .dtype = ST_I64, .dims = 0, .data = (const int64_t[]){-3}},
};
static const struct st_meta meta[] = {{"format", "refer.example"}, {"version", "1"}, {"tool", "test"},
	{"options", "a \"quoted\" one"}, {"seed", "1"}};

static void written_bytes(void)
{
	char path[] = "/tmp/refersplat-test-XXXXXX";
	struct err e = {0};
	struct file_map old, new;

	close(mkstemp(path));
	CHECK(!safetensors_write(path, tensors, 5, meta, 5, &e), "%s", e.message);
	if (!CHECK(!file_map(path, &new, &e) && !file_map(golden, &old, &e), "%s", e.message))
		return;
	CHECK(old.len == new.len && !memcmp(old.data, new.data, old.len), "the bytes are those of %s",
		golden);
	file_unmap(&old);
	file_unmap(&new);
	unlink(path);
}

static void read_back(void)
{
	struct err e = {0};
	struct safetensors st;
	float values[4];

	if (!CHECK(!safetensors_open(&st, golden, &e), "%s", e.message))
		return;
	CHECK(st.n == 5, "%zu tensors", st.n);
	CHECK((st.tensors[0].bytes == 8 && !strcmp(st.tensors[0].name, "one")),
		"the widest type comes first");
	for (int i = 0; i < 5; i++) {
		const struct st_tensor *t = safetensors_find(&st, tensors[i].name);
		CHECK(t && t->dtype == tensors[i].dtype && t->dims == tensors[i].dims &&
				!memcmp(t->shape, tensors[i].shape, sizeof t->shape),
			"%s has its type and shape", tensors[i].name);
		CHECK(t && !memcmp(t->data, tensors[i].data, t->bytes), "%s has its data", tensors[i].name);
		CHECK(t && (size_t)t->data % st_dtype_size(t->dtype) == 0, "%s is aligned", tensors[i].name);
	}
	CHECK(!strcmp(safetensors_meta(&st, "options"), meta[3].value), "metadata come back");
	CHECK(!safetensors_meta(&st, "none") && !safetensors_find(&st, "None"),
		"what is not there is not found");
	CHECK(!safetensors_to_float(safetensors_find(&st, "matrix"), values, 4, &e) && values[3] == 1e10f,
		"floats");
	CHECK(safetensors_to_float(safetensors_find(&st, "matrix"), values, 3, &e) < 0 &&
			!strcmp(e.message, "tensor 'matrix': has 4 items, expected 3"),
		"%s", e.message);
	CHECK(safetensors_to_float(safetensors_find(&st, "ids"), values, 3, &e) < 0 &&
			!strcmp(e.message, "tensor 'ids': is I32, expected a float type"),
		"%s", e.message);
	safetensors_close(&st);
	safetensors_close(&st);
}

static void needs(void)
{
	struct err e = {0};
	struct safetensors st;

	if (!CHECK(!safetensors_open(&st, golden, &e), "%s", e.message))
		return;
	CHECK(safetensors_need(&st, "matrix", ST_F32, 2, (int64_t[]){-1, 2}, &e) != NULL, "%s", e.message);
	CHECK(!safetensors_need(&st, "matrix", ST_F32, 2, (int64_t[]){-1, 3}, &e) &&
			strstr(e.message, ": tensor 'matrix': is F32[2,2], expected F32[*,3]"),
		"%s", e.message);
	CHECK(!safetensors_need(&st, "ids", ST_F32, 1, (int64_t[]){3}, &e) &&
			strstr(e.message, ": tensor 'ids': is I32[3], expected F32[3]"),
		"%s", e.message);
	CHECK(!safetensors_need(&st, "ids", ST_I32, 0, NULL, &e) &&
			strstr(e.message, ": tensor 'ids': is I32[3], expected I32[]"),
		"%s", e.message);
	CHECK(!safetensors_need(&st, "x", ST_I32, 0, NULL, &e) &&
			strstr(e.message, ": tensor 'x' is missing"),
		"%s", e.message);
	CHECK(!safetensors_need_format(&st, "refer.example", 1, &e), "%s", e.message);
	CHECK(safetensors_need_format(&st, "refer.other", 1, &e) < 0 &&
			strstr(e.message, ": format is 'refer.example', expected 'refer.other'"),
		"%s", e.message);
	CHECK(safetensors_need_format(&st, "refer.example", 0, &e) < 0 &&
			strstr(e.message, ": refer.example version 1 is newer than this program reads (0)"),
		"%s", e.message);
	st.tensors[0].data = (const char *)st.tensors[0].data + 1;
	CHECK(safetensors_need_format(&st, "refer.example", 1, &e) < 0 &&
			strstr(e.message, "not aligned to its type"),
		"%s", e.message);
	safetensors_close(&st);
}

static void conversions(void)
{
	struct err e = {0};
	float out[2] = {0};
	/* At an odd offset, as in foreign files. */
	unsigned char odd[17];

	memcpy(odd + 1, (const uint16_t[]){0x3c00, 0xc100}, 4);
	CHECK(!safetensors_to_float(
		      &(struct st_tensor){.dtype = ST_F16, .data = odd + 1, .bytes = 4}, out, 2, &e) &&
			out[0] == 1 && out[1] == -2.5f,
		"halves %g %g", out[0], out[1]);
	memcpy(odd + 1, (const uint16_t[]){0x3f80, 0xc020}, 4);
	CHECK(!safetensors_to_float(
		      &(struct st_tensor){.dtype = ST_BF16, .data = odd + 1, .bytes = 4}, out, 2, &e) &&
			out[0] == 1 && out[1] == -2.5f,
		"bfloats %g %g", out[0], out[1]);
	memcpy(odd + 1, (const double[]){1, -2.5}, 16);
	CHECK(!safetensors_to_float(
		      &(struct st_tensor){.dtype = ST_F64, .data = odd + 1, .bytes = 16}, out, 2, &e) &&
			out[0] == 1 && out[1] == -2.5f,
		"doubles %g %g", out[0], out[1]);
}

/* Two tensors whose long names differ at the end only: each has a checksum of its own. */
static void long_names(void)
{
	enum { LONG = 700 };
	static char names[2][LONG + 1];
	char path[] = "/tmp/refersplat-test-XXXXXX";
	struct st_tensor two[2];
	struct safetensors st;
	struct err e = {0};

	for (int i = 0; i < 2; i++) {
		memset(names[i], 'a', LONG - 1);
		names[i][LONG - 1] = (char)('0' + i);
		two[i] = tensors[i];
		two[i].name = names[i];
	}
	close(mkstemp(path));
	if (CHECK(!safetensors_write(path, two, 2, NULL, 0, &e) && !safetensors_open(&st, path, &e), "%s",
		    e.message)) {
		CHECK(st.n == 2 && st.meta_count == 2, "%zu tensors, %zu keys", st.n, st.meta_count);
		safetensors_close(&st);
	}
	unlink(path);
}

int main(void)
{
	written_bytes();
	long_names();
	read_back();
	needs();
	conversions();
	return unit_end();
}
