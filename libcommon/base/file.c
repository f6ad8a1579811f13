#include "base/file.h"

#include "base/mem.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static int is_standard(const char *path)
{
	return !strcmp(path, "-");
}

const char *file_name(const char *path)
{
	return is_standard(path) ? "stdin" : path;
}

FILE *file_open(const char *path, struct err *e)
{
	if (is_standard(path))
		return stdin;
	FILE *in = fopen(path, "rb");
	if (!in) {
		err_errno(e, "%s", path);
		return NULL;
	}
	if (file_is_dir(path)) {
		fclose(in);
		errno = EISDIR;
		err_errno(e, "%s", path);
		return NULL;
	}
	return in;
}

void file_close(FILE *in)
{
	if (in && in != stdin)
		fclose(in);
}

int file_read(const char *path, char **data, size_t *len, struct err *e)
{
	FILE *in = file_open(path, e);
	void *block = NULL;
	size_t capacity = 0, used = 0;

	if (!in)
		return -1;
	for (;;) {
		if (mem_grow(&block, &capacity, used + 65536 + 1, 1, file_name(path), e))
			goto fail;
		size_t got = fread((char *)block + used, 1, capacity - used - 1, in);
		used += got;
		if (!got)
			break;
	}
	if (ferror(in)) {
		err_errno(e, "%s", file_name(path));
		goto fail;
	}
	file_close(in);
	((char *)block)[used] = 0;
	*data = block;
	*len = used;
	return 0;
fail:
	file_close(in);
	free(block);
	return -1;
}

int file_map(const char *path, struct file_map *map, struct err *e)
{
	struct stat st;
	int fd;

	*map = (struct file_map){0};
	if (is_standard(path) || (!stat(path, &st) && !S_ISREG(st.st_mode)) ||
		(!stat(path, &st) && !st.st_size)) {
		char *data;
		if (file_read(path, &data, &map->len, e))
			return -1;
		map->data = (unsigned char *)data;
		return 0;
	}
	fd = open(path, O_RDONLY);
	if (fd < 0)
		return err_errno(e, "%s", path);
	if (fstat(fd, &st)) {
		err_errno(e, "%s", path);
		close(fd);
		return -1;
	}
	void *mapped = mmap(NULL, (size_t)st.st_size, PROT_READ, MAP_PRIVATE, fd, 0);
	if (mapped == MAP_FAILED) {
		err_errno(e, "%s", path);
		close(fd);
		return -1;
	}
	close(fd);
	map->data = mapped;
	map->len = (size_t)st.st_size;
	map->is_mapped = 1;
	return 0;
}

void file_unmap(struct file_map *map)
{
	if (map->is_mapped)
		munmap((void *)(size_t)map->data, map->len);
	else
		free((void *)(size_t)map->data);
	*map = (struct file_map){0};
}

/* The temporary files there are. The names stay where they are for good, so that a signal's handler can read
 * them at any time, on any thread. */
static struct {
	int state; /* by atomic operations only */
	char name[PATH_MAX];
} temporaries[FILE_OUT_MOST];

enum { FREE, TAKEN, NAMED };

/* Makes a temporary file beside path. Its name is known here before mkstemp fills it in and makes the file,
 * so that there is no moment at which a signal would leave it. Returns the descriptor or -1 with *e. */
static int make_temporary(struct file_out *out, const char *path, struct err *e)
{
	for (int i = 0; i < FILE_OUT_MOST; i++) {
		int free_now = FREE;
		char *name = temporaries[i].name;
		if (!__atomic_compare_exchange_n(
			    &temporaries[i].state, &free_now, TAKEN, 0, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
			continue;
		if (snprintf(name, PATH_MAX, "%s.tmp.XXXXXX", path) >= PATH_MAX) {
			__atomic_store_n(&temporaries[i].state, FREE, __ATOMIC_SEQ_CST);
			errno = ENAMETOOLONG;
			return err_errno(e, "%s", path);
		}
		__atomic_store_n(&temporaries[i].state, NAMED, __ATOMIC_SEQ_CST);
		int fd = mkstemp(name);
		if (fd < 0) {
			err_errno(e, "%s", path);
			__atomic_store_n(&temporaries[i].state, FREE, __ATOMIC_SEQ_CST);
		} else {
			out->temporary = name;
		}
		return fd;
	}
	return err_set(e, ERR_SYSTEM, "%s: more than %d outputs at a time", path, FILE_OUT_MOST);
}

/* The temporary file is there no more. */
static void forget_temporary(struct file_out *out)
{
	for (int i = 0; i < FILE_OUT_MOST; i++)
		if (out->temporary == temporaries[i].name)
			__atomic_store_n(&temporaries[i].state, FREE, __ATOMIC_SEQ_CST);
	out->temporary = NULL;
}

void file_out_remove_all(void)
{
	for (int i = 0; i < FILE_OUT_MOST; i++)
		if (__atomic_load_n(&temporaries[i].state, __ATOMIC_SEQ_CST) == NAMED)
			unlink(temporaries[i].name);
}

int file_out_open(struct file_out *out, const char *path, struct err *e)
{
	*out = (struct file_out){0};
	out->path = mem_strdup(path, e);
	if (!out->path)
		return -1;
	if (is_standard(path)) {
		out->stream = stdout;
		return 0;
	}
	struct stat st;
	if (!stat(path, &st) && !S_ISREG(st.st_mode)) {
		/* A device or pipe is written to, not replaced by a file; a folder fails here, before any
		 * work. */
		out->stream = fopen(path, "wb");
		if (out->stream)
			return 0;
		err_errno(e, "%s", path);
		goto fail;
	}
	int fd = make_temporary(out, path, e);
	if (fd < 0)
		goto fail;
	mode_t mask;
	/* it can only be read by changing it, which another thread must not see */
#pragma omp critical(file_umask)
	{
		mask = umask(0);
		umask(mask);
	}
	fchmod(fd, 0666 & ~mask);
	out->stream = fdopen(fd, "wb");
	if (!out->stream) {
		err_errno(e, "%s", path);
		close(fd);
		goto fail;
	}
	return 0;
fail:
	file_out_abort(out);
	return -1;
}

int file_out_commit(struct file_out *out, struct err *e)
{
	const char *name = is_standard(out->path) ? "stdout" : out->path;
	int bad = 0;

	errno = 0;
	if (fflush(out->stream) || ferror(out->stream) || (out->temporary && fsync(fileno(out->stream)))) {
		if (!errno) /* an earlier write failed, and why is forgotten */
			errno = EIO;
		bad = err_errno(e, "%s", name);
	}
	if (out->stream != stdout && fclose(out->stream) && !bad)
		bad = err_errno(e, "%s", name);
	if (out->temporary) {
		if (!bad && rename(out->temporary, out->path))
			bad = err_errno(e, "%s", name);
		if (bad)
			unlink(out->temporary);
		forget_temporary(out);
	}
	free(out->path);
	*out = (struct file_out){0};
	return bad;
}

void file_out_abort(struct file_out *out)
{
	if (out->stream && out->stream != stdout)
		fclose(out->stream);
	if (out->temporary) {
		unlink(out->temporary);
		forget_temporary(out);
	}
	free(out->path);
	*out = (struct file_out){0};
}

int file_out_probe(const char *path, struct err *e)
{
	struct file_out out;
	struct stat st;

	/* A pipe that is opened and closed again would end for its reader. */
	if (is_standard(path) || (!stat(path, &st) && !S_ISREG(st.st_mode) && !S_ISDIR(st.st_mode)))
		return 0;
	if (file_out_open(&out, path, e))
		return -1;
	file_out_abort(&out);
	return 0;
}

int file_make_dir(const char *path, struct err *e)
{
	char *copy = mem_strdup(path, e);

	if (!copy)
		return -1;
	if (!*copy) {
		free(copy);
		return err_set(e, ERR_SYSTEM, "the name of a folder is empty");
	}
	for (char *p = copy + 1;; p++) {
		char c = *p;
		if (c != '/' && c)
			continue;
		*p = 0;
		if (mkdir(copy, 0777) && (errno != EEXIST || !file_is_dir(copy))) {
			errno = errno == EEXIST ? ENOTDIR : errno;
			err_errno(e, "%s", copy);
			free(copy);
			return -1;
		}
		*p = c;
		if (!c)
			break;
	}
	free(copy);
	return 0;
}

int file_exists(const char *path)
{
	struct stat st;

	return !stat(path, &st);
}

int file_is_dir(const char *path)
{
	struct stat st;

	return !stat(path, &st) && S_ISDIR(st.st_mode);
}

char *file_join(const char *dir, const char *name, const char *suffix, struct err *e)
{
	size_t bytes = strlen(dir) + strlen(name) + strlen(suffix) + 2;
	char *path = mem_alloc(bytes, 1, "path", e);

	if (!path)
		return NULL;
	if (name[0] == '/')
		snprintf(path, bytes, "%s%s", name, suffix);
	else
		snprintf(path, bytes, "%s/%s%s", dir, name, suffix);
	return path;
}

char *file_dir(const char *path, struct err *e)
{
	char *copy = mem_strdup(path, e);

	if (!copy)
		return NULL;
	char *slash = strrchr(copy, '/');
	if (!slash) {
		free(copy);
		return mem_strdup(".", e);
	}
	slash[slash == copy] = 0;
	return copy;
}
