#include "formats/arrays/npz.h"

#include "base/mem.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int npz_open(struct npz *z, const char *path, struct err *e)
{
	struct file_map map;

	*z = (struct npz){0};
	if (!(z->path = mem_strdup(path, e)) || file_map(path, &map, e)) {
		free(z->path);
		return -1;
	}
	if (archive_open_zip(&z->zip, z->path, &map, e)) {
		free(z->path);
		return -1;
	}
	if (!archive_list(&z->zip, &z->entries, &z->n, e) &&
		!names_make(&z->index, z->entries, sizeof *z->entries, offsetof(struct archive_entry, name),
			z->n, e))
		return 0;
	npz_close(z);
	return -1;
}

void npz_close(struct npz *z)
{
	names_free(&z->index);
	archive_free_entries(z->entries, z->n);
	archive_close(&z->zip);
	free(z->path);
	*z = (struct npz){0};
}

/* "NAMESUFFIX.npy", after the archive's path if there is one. */
static char *join(const char *path, const char *name, const char *suffix, struct err *e)
{
	const size_t room = strlen(path) + strlen(name) + strlen(suffix) + sizeof ": .npy";
	char *out = mem_alloc(room, 1, "array", e);

	if (out)
		snprintf(out, room, "%s%s%s%s.npy", path, *path ? ": " : "", name, suffix);
	return out;
}

/* Its place, or NAMES_NONE; -1 where memory is out. */
static int find(const struct npz *z, const char *name, const char *suffix, size_t *place, struct err *e)
{
	char *file = join("", name, suffix, e);

	if (file)
		*place = names_find(&z->index, file);
	free(file);
	return file ? 0 : -1;
}

int npz_has(const struct npz *z, const char *name, const char *suffix, struct err *e)
{
	size_t place;

	return find(z, name, suffix, &place, e) ? -1 : place != NAMES_NONE;
}

/* Messages call it `full`. */
static int read_entry(struct npz *z, size_t place, struct npy *a, const char *full, struct err *e)
{
	char *data = NULL;
	size_t len = 0;

	return -(archive_read_entry(&z->zip, &z->entries[place], &data, &len, e) ||
		 npy_open_bytes(a, data, len, full, e));
}

int npz_entry(struct npz *z, size_t place, struct npy *a, struct err *e)
{
	const char *file = z->entries[place].name;
	const size_t room = strlen(z->path) + strlen(file) + sizeof ": ";
	char *full = mem_alloc(room, 1, "array", e);

	if (!full)
		return -1;
	snprintf(full, room, "%s: %s", z->path, file);
	const int bad = read_entry(z, place, a, full, e);
	free(full);
	return bad;
}

int npz_array(
	struct npz *z, const char *name, const char *suffix, struct npy *a, char **called, struct err *e)
{
	char *full = join(z->path, name, suffix, e);
	size_t place = 0;
	int bad = !full || find(z, name, suffix, &place, e);
	if (!bad && place == NAMES_NONE)
		bad = err_file(e, full, "is not there");
	bad = bad || read_entry(z, place, a, full, e);
	if (bad || !called)
		free(full);
	else
		*called = full;
	return bad ? -1 : 0;
}

const char *npz_main(const struct npz *z, const char *const *names, size_t n, struct err *e)
{
	for (size_t i = 0; i < n; i++) {
		const int has = npz_has(z, names[i], "", e);
		if (has)
			return has > 0 ? names[i] : NULL;
	}
	err_file(e, z->path, "has no array '%s' or '%s'", names[0], names[n - 1]);
	return NULL;
}
