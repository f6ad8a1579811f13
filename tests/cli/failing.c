/* Preloaded into a tool by devices.bats: a device that fails with errno FAIL. FAIL_WRITE, FAIL_READ: after so
 * many bytes of each file. FAIL_CALL: fsync, rename or open, which makes a file or folder. FAIL_MAP: where a
 * mapped file is looked at. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

struct stream {
	FILE *real;
	long left;
};

static ssize_t put(void *cookie, const char *bytes, size_t n)
{
	struct stream *s = cookie;

	if ((long)n > s->left) {
		errno = atoi(getenv("FAIL"));
		return 0;
	}
	s->left -= (long)n;
	return (ssize_t)fwrite(bytes, 1, n, s->real);
}

static ssize_t get(void *cookie, char *bytes, size_t n)
{
	struct stream *s = cookie;

	if ((long)n > s->left)
		n = (size_t)s->left;
	if (!n) {
		errno = atoi(getenv("FAIL"));
		return -1;
	}
	s->left -= (long)n;
	return (ssize_t)fread(bytes, 1, n, s->real);
}

static int end(void *cookie)
{
	struct stream *s = cookie;
	const int bad = fclose(s->real);

	free(s);
	return bad;
}

/* The next function of that name, of any type. */
static void find(const char *name, void *function)
{
	void *found = dlsym(RTLD_NEXT, name);

	memcpy(function, &found, sizeof found);
}

static FILE *wrap(FILE *real, const char *mode)
{
	const char *limit = getenv(*mode == 'r' ? "FAIL_READ" : "FAIL_WRITE");

	if (!real || !limit)
		return real;
	struct stream *s = malloc(sizeof *s);
	*s = (struct stream){real, atol(limit)};
	return fopencookie(s, mode, (cookie_io_functions_t){get, put, NULL, end});
}

FILE *fopen(const char *path, const char *mode)
{
	FILE *(*real)(const char *, const char *);

	find("fopen", &real);
	/* The processor's files are no data. */
	return strncmp(path, "/proc/", 6) && strncmp(path, "/sys/", 5) ? wrap(real(path, mode), mode)
								       : real(path, mode);
}

FILE *fdopen(int fd, const char *mode)
{
	FILE *(*real)(int, const char *);

	find("fdopen", &real);
	return wrap(real(fd, mode), mode);
}

static int fails(const char *name)
{
	const char *call = getenv("FAIL_CALL");

	if (!call || strcmp(call, name))
		return 0;
	errno = atoi(getenv("FAIL"));
	return 1;
}

int fsync(int fd)
{
	int (*real)(int);

	find("fsync", &real);
	/* The streams above have no file of their own. */
	return fails("fsync") ? -1 : fd < 0 ? 0 : real(fd);
}

int rename(const char *from, const char *to)
{
	int (*real)(const char *, const char *);

	find("rename", &real);
	return fails("rename") ? -1 : real(from, to);
}

int mkdir(const char *path, mode_t mode)
{
	int (*real)(const char *, mode_t);

	find("mkdir", &real);
	return fails("open") ? -1 : real(path, mode);
}

int open(const char *path, int flags, ...)
{
	int (*real)(const char *, int, ...);
	va_list more;

	va_start(more, flags);
	const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;
	va_end(more);
	find("open", &real);
	return flags & O_CREAT && fails("open") ? -1 : real(path, flags, mode);
}

/* Of a file with no bytes. */
void *mmap(void *at, size_t n, int protection, int flags, int fd, off_t offset)
{
	void *(*real)(void *, size_t, int, int, int, off_t);

	find("mmap", &real);
	if (fd < 0 || !getenv("FAIL_MAP"))
		return real(at, n, protection, flags, fd, offset);
	const int empty = memfd_create("empty", 0);
	void *mapped = real(at, n, protection, flags, empty, offset);
	close(empty);
	return mapped;
}
