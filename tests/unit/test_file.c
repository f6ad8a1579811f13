/* Outputs appear only whole, and messages are one line. */
#include "unit.h"

#include "base/file.h"
#include "base/mem.h"

#include <fcntl.h>
#include <glob.h>
#include <stdint.h>
#include <sys/stat.h>
#include <unistd.h>

static char dir[] = "/tmp/refersplat-test-XXXXXX";

/* The number of entries of the test's folder. */
static int entries(void)
{
	glob_t found = {0};
	char pattern[64];

	snprintf(pattern, sizeof pattern, "%s/*", dir);
	int n = glob(pattern, 0, NULL, &found) ? 0 : (int)found.gl_pathc;
	globfree(&found);
	return n;
}

static const char *in_dir(const char *name)
{
	static char path[128];

	snprintf(path, sizeof path, "%s/%s", dir, name);
	return path;
}

static int holds(const char *path, const char *text)
{
	struct err e = {0};
	char *data;
	size_t len;

	if (file_read(path, &data, &len, &e))
		return 0;
	int same = len == strlen(text) && !memcmp(data, text, len);
	free(data);
	return same;
}

static void output_appears_on_commit(void)
{
	struct file_out out;
	struct err e = {0};
	const char *path = in_dir("a");
	struct stat st;

	CHECK(!file_out_open(&out, path, &e), "%s", e.message);
	fputs("new", out.stream);
	fflush(out.stream);
	CHECK(!file_exists(path) && entries() == 1, "only the temporary file is there before commit");
	CHECK(!file_out_commit(&out, &e), "%s", e.message);
	CHECK(holds(path, "new") && entries() == 1, "only the output is there after commit");
	mode_t mask = umask(0);
	umask(mask);
	CHECK(!stat(path, &st) && (st.st_mode & 0777) == (0666 & ~mask), "mode %o", st.st_mode & 0777u);
}

static void abort_leaves_what_was(void)
{
	struct file_out out;
	struct err e = {0};
	const char *path = in_dir("a");

	CHECK(!file_out_open(&out, path, &e), "%s", e.message);
	fputs("half of someth", out.stream);
	file_out_abort(&out);
	CHECK(holds(path, "new") && entries() == 1, "the old output is still there, and nothing else");
	file_out_abort(&out);
	file_out_abort(&(struct file_out){0});
}

static void failed_write_leaves_what_was(void)
{
	struct file_out out;
	struct err e = {0};
	const char *path = in_dir("a");

	CHECK(!file_out_open(&out, path, &e), "%s", e.message);
	/* A descriptor that cannot be written to stands for a disk that is full. */
	int fd = open("/dev/null", O_RDONLY);
	dup2(fd, fileno(out.stream));
	close(fd);
	fputs("lost", out.stream);
	fflush(out.stream);
	CHECK(file_out_commit(&out, &e) < 0 && e.code == ERR_SYSTEM, "commit fails after a failed write");
	CHECK(!strstr(e.message, "Success"), "'%s' says why", e.message);
	CHECK(holds(path, "new") && entries() == 1, "the old output is still there, and nothing else");
}

/* As many at a time as there may be, and what a signal's handler does with them. */
static void many_outputs(void)
{
	struct file_out out[FILE_OUT_MOST + 1];
	struct err e = {0};
	char name[16];

	for (int round = 0; round < 2; round++) {
		for (int i = 0; i < FILE_OUT_MOST; i++) {
			snprintf(name, sizeof name, "many%d", i);
			CHECK(!file_out_open(&out[i], in_dir(name), &e), "%d: %s", i, e.message);
		}
		CHECK(file_out_open(&out[FILE_OUT_MOST], in_dir("more"), &e) && e.code == ERR_SYSTEM,
			"one more than there may be");
		CHECK(entries() == FILE_OUT_MOST, "%d entries", entries());
		if (round)
			file_out_remove_all();
		CHECK(entries() == (round ? 0 : FILE_OUT_MOST), "%d entries", entries());
		for (int i = 0; i < FILE_OUT_MOST; i++)
			file_out_abort(&out[i]);
		CHECK(entries() == 0, "%d entries", entries());
	}
	CHECK(!file_out_open(&out[0], in_dir("kept"), &e) && !file_out_commit(&out[0], &e), "%s", e.message);
	file_out_remove_all();
	CHECK(entries() == 1, "what is whole is no temporary file");
	unlink(in_dir("kept"));
}

static void devices_are_not_replaced(void)
{
	struct file_out out;
	struct err e = {0};
	struct stat st;
	const char *path = in_dir("pipe");

	CHECK(!mkfifo(path, 0600), "mkfifo");
	int reader = open(path, O_RDONLY | O_NONBLOCK);
	CHECK(!file_out_open(&out, path, &e), "%s", e.message);
	fputs("data", out.stream);
	CHECK(!file_out_commit(&out, &e), "%s", e.message);
	char got[8] = {0};
	CHECK(read(reader, got, 8) == 4 && !strcmp(got, "data"), "the pipe got '%s'", got);
	CHECK(!stat(path, &st) && S_ISFIFO(st.st_mode), "the pipe is still a pipe");
	close(reader);
	unlink(path);
}

static void folders(void)
{
	struct file_out out;
	struct err e = {0};
	char *path;

	CHECK(file_out_open(&out, dir, &e) < 0 && e.code == ERR_SYSTEM && strstr(e.message, dir), "%s",
		e.message);
	CHECK(file_out_open(&out, in_dir("none/x"), &e) < 0 && e.code == ERR_SYSTEM,
		"a missing folder is an error");
	CHECK(file_make_dir("", &e) < 0, "an empty name is refused");
	CHECK(!file_make_dir(in_dir("b/c//d/"), &e) && file_is_dir(in_dir("b/c/d")), "parents are made: %s",
		e.message);
	CHECK(!file_make_dir(in_dir("b/c"), &e), "an existing folder is fine");
	CHECK(file_make_dir(in_dir("a/x"), &e) < 0 && strstr(e.message, "Not a directory"), "%s", e.message);
	rmdir(in_dir("b/c/d"));
	rmdir(in_dir("b/c"));
	rmdir(in_dir("b"));
	path = file_join("d", "n", ".x", &e);
	CHECK(path && !strcmp(path, "d/n.x"), "%s", path);
	free(path);
	path = file_join("d", "/n", "", &e);
	CHECK(path && !strcmp(path, "/n"), "%s", path);
	free(path);
	static const char *const parts[][2] = {{"a/b", "a"}, {"a", "."}, {"/a", "/"}, {"/a/b", "/a"}};
	for (int i = 0; i < 4; i++) {
		path = file_dir(parts[i][0], &e);
		CHECK(path && !strcmp(path, parts[i][1]), "the folder of %s is not %s", parts[i][0],
			parts[i][1]);
		free(path);
	}
}

static void reading(void)
{
	struct err e = {0};
	struct file_map map;
	char *data;
	size_t len;
	FILE *out;

	CHECK(file_read(in_dir("none"), &data, &len, &e) < 0 && e.code == ERR_SYSTEM, "a missing file");
	CHECK(strstr(e.message, "/none: No such file or directory") != NULL, "%s", e.message);
	CHECK(file_read(dir, &data, &len, &e) < 0 && strstr(e.message, "Is a directory"), "%s", e.message);
	CHECK(file_map(dir, &map, &e) < 0 && strstr(e.message, "Is a directory"), "%s", e.message);
	out = fopen(in_dir("empty"), "wb");
	fclose(out);
	CHECK(!file_read(in_dir("empty"), &data, &len, &e) && len == 0 && data[0] == 0,
		"an empty file is read");
	free(data);
	CHECK(!file_map(in_dir("empty"), &map, &e) && map.len == 0, "an empty file is mapped");
	file_unmap(&map);
	unlink(in_dir("empty"));
	/* Longer than one read, and not a multiple of it. */
	enum { LONG = 200001 };
	out = fopen(in_dir("long"), "wb");
	for (int i = 0; i < LONG; i++)
		fputc(i % 251, out);
	fclose(out);
	int wrong = 0;
	CHECK(!file_read(in_dir("long"), &data, &len, &e) && len == LONG && data[LONG] == 0, "%zu bytes",
		len);
	CHECK(!file_map(in_dir("long"), &map, &e) && map.len == LONG && map.is_mapped, "%zu bytes", map.len);
	for (int i = 0; i < LONG; i++)
		wrong += (unsigned char)data[i] != i % 251 || map.data[i] != i % 251;
	CHECK(!wrong, "%d bytes are wrong", wrong);
	free(data);
	file_unmap(&map);
	unlink(in_dir("long"));
}

static void messages_are_one_line(void)
{
	struct err e = {0};
	char longest[2000];

	CHECK(err_set(&e, ERR_FORMAT, "a\nb\033c\177") == -1 && !strcmp(e.message, "a?b?c?"), "'%s'",
		e.message);
	CHECK(err_prefix(&e, "x") == -1 && !strcmp(e.message, "x: a?b?c?"), "'%s'", e.message);
	memset(longest, 'y', sizeof longest - 1);
	longest[sizeof longest - 1] = 0;
	err_set(&e, ERR_FORMAT, "%s", longest);
	CHECK(strlen(e.message) == sizeof e.message - 1, "a long message is cut at %zu", strlen(e.message));
	err_prefix(&e, "prefix");
	CHECK(!strncmp(e.message, "prefix: yyy", 11), "a prefix comes before a long message");
}

static void growing(void)
{
	struct err e = {0};
	void *block = NULL;
	size_t capacity = 0;

	CHECK(!mem_grow(&block, &capacity, 3, 4, "x", &e) && capacity >= 3, "capacity %zu", capacity);
	memcpy(block, "abcdefghijkl", 12);
	CHECK(!mem_grow(&block, &capacity, 1000, 4, "x", &e) && capacity >= 1000, "capacity %zu", capacity);
	CHECK(!memcmp(block, "abcdefghijkl", 12), "growing keeps what was there");
	CHECK(mem_grow(&block, &capacity, SIZE_MAX / 2, 4, "x", &e) < 0 && e.code == ERR_SYSTEM,
		"too many items");
	CHECK(!memcmp(block, "abcdefghijkl", 12), "and so does failing to");
	free(block);
}

int main(void)
{
	if (!mkdtemp(dir))
		return 1;
	many_outputs();
	output_appears_on_commit();
	abort_leaves_what_was();
	failed_write_leaves_what_was();
	devices_are_not_replaced();
	folders();
	reading();
	messages_are_one_line();
	growing();
	unlink(in_dir("a"));
	CHECK(!rmdir(dir), "nothing else is left in %s", dir);
	return unit_end();
}
