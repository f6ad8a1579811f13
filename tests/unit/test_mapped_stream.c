#include "unit.h"

#include "base/mapped_stream.h"

#include <unistd.h>

enum { BYTES = 10000 };

static char buffer[MAPPED_STREAM_BUFFER];

/* A file of BYTES bytes, every 37th the end of a line, and some of them 0. */
static FILE *make_file(int bytes)
{
	FILE *f = tmpfile();

	for (int i = 0; f && i < bytes; i++)
		putc(i % 37 == 36 ? '\n' : i % 101, f);
	if (f)
		rewind(f);
	return f;
}

static void reads_as_a_file_does(void)
{
	FILE *plain = make_file(BYTES), *mapped = make_file(BYTES), *const before = mapped;

	mapped_stream_take(&mapped, buffer);
	CHECK(mapped != before, "is another stream");
	CHECK(!fseek(mapped, 0, SEEK_END) && ftell(mapped) == BYTES, "ends at %ld", ftell(mapped));
	CHECK(getc(mapped) == EOF, "nothing after the end");
	for (long at = BYTES - 1, step = 0; at >= 0; at -= step, step = (step * 7 + 1) % 700) {
		char a[64] = {0}, b[64] = {0};
		fseek(plain, at, SEEK_SET);
		fseek(mapped, at, SEEK_SET);
		const size_t n = fread(a, 1, sizeof a, plain), m = fread(b, 1, sizeof b, mapped);
		CHECK(n == m && !memcmp(a, b, sizeof a) && ftell(plain) == ftell(mapped), "at %ld", at);
		if (!step)
			step = 1;
	}
	fclose(plain);
	fclose(mapped);
}

static void stays_where_it_cannot_be_mapped(void)
{
	FILE *none = NULL, *empty = make_file(0), *const was_empty = empty;
	int ends[2];

	mapped_stream_take(&none, buffer);
	CHECK(!none, "no stream");
	mapped_stream_take(&empty, buffer);
	CHECK(empty == was_empty && getc(empty) == EOF, "an empty file");
	fclose(empty);
	if (!CHECK(!pipe(ends), "a pipe"))
		return;
	FILE *in = fdopen(ends[0], "r"), *const was_in = in;
	CHECK(write(ends[1], "x", 1) == 1, "written");
	close(ends[1]);
	mapped_stream_take(&in, buffer);
	CHECK(in == was_in && getc(in) == 'x', "a pipe is read as before");
	fclose(in);
}

int main(void)
{
	reads_as_a_file_does();
	stays_where_it_cannot_be_mapped();
	return unit_end();
}
