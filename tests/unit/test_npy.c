#include "formats/arrays/npy.h"
#include "unit.h"

#include <unistd.h>

static char path[] = "/tmp/test_npy.XXXXXX";

static void put(const char *bytes, size_t len)
{
	FILE *out = fopen(path, "wb");

	fwrite(bytes, 1, len, out);
	fclose(out);
}

/* As numpy.save writes np.float32([[1, 2], [0.5, -1]]). */
static const char matrix[] =
	"\x93NUMPY\x01\x00v\x00{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }"
	"                                                          \n"
	"\x00\x00\x80\x3f\x00\x00\x00\x40\x00\x00\x00\x3f\x00\x00\x80\xbf";
enum { MATRIX_BYTES = sizeof matrix - 1, DATA = 128 };

static void test_round_trip(void)
{
	const float values[4] = {1, 2, 0.5f, -1};
	const size_t shape[8] = {2, 2, 1, 1, 1, 1, 1, 1};
	struct npy a;
	struct err e = {0};
	char back[256];

	CHECK(!npy_write(path, values, shape, 2, &e), "%s", e.message);
	FILE *in = fopen(path, "rb");
	size_t len = fread(back, 1, sizeof back, in);
	fclose(in);
	CHECK(MATRIX_BYTES == DATA + 16 && len == MATRIX_BYTES && !memcmp(back, matrix, len), "%zu bytes",
		len);
	for (int dims = 0; dims <= 8; dims++) {
		size_t count = dims == 0 ? 1 : dims == 1 ? 2 : 4;
		CHECK(!npy_write(path, values, shape, dims, &e) && !npy_open(&a, path, &e), "%d: %s", dims,
			e.message);
		CHECK(a.dims == dims && a.count == count && !memcmp(a.data, values, 4 * count), "%d dims",
			dims);
		CHECK(!memcmp(a.shape, shape, (size_t)dims * sizeof *shape), "%d dims", dims);
		npy_close(&a);
	}
	const size_t empty[2] = {3, 0};
	CHECK(!npy_write(path, values, empty, 2, &e) && !npy_open(&a, path, &e), "%s", e.message);
	CHECK(a.count == 0 && a.shape[0] == 3 && a.shape[1] == 0, "no values");
	npy_close(&a);
}

static const char dict[] = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }";

/* The matrix with `with` in place of the text `what` of its header. */
static void expect(const char *what, const char *with, const char *message)
{
	char bytes[MATRIX_BYTES], header[DATA], expected[256];
	const char *at = strstr(dict, what);
	struct npy a;
	struct err e = {0};

	int used =
		snprintf(header, sizeof header, "%.*s%s%s", (int)(at - dict), dict, with, at + strlen(what));
	memcpy(bytes, matrix, MATRIX_BYTES);
	memset(bytes + 10, ' ', DATA - 11);
	memcpy(bytes + 10, header, (size_t)used);
	put(bytes, MATRIX_BYTES);
	snprintf(expected, sizeof expected, "%s: %s", path, message);
	CHECK(npy_open(&a, path, &e) && e.code == ERR_FORMAT && !strcmp(e.message, expected), "%s: %s", with,
		e.message);
	npy_close(&a);
}

static void test_errors(void)
{
	struct npy a;
	struct err e = {0};

	expect("<f4", "<f8", "offset 128: 16 bytes of data, the shape has 4 values of 8");
	expect("<f4", ">f4", "header, offset 20: 'descr' is no float or whole number, little-endian");
	expect("False", "True", "header, offset 44: 'fortran_order' is not False");
	expect("(2, 2)", "[2, 2]", "header, offset 60: 'shape' is not a tuple");
	expect("(2, 2)", "(2, -2)", "header, offset 64: 'shape' is not a tuple of whole numbers");
	expect("(2, 2)", "(99999999999999999999999,)", "header, offset 80: 'shape' is too large");
	expect("(2, 2)", "(4294967296,4294967296)", "header, offset 82: 'shape' is too large");
	expect("(2, 2)", "(1,1,1,1,1,1,1,1,1)", "header, offset 77: 'shape' has more than 8 dimensions");
	expect("(2, 2)", "(2, 3)", "offset 128: 16 bytes of data, the shape has 6 values of 4");
	expect("'descr'", "'other'",
		"header, offset 19: a key other than 'descr', 'fortran_order' and 'shape'");
	expect("'descr'", "descr", "header, offset 11: not a key and a colon");
	expect("{", "(", "header, offset 10: not a dict");
	expect("}", "} 1", "header, offset 70: something follows the dict");
	expect("}", " ", "header, offset 128: not a key and a colon");
	expect("'shape': (2, 2), ", "", "header, offset 128: 'descr', 'fortran_order' or 'shape' is missing");
	expect("False,", "False", "header, offset 50: not a comma or a closing brace");

	char other[MATRIX_BYTES];
	memcpy(other, matrix, MATRIX_BYTES);
	other[6] = 3;
	put(other, MATRIX_BYTES);
	CHECK(npy_open(&a, path, &e) && strstr(e.message, ": offset 6: version 3.0, expected 1.0 or 2.0"),
		"%s", e.message);
	npy_close(&a);
	for (size_t len = 0; len < MATRIX_BYTES; len++) {
		put(matrix, len);
		const char *expected = len < 10	    ? "not a .npy file"
				       : len < DATA ? "ends inside the header"
						    : "bytes of data, the shape has 4 values of 4";
		e = (struct err){0};
		CHECK(npy_open(&a, path, &e) && e.code == ERR_FORMAT && strstr(e.message, expected),
			"cut at %zu: %s", len, e.message);
		npy_close(&a);
	}
	/* version 2.0 has a longer length */
	char two[MATRIX_BYTES + 2];
	memcpy(two, matrix, 10);
	two[6] = 2;
	two[10] = two[11] = 0;
	memcpy(two + 12, matrix + 10, MATRIX_BYTES - 10);
	put(two, sizeof two);
	CHECK(!npy_open(&a, path, &e) && a.count == 4 && npy_value(&a, 2) == 0.5, "%s", e.message);
	npy_close(&a);
}

/* One value of a type, as numpy.save writes it. */
static void check_type(const char *descr, const char *data, size_t size, double value)
{
	char bytes[DATA + 8], header[DATA];
	struct npy a;
	struct err e = {0};
	float single;

	memset(bytes, ' ', DATA);
	memcpy(bytes, matrix, 10);
	const int used = snprintf(
		header, sizeof header, "{'descr': '%s', 'fortran_order': False, 'shape': (1, 1), }", descr);
	memcpy(bytes + 10, header, (size_t)used);
	memcpy(bytes + DATA, data, size);
	put(bytes, DATA + size);
	if (!CHECK(!npy_open(&a, path, &e), "%s: %s", descr, e.message))
		return;
	npy_floats(&a, 0, 1, &single);
	CHECK(a.dims == 2 && a.count == 1 && fabs(npy_value(&a, 0) - value) <= 0 &&
			fabs((double)single - value) <= fabs(value) * 1e-7,
		"%s: %g, not %g", descr, npy_value(&a, 0), value);
	npy_close(&a);
}

static void test_types(void)
{
	struct npy a;
	struct err e = {0};

	check_type("<f2", "\x00\xbe", 2, -1.5);
	check_type("<f4", "\x00\x00\xc0\xbf", 4, -1.5);
	check_type("<f8", "\x00\x00\x00\x00\x00\x00\xf8\xbf", 8, -1.5);
	check_type("|u1", "\xfe", 1, 254);
	check_type("|i1", "\xfe", 1, -2);
	check_type("<u2", "\xfe\xff", 2, 65534);
	check_type("<i2", "\xfe\xff", 2, -2);
	check_type("<u4", "\xfe\xff\xff\xff", 4, 4294967294);
	check_type("<i4", "\xfe\xff\xff\xff", 4, -2);
	check_type("<i8", "\xfe\xff\xff\xff\xff\xff\xff\xff", 8, -2);
	for (int k = 0; k < 3; k++) {
		static const char *const others[] = {"<c8", ">f4", "|b1"};
		char bytes[MATRIX_BYTES];
		memcpy(bytes, matrix, MATRIX_BYTES);
		memcpy(strstr(bytes + 10, "<f4"), others[k], 3);
		put(bytes, MATRIX_BYTES);
		CHECK(npy_open(&a, path, &e) && e.code == ERR_FORMAT &&
				strstr(e.message,
					"header, offset 20: 'descr' is no float or whole number, little-endian"),
			"%s: %s", others[k], e.message);
		npy_close(&a);
	}
}

int main(void)
{
	int fd = mkstemp(path);

	if (fd < 0)
		return 1;
	close(fd);
	test_round_trip();
	test_errors();
	test_types();
	unlink(path);
	return unit_end();
}
