#include "formats/arrays/npz.h"

#include "base/mem.h"

#include <stdio.h>

int npz_open(struct npz *z, const char *path, struct err *e)
{
	struct file_map map;

	*z = (struct npz){.path = mem_strdup(path, e)};
	return -(!z->path || file_map(path, &map, e) || archive_open_zip(&z->zip, z->path, &map, e));
}

void npz_close(struct npz *z)
{
	archive_close(&z->zip);
	free(z->path);
	*z = (struct npz){0};
}

/* The place of "NAMESUFFIX.npy", or NAMES_NONE; -1 where memory is out. */
static int find(const struct npz *z, const char *name, const char *suffix, size_t *place, struct err *e)
{
	const size_t room = strlen(name) + strlen(suffix) + sizeof ".npy";
	SCOPED char *file = mem_alloc(room, 1, "array", e);

	if (!file)
		return -1;
	snprintf(file, room, "%s%s.npy", name, suffix);
	*place = names_find(&z->zip.index, file);
	return 0;
}

int npz_has(const struct npz *z, const char *name, const char *suffix, struct err *e)
{
	size_t place;

	return find(z, name, suffix, &place, e) ? -1 : place != NAMES_NONE;
}

int npz_entry(const struct npz *z, size_t place, struct npy *a, char **called, struct err *e)
{
	const char *file = z->zip.entries[place].name;
	const size_t room = strlen(z->path) + strlen(file) + sizeof ": ";
	char *full = mem_alloc(room, 1, "array", e), *data = NULL;
	size_t len = 0;

	if (full)
		snprintf(full, room, "%s: %s", z->path, file);
	const int bad = !full || archive_read_entry(&z->zip, place, &data, &len, e) ||
			npy_open_bytes(a, data, len, full, e);
	if (bad || !called)
		free(full);
	else
		*called = full;
	return bad ? -1 : 0;
}

int npz_array(const struct npz *z, const char *name, const char *suffix, struct npy *a, char **called,
	struct err *e)
{
	size_t place;

	if (find(z, name, suffix, &place, e))
		return -1;
	if (place == NAMES_NONE)
		return err_file(e, z->path, "%s%s.npy: is not there", name, suffix);
	return npz_entry(z, place, a, called, e);
}

const char *npz_main(const struct npz *z, const char *const names[2], struct err *e)
{
	for (int i = 0; i < 2; i++) {
		const int has = npz_has(z, names[i], "", e);
		if (has)
			return has > 0 ? names[i] : NULL;
	}
	err_file(e, z->path, "has no array '%s' or '%s'", names[0], names[1]);
	return NULL;
}

int npz_open_main(const char *path, const char *const names[2], struct npy *a, char **called, struct err *e)
{
	SCOPED_BY(npz_close) struct npz z = {0};

	if (npz_open(&z, path, e))
		return -1;
	const char *name = npz_main(&z, names, e);
	return name ? npz_array(&z, name, "", a, called, e) : -1;
}
