#include "base/file.h"

#include "base/mem.h"
#include "base/path.h"
#include "base/temporary.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <strings.h>
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

#define PAGE "a web page, not the file: download it again"
#define ANSWER "a server's message, not the file: download it again"

/* What is on disk where a file was not fetched or not unpacked: Git's pointer to it, what a server said in
 * its place, or an archive. Text is told by how it begins without blanks, in any case, others by bytes at a
 * place. */
static const struct {
	size_t at;
	const char *bytes, *what;
} stand_ins[] = {{0, "versionhttps://git-lfs.github.com/spec/",
			 "a pointer of Git LFS, not the file: 'git lfs pull' fetches it"},
	{0, "<!doctypehtml", PAGE}, {0, "<html", PAGE}, {0, "<head", PAGE}, {0, "<error>", ANSWER},
	{0, "{\"error", ANSWER}, {0, "{\"message\":", ANSWER}, {0, "{\"detail\":", ANSWER},
	{0, "404:notfound", ANSWER}, {0, "entrynotfound", ANSWER},
	{257, "ustar", "a tar archive, not the file: 'tar -xf' unpacks it"},
	{0, "7z\xbc\xaf\x27\x1c", "an archive of 7-Zip, not the file: unpack it"},
	{0, "Rar!\x1a\x07", "an archive of RAR, not the file: unpack it"},
	{1, "7zXZ", "packed by xz, not the file: 'unxz' unpacks it"},
	{4, "1AY&SY", "packed by bzip2, not the file: 'bunzip2' unpacks it"},
	{0, "\x28\xb5\x2f\xfd", "packed by Zstandard, not the file: 'unzstd' unpacks it"}};

enum { STAND_IN = 512 /* bytes that tell */ };

static int refuse_stand_in(const char *path, const void *data, size_t len, struct err *e)
{
	const char *from = data, *text;
	char begin[STAND_IN + 1];
	size_t n = 0;

	len = len < STAND_IN ? len : STAND_IN;
	for (size_t i = len >= 3 && !memcmp(from, "\xef\xbb\xbf", 3) ? 3 : 0; i < len; i++)
		if (!strchr(" \t\r\n", from[i]) || !from[i])
			begin[n++] = from[i];
	begin[n] = 0;
	text = strncmp(begin, "<?xml", 5) ? begin : begin + strcspn(begin, ">");
	text += *text == '>';
	for (size_t i = 0; i < sizeof stand_ins / sizeof *stand_ins && !path_ends(path, ".html"); i++) {
		const char *bytes = stand_ins[i].bytes;
		const size_t at = stand_ins[i].at, m = strlen(bytes);
		if ((!at && !strncasecmp(text, bytes, m)) || (len >= at + m && !memcmp(from + at, bytes, m)))
			return err_file(e, path, "%s", stand_ins[i].what);
	}
	return 0;
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
	char begin[STAND_IN];
	struct stat st;
	if (!fstat(fileno(in), &st) && S_ISREG(st.st_mode)) {
		const size_t got = fread(begin, 1, sizeof begin, in);
		rewind(in);
		if (refuse_stand_in(path, begin, got, e)) {
			fclose(in);
			return NULL;
		}
	}
	return in;
}

void file_close(FILE *in)
{
	if (in && in != stdin)
		fclose(in);
}

void file_release(FILE **in)
{
	file_close(*in);
}

int file_read(const char *path, char **data, size_t *len, struct err *e)
{
	SCOPED_BY(file_release) FILE *in = file_open(path, e);
	SCOPED void *block = NULL;
	size_t capacity = 0, used = 0;

	if (!in)
		return -1;
	for (;;) {
		if (mem_grow(&block, &capacity, used + 65536 + 1, 1, file_name(path), e))
			return -1;
		size_t got = fread((char *)block + used, 1, capacity - used - 1, in);
		used += got;
		if (!got)
			break;
	}
	if (ferror(in))
		return err_errno(e, "%s", file_name(path));
	((char *)block)[used] = 0;
	*data = block;
	*len = used;
	block = NULL;
	return 0;
}

/* What is mapped now, for file_at: entries are taken and given back by atomic operations on their state. */
enum { MAPS = 64, MAP_NAME = 1024, MAP_FREE = 0, MAP_BUSY, MAP_KNOWN };

static struct known_map {
	int state;
	const unsigned char *data;
	size_t len;
	char name[MAP_NAME];
} known_maps[MAPS];

static void know(const struct file_map *map, const char *path)
{
	for (int i = 0; i < MAPS; i++) {
		struct known_map *k = &known_maps[i];
		int is_free = MAP_FREE;
		if (!__atomic_compare_exchange_n(
			    &k->state, &is_free, MAP_BUSY, 0, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
			continue;
		k->data = map->data;
		k->len = map->len;
		snprintf(k->name, sizeof k->name, "%s", path);
		__atomic_store_n(&k->state, MAP_KNOWN, __ATOMIC_SEQ_CST);
		return;
	}
}

static void forget(const struct file_map *map)
{
	for (int i = 0; i < MAPS; i++)
		if (__atomic_load_n(&known_maps[i].state, __ATOMIC_SEQ_CST) == MAP_KNOWN &&
			known_maps[i].data == map->data)
			__atomic_store_n(&known_maps[i].state, MAP_FREE, __ATOMIC_SEQ_CST);
}

const char *file_at(const void *address)
{
	const uintptr_t at = (uintptr_t)address;

	for (int i = 0; i < MAPS; i++) {
		const struct known_map *k = &known_maps[i];
		const uintptr_t begin = (uintptr_t)k->data;
		if (__atomic_load_n(&k->state, __ATOMIC_SEQ_CST) == MAP_KNOWN && at >= begin &&
			at - begin < k->len)
			return k->name;
	}
	return NULL;
}

int file_map_part(int fd, const char *name, size_t at, size_t len, struct file_map *map, struct err *e)
{
	void *mapped = mmap(NULL, len, PROT_READ, MAP_PRIVATE, fd, (off_t)at);

	*map = (struct file_map){0};
	if (mapped == MAP_FAILED)
		return err_errno(e, "%s", name);
	*map = (struct file_map){mapped, len, 1};
	know(map, name);
	return 0;
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
	int bad = file_map_part(fd, path, 0, (size_t)st.st_size, map, e);
	close(fd);
	if (!bad && refuse_stand_in(path, map->data, map->len, e)) {
		file_unmap(map);
		bad = -1;
	}
	return bad;
}

void file_unmap(struct file_map *map)
{
	if (map->is_mapped) {
		forget(map);
		munmap((void *)(size_t)map->data, map->len);
	} else {
		free((void *)(size_t)map->data);
	}
	*map = (struct file_map){0};
}

static mode_t new_mode(void)
{
	mode_t mask;
	/* it can only be read by changing it, which another thread must not see */
#pragma omp critical(file_umask)
	{
		mask = umask(0);
		umask(mask);
	}
	return 0666 & ~mask;
}

/* Gives the file the owner, as far as that may be done, and the mode of the one that it will replace. */
static void take_mode(int fd, const struct stat *replaced)
{
	const int has_owner = replaced && (!fchown(fd, replaced->st_uid, replaced->st_gid) ||
						  !fchown(fd, (uid_t)-1, replaced->st_gid));

	(void)has_owner; /* else it is the user's own */
	fchmod(fd, replaced ? replaced->st_mode & 0777 : new_mode());
}

/* 1 where path is written to directly: a device or pipe is not replaced by a file, nor is what the system
 * shows as a link without a true target (/dev/stdout). A folder fails when it is opened, before any work. */
static int is_direct(const struct stat *st, const char *target)
{
	struct stat there;

	return !S_ISREG(st->st_mode) || stat(target, &there) || there.st_dev != st->st_dev ||
	       there.st_ino != st->st_ino;
}

int file_out_open(struct file_out *out, const char *path, struct err *e)
{
	struct stat st;
	int fd = -1;

	*out = (struct file_out){0};
	out->path = mem_strdup(path, e);
	if (!out->path)
		return -1;
	if (is_standard(path)) {
		out->stream = stdout;
		return 0;
	}
	out->target = path_follow(path, e);
	if (!out->target)
		goto fail;
	const int is_there = !stat(path, &st);
	if (is_there && is_direct(&st, out->target)) {
		out->stream = fopen(path, "wb");
	} else {
		fd = temporary_make(&out->temporary, out->target, path, e);
		if (fd < 0)
			goto fail;
		take_mode(fd, is_there ? &st : NULL);
		out->stream = fdopen(fd, "wb");
	}
	if (out->stream)
		return 0;
	err_errno(e, "%s", path);
	if (fd >= 0)
		close(fd);
fail:
	file_out_abort(out);
	return -1;
}

/* errno of a failed write: of the last one, or where that is forgotten, of another try. */
static void find_why(const struct file_out *out)
{
	if (!errno && ferror(out->stream)) {
		clearerr(out->stream);
		if (putc(0, out->stream) != EOF)
			fflush(out->stream);
	}
	if (!errno)
		errno = EIO;
}

int file_out_commit(struct file_out *out, struct err *e)
{
	const char *name = is_standard(out->path) ? "stdout" : out->path;
	int bad = 0;

	errno = 0;
	if (fflush(out->stream) || ferror(out->stream) || (out->temporary && fsync(fileno(out->stream)))) {
		find_why(out);
		bad = err_errno(e, "%s", name);
	}
	/* Before it is closed: its lock ends with that, and it would be a leftover. */
	if (out->temporary && !bad && temporary_rename(out->temporary, out->target))
		bad = err_errno(e, "%s", name);
	temporary_end(out->temporary);
	if (out->stream != stdout && fclose(out->stream) && !bad)
		bad = err_errno(e, "%s", name);
	mem_free_all(out->path, out->target);
	*out = (struct file_out){0};
	return bad;
}

void file_out_abort(struct file_out *out)
{
	temporary_end(out->temporary);
	if (out->stream && out->stream != stdout)
		fclose(out->stream);
	mem_free_all(out->path, out->target);
	*out = (struct file_out){0};
}

int file_out_end(struct file_out *out, int bad, struct err *e)
{
	if (!bad || (out->stream && ferror(out->stream)))
		return file_out_commit(out, e);
	file_out_abort(out);
	return -1;
}

int file_out_put(const char *path, void (*put)(FILE *out, const void *what), const void *what, struct err *e)
{
	struct file_out out;

	if (file_out_open(&out, path, e))
		return -1;
	put(out.stream, what);
	return file_out_end(&out, 0, e);
}

/* A pipe that is opened and closed again would end for its reader. */
static int is_no_file(const char *path)
{
	struct stat st;

	return is_standard(path) || (!stat(path, &st) && !S_ISREG(st.st_mode) && !S_ISDIR(st.st_mode));
}

int file_out_probe(const char *path, struct err *e)
{
	SCOPED_BY(file_out_abort) struct file_out out = {0};

	if (is_no_file(path))
		return 0;
	return file_out_open(&out, path, e) ? -1 : 0;
}

int file_out_claim(struct file_out *out, const char *path, struct err *e)
{
	*out = (struct file_out){0};
	if (is_no_file(path))
		return 0;
	if (file_out_open(out, path, e))
		return -1;
	if (!out->temporary || !temporary_is_shared(out->temporary))
		return 0;
	file_out_abort(out);
	return err_set(e, ERR_SYSTEM, "%s: another run is writing it", path);
}

int file_make_dir(const char *path, struct err *e)
{
	SCOPED char *copy = mem_strdup(path, e);

	if (!copy)
		return -1;
	if (!*copy)
		return err_set(e, ERR_SYSTEM, "the name of a folder is empty");
	for (char *p = copy + 1;; p++) {
		char c = *p;
		if (c != '/' && c)
			continue;
		*p = 0;
		if (mkdir(copy, 0777) && (errno != EEXIST || !file_is_dir(copy))) {
			errno = errno == EEXIST ? ENOTDIR : errno;
			return err_errno(e, "%s", copy);
		}
		*p = c;
		if (!c)
			break;
	}
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

int file_is_pipe(const char *path)
{
	struct stat st;

	return !is_standard(path) && !stat(path, &st) && S_ISFIFO(st.st_mode);
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

char *file_find(const char *dir, const char *name, struct err *e)
{
	char *path = file_join(dir, name, "", e);

	if (!path || file_exists(path))
		return path;
	free(path);
	return NULL;
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
