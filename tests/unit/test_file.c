/* Outputs appear only whole, and messages are one line. */
#include "unit.h"

#include "base/file.h"
#include "base/temporary.h"
#include "base/mem.h"
#include "base/path.h"

#include <fcntl.h>
#include <glob.h>
#include <omp.h>
#include <signal.h>
#include <stdint.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
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

/* As many at a time as there are threads, and more. */
static void many_outputs(void)
{
	enum { MANY = 200, THREADS = 64 };
	struct file_out out[MANY];
	char name[16];

	for (int round = 0; round < 2; round++) {
		int failed = 0;
#pragma omp parallel for num_threads(THREADS) schedule(static, 1)
		for (int i = 0; i < MANY; i++) {
			char own[128];
			struct err e = {0};
			snprintf(own, sizeof own, "%s/many%d", dir, i);
#pragma omp atomic
			failed += file_out_open(&out[i], own, &e) != 0;
		}
		CHECK(!failed && entries() == MANY, "%d failed, %d entries", failed, entries());
#pragma omp parallel for num_threads(THREADS) schedule(static, 1)
		for (int i = 0; i < MANY; i++) {
			struct err e = {0};
			if (round)
				file_out_commit(&out[i], &e);
			else
				file_out_abort(&out[i]);
		}
		CHECK(entries() == (round ? MANY : 0), "%d entries", entries());
	}
	for (int i = 0; i < MANY; i++) {
		snprintf(name, sizeof name, "many%d", i);
		unlink(in_dir(name));
	}
}

/* Runs a part of a test in a process of its own; its exit status, or minus the signal that ended it. */
static int in_child(void (*part)(void))
{
	int status = 0;
	pid_t child = fork();

	if (!child) {
		part();
		_exit(0);
	}
	CHECK(child > 0 && waitpid(child, &status, 0) == child, "fork");
	return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

static void remove_all(void)
{
	struct file_out out[20], kept;
	struct err e = {0};
	char name[16];

	if (file_out_open(&kept, in_dir("kept"), &e) || file_out_commit(&kept, &e))
		_exit(1);
	for (int i = 0; i < 20; i++) {
		snprintf(name, sizeof name, "gone%d", i);
		if (file_out_open(&out[i], in_dir(name), &e))
			_exit(1);
	}
	if (entries() != 21)
		_exit(2);
	temporary_remove_all();
}

static void be_killed(void)
{
	struct file_out out;
	struct err e = {0};

	if (file_out_open(&out, in_dir("a"), &e))
		_exit(1);
	fputs("half of someth", out.stream);
	fflush(out.stream);
	raise(SIGKILL);
}

static void leftovers(void)
{
	struct file_out out, other;
	struct err e = {0};
	const char *path = in_dir("a");

	CHECK(!in_child(remove_all) && entries() == 1, "%d entries", entries());
	unlink(in_dir("kept"));
	path = in_dir("a");
	for (int i = 0; i < 3; i++)
		CHECK(in_child(be_killed) == -SIGKILL, "killed");
	CHECK(entries() == 1, "each run removes what the one before left: %d entries", entries());
	/* A run that is alive, in this process or another, keeps its file. */
	CHECK(!file_out_open(&out, path, &e), "%s", e.message);
	CHECK(entries() == 1, "%d entries", entries());
	fputs("first", out.stream);
	fflush(out.stream);
	CHECK(in_child(be_killed) == -SIGKILL && entries() == 2, "%d entries", entries());
	CHECK(!file_out_open(&other, path, &e) && entries() == 2, "%d entries", entries());
	fputs("second", other.stream);
	CHECK(!file_out_commit(&other, &e) && holds(path, "second") && entries() == 2, "%s", e.message);
	CHECK(!file_out_commit(&out, &e) && holds(path, "first") && entries() == 1, "%s", e.message);
	unlink(path);
	/* Two runs at a time, of which the second was killed after the first ended. */
	CHECK(!file_out_open(&out, path, &e) && in_child(be_killed) == -SIGKILL, "%s", e.message);
	file_out_abort(&out);
	CHECK(entries() == 1 && !file_out_probe(path, &e) && entries() == 0, "%d entries", entries());
	/* What only looks like one. */
	static const char *const own[] = {"a.tmp", "a.tmp.abcdef", "a.tmp.refersplat", "a.tmp.refersplat0x"};
	for (int i = 0; i < 4; i++)
		fclose(fopen(in_dir(own[i]), "w"));
	CHECK(!file_out_probe(in_dir("a"), &e) && entries() == 4, "%d entries", entries());
	for (int i = 0; i < 4; i++)
		unlink(in_dir(own[i]));
}

/* Ten runs write one output again and again, and are killed in the midst of it. */
static void write_on(void)
{
	struct file_out out;
	struct err e = {0};

	for (;;)
		if (file_out_open(&out, in_dir("a"), &e) || fputs("whole", out.stream) < 0 ||
			file_out_commit(&out, &e))
			_exit(1);
}

static void runs_at_one_time(void)
{
	enum { RUNS = 6 };
	struct err e = {0};
	pid_t runs[RUNS];
	int status, failed = 0;

	for (int i = 0; i < RUNS; i++)
		if (!(runs[i] = fork()))
			write_on();
	for (int i = 0; i < RUNS; i++) {
		nanosleep(&(struct timespec){.tv_nsec = 40000000}, NULL);
		kill(runs[i], SIGKILL);
		waitpid(runs[i], &status, 0);
		failed += !WIFSIGNALED(status);
	}
	CHECK(!failed, "%d runs failed to write", failed);
	CHECK(!file_out_probe(in_dir("a"), &e) && holds(in_dir("a"), "whole") && entries() == 1, "%d entries",
		entries());
	unlink(in_dir("a"));
}

/* Outputs that are opened and ended while a signal's handler removes all. */
static void write_much(void)
{
#pragma omp parallel num_threads(8)
	for (int i = omp_get_thread_num();; i += 8) {
		struct file_out out;
		struct err e = {0};
		char path[128];
		snprintf(path, sizeof path, "%s/signal%d", dir, i % 64);
		if (i == 8 * 40 && !kill(getpid(), SIGTERM))
			continue;
		if (!file_out_open(&out, path, &e))
			file_out_commit(&out, &e);
	}
}

static void end_by_signal(int number)
{
	temporary_remove_all();
	signal(number, SIG_DFL);
	raise(number);
}

static void catch_and_write(void)
{
	signal(SIGTERM, end_by_signal);
	write_much();
}

static void signals(void)
{
	glob_t found;
	char pattern[64];

	snprintf(pattern, sizeof pattern, "%s/*.tmp.*", dir);
	for (int i = 0; i < 20; i++) {
		CHECK(in_child(catch_and_write) == -SIGTERM, "ended by the signal");
		int none = glob(pattern, 0, NULL, &found);
		CHECK(none == GLOB_NOMATCH, "%s is left", none ? "nothing" : found.gl_pathv[0]);
		if (!none)
			globfree(&found);
	}
	for (int i = 0; i < 64; i++) {
		snprintf(pattern, sizeof pattern, "signal%d", i);
		unlink(in_dir(pattern));
	}
}

static void links_and_modes(void)
{
	struct file_out out;
	struct err e = {0};
	struct stat st;
	char path[128];

	snprintf(path, sizeof path, "%s", in_dir("target"));
	CHECK(!symlink("sub/../target", in_dir("link")) && !symlink("link", in_dir("second")), "symlink");
	CHECK(!mkdir(in_dir("sub"), 0700), "mkdir");
	for (int round = 0; round < 2; round++) { /* the target is not there, then it is */
		CHECK(!file_out_open(&out, in_dir("second"), &e), "%s", e.message);
		fputs(round ? "two" : "one", out.stream);
		CHECK(!file_out_commit(&out, &e), "%s", e.message);
		CHECK(holds(path, round ? "two" : "one"), "the target was written");
		CHECK(!lstat(in_dir("link"), &st) && S_ISLNK(st.st_mode), "link is still a link");
		CHECK(!lstat(in_dir("second"), &st) && S_ISLNK(st.st_mode), "second is still a link");
	}
	static const mode_t modes[] = {0600, 0444, 0755, 0666};
	for (int i = 0; i < 4; i++) {
		CHECK(!chmod(path, modes[i]) && !file_out_open(&out, in_dir("link"), &e), "%s", e.message);
		CHECK(!file_out_commit(&out, &e), "%s", e.message);
		CHECK(!stat(path, &st) && (st.st_mode & 07777) == modes[i], "mode %o was %o",
			(unsigned)(st.st_mode & 07777), (unsigned)modes[i]);
	}
	unlink(path);
	unlink(in_dir("link"));
	CHECK(!symlink("second", in_dir("link")), "symlink");
	CHECK(file_out_open(&out, in_dir("link"), &e) < 0 && strstr(e.message, "symbolic links"), "%s",
		e.message);
	unlink(in_dir("link"));
	unlink(in_dir("second"));
	rmdir(in_dir("sub"));
}

static void same(const char *a, const char *b, int expected)
{
	struct err e = {0};
	char *x = file_join(dir, a, "", &e), *y = file_join(dir, b, "", &e);
	const int got = path_is_same(x, y, &e);

	CHECK(got == expected, "%s and %s: %d", a, b, got);
	CHECK(path_is_same(y, x, &e) == got, "%s and %s the other way round", b, a);
	free(x);
	free(y);
}

static void same_files(void)
{
	char path[128];

	snprintf(path, sizeof path, "%s", in_dir("file"));
	fclose(fopen(path, "w"));
	CHECK(!link(path, in_dir("hard")) && !symlink("file", in_dir("soft")) &&
			!symlink("absent", in_dir("dangling")) && !mkdir(in_dir("sub"), 0700) &&
			!symlink("sub", in_dir("way")) && !mkfifo(in_dir("pipe"), 0600),
		"made");
	same("file", "file", 1);
	same("file", "./file", 1);
	same("file", "sub/../file", 1);
	same("file", "hard", 1);
	same("file", "soft", 1);
	same("soft", "hard", 1);
	same("file", "dangling", 0);
	same("absent", "dangling", 1);
	same("absent", "way/../absent", 1);
	same("absent", "absent2", 0);
	same("way/absent", "sub/absent", 1);
	same("way/absent", "absent", 0);
	same("way/", "sub", 1);
	same("none/a", "none/./a", 1);
	same("none//a", "way/../none/a", 1);
	same("none/a", "none/b", 0);
	same("none/a", "none", 0);
	same("pipe", "pipe", 0);
	static const char *const made[] = {"file", "hard", "soft", "dangling", "way", "pipe"};
	for (int i = 0; i < 6; i++)
		unlink(in_dir(made[i]));
	rmdir(in_dir("sub"));
}

static void paths_that_leave(void)
{
	static const char *const inside[] = {
		"a", "a/b", "./a", "a/..", "a/../b", "a/./../b", "..a", "...", ""};
	static const char *const outside[] = {
		"/", "/a", "..", "../a", "./../a", "a/../..", "a/..//../a", "a/../../a"};

	for (size_t i = 0; i < sizeof inside / sizeof *inside; i++)
		CHECK(!path_leaves(inside[i]), "'%s' stays", inside[i]);
	for (size_t i = 0; i < sizeof outside / sizeof *outside; i++)
		CHECK(path_leaves(outside[i]), "'%s' leaves", outside[i]);
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
	/* before any thread is started: a child of fork has none */
	leftovers();
	runs_at_one_time();
	signals();
	links_and_modes();
	same_files();
	many_outputs();
	output_appears_on_commit();
	abort_leaves_what_was();
	failed_write_leaves_what_was();
	paths_that_leave();
	devices_are_not_replaced();
	folders();
	reading();
	messages_are_one_line();
	growing();
	unlink(in_dir("a"));
	CHECK(!rmdir(dir), "nothing else is left in %s", dir);
	return unit_end();
}
