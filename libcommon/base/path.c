#define _XOPEN_SOURCE 700 /* realpath; NOLINT(bugprone-reserved-identifier) */
#include "base/path.h"

#include "base/file.h"
#include "base/mem.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINKS = 40 }; /* followed at most, as Linux does */

/* realpath(3) of the folder that holds target. */
static char *real_folder(const char *target, struct err *e)
{
	SCOPED char *folder = file_dir(target, e);
	char *real = folder ? realpath(folder, NULL) : NULL;

	if (folder && !real)
		err_errno(e, "%s", folder);
	return real;
}

/* From one absolute folder to a file in another: up from what they do not share, then down. */
static char *relative(const char *from, const char *folder, const char *name, struct err *e)
{
	size_t ups = 0;

	for (;;) { /* drops the first part of both while it is the same */
		from += strspn(from, "/");
		folder += strspn(folder, "/");
		size_t a = strcspn(from, "/"), b = strcspn(folder, "/");
		if (!a || a != b || strncmp(from, folder, a))
			break;
		from += a;
		folder += b;
	}
	for (const char *p = from; *p; p += strcspn(p, "/"), p += strspn(p, "/"))
		ups++;
	size_t bytes = 3 * ups + strlen(folder) + strlen(name) + 2;
	char *out = mem_alloc(bytes, 1, "path", e), *p = out;
	if (!out)
		return NULL;
	for (; ups; ups--)
		p += snprintf(p, 4, "../");
	snprintf(p, bytes - (size_t)(p - out), "%s%s%s", folder, *folder ? "/" : "", name);
	return out;
}

char *path_relative(const char *dir, const char *target, struct err *e)
{
	const char *slash = strrchr(target, '/');
	SCOPED char *from = realpath(dir, NULL);

	if (!from) {
		err_errno(e, "%s", dir);
		return NULL;
	}
	SCOPED char *folder = real_folder(target, e);
	return folder ? relative(from, folder, slash ? slash + 1 : target, e) : NULL;
}

char *path_alike(const char *dir, const char *name, struct err *e)
{
	const size_t n = strcspn(name, "/"), rest = n + strspn(name + n, "/");
	char *path = file_join(dir, name, "", e);
	DIR *listed = path && !file_exists(path) && n ? opendir(dir) : NULL;
	SCOPED char *found = NULL;
	size_t count = 0;

	for (struct dirent *d = listed ? readdir(listed) : NULL; d; d = readdir(listed))
		if (strlen(d->d_name) == n && !strncasecmp(d->d_name, name, n)) {
			free(found);
			found = count++ ? NULL : file_join(dir, d->d_name, "", e);
		}
	if (listed)
		closedir(listed);
	if (!found)
		return path;
	free(path);
	return name[rest] ? path_alike(found, name + rest, e) : mem_strdup(found, e);
}

const char *path_last(const char *path, int *length)
{
	size_t end = strlen(path);

	while (end > 1 && path[end - 1] == '/')
		end--;
	size_t first = end;
	while (first && path[first - 1] != '/')
		first--;
	*length = (int)(end - first);
	return path + first;
}

/* What a symbolic link's text means, seen from the link's folder. */
static char *from_link(const char *link, const char *text, struct err *e)
{
	SCOPED char *folder = file_dir(link, e);

	return folder ? file_join(folder, text, "", e) : NULL;
}

char *path_follow(const char *path, struct err *e)
{
	char *at = mem_strdup(path, e), text[PATH_MAX];

	for (int i = 0; at && i <= LINKS; i++) {
		ssize_t length = readlink(at, text, sizeof text - 1);
		if (length < 0)
			return at;
		text[length] = 0;
		char *next = from_link(at, text, e);
		free(at);
		at = next;
	}
	if (!at)
		return NULL;
	free(at);
	errno = ELOOP;
	err_errno(e, "%s", path);
	return NULL;
}

/* A file or folder: the deepest folder of its path that exists, or itself, and the rest of the path. */
struct place {
	struct stat st;
	char *path; /* owned */
	const char *rest;
};

/* Where the last part of path[0..end) begins. */
static size_t cut_last(const char *path, size_t end)
{
	while (end && path[end - 1] == '/')
		end--;
	while (end && path[end - 1] != '/')
		end--;
	return end;
}

static int find_place(struct place *p, const char *path, struct err *e)
{
	p->path = stat(path, &p->st) ? path_follow(path, e) : mem_strdup(path, e);
	SCOPED char *found = p->path ? mem_strdup(p->path, e) : NULL;
	if (!found) {
		free(p->path);
		return -1;
	}
	size_t end = strlen(found);
	while (stat(end ? found : ".", &p->st) && end) {
		end = cut_last(found, end);
		found[end] = 0;
	}
	p->rest = p->path + end;
	return 0;
}

/* The next part of a path but for '.', and its length, which is 0 at the end. */
static const char *next_part(const char *path, size_t *length)
{
	for (;; path++) {
		path += strspn(path, "/");
		*length = strcspn(path, "/");
		if (*length != 1 || *path != '.')
			return path;
	}
}

static int is_same_rest(const char *a, const char *b)
{
	for (;;) {
		size_t m, n;
		a = next_part(a, &m);
		b = next_part(b, &n);
		if (m != n || strncmp(a, b, m))
			return 0;
		if (!m)
			return 1;
		a += m;
		b += n;
	}
}

int path_is_same(const char *a, const char *b, struct err *e)
{
	struct place x, y;

	if (find_place(&x, a, e))
		return -1;
	if (find_place(&y, b, e)) {
		free(x.path);
		return -1;
	}
	const int is_same = x.st.st_dev == y.st.st_dev && x.st.st_ino == y.st.st_ino &&
			    (S_ISREG(x.st.st_mode) || S_ISDIR(x.st.st_mode)) && is_same_rest(x.rest, y.rest);
	mem_free_all(x.path, y.path);
	return is_same;
}

int path_leaves(const char *path)
{
	long depth = 0;
	size_t length;

	if (*path == '/')
		return 1;
	for (path = next_part(path, &length); length && depth >= 0; path = next_part(path + length, &length))
		depth += length == 2 && !strncmp(path, "..", 2) ? -1 : 1;
	return depth < 0;
}

int path_ends(const char *name, const char *tail)
{
	const size_t n = strlen(name), m = strlen(tail);

	return n > m && !strcasecmp(name + n - m, tail);
}
