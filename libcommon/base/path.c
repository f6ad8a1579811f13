#define _XOPEN_SOURCE 700 /* realpath; NOLINT(bugprone-reserved-identifier) */
#include "base/path.h"

#include "base/file.h"
#include "base/mem.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* realpath(3) of the folder that holds target. */
static char *real_folder(const char *target, struct err *e)
{
	char *folder = file_dir(target, e), *real = folder ? realpath(folder, NULL) : NULL;

	if (folder && !real)
		err_errno(e, "%s", folder);
	free(folder);
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
	char *from = realpath(dir, NULL), *folder, *out = NULL;

	if (!from) {
		err_errno(e, "%s", dir);
		return NULL;
	}
	folder = real_folder(target, e);
	if (folder)
		out = relative(from, folder, slash ? slash + 1 : target, e);
	free(from);
	free(folder);
	return out;
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
