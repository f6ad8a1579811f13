/* minizip reads zips through streams: here from memory. */
#include "formats/arrays/archive.h"

#include "base/mem.h"

#include <minizip/unzip.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a byte of deflate can become at most. */
enum { DEFLATE_RATIO = 1032 };

static voidpf zip_open(voidpf archive, const void *name, int mode)
{
	const struct archive *a = archive;

	(void)name;
	(void)mode;
	return fmemopen((void *)(size_t)a->map.data, a->map.len, "rb");
}

int archive_open_zip(struct archive *a, const char *name, struct file_map *map, struct err *e)
{
	zlib_filefunc64_def functions;

	fill_fopen64_filefunc(&functions);
	functions.zopen64_file = zip_open;
	functions.opaque = a;
	*a = (struct archive){.name = name, .map = *map};
	*map = (struct file_map){0};
	a->zip = unzOpen2_64(name, &functions);
	if (a->zip)
		return 0;
	archive_close(a);
	return err_file(e, name, "not a zip, or its end is missing");
}

void archive_open_folder(struct archive *a, const char *folder)
{
	*a = (struct archive){.name = folder, .folder = folder};
}

void archive_close(struct archive *a)
{
	if (a->zip)
		unzClose(a->zip);
	file_unmap(&a->map);
	*a = (struct archive){0};
}

/* The current file of the zip. Its sizes are checked before memory is taken for it. */
static int read_current(struct archive *a, const char *file, char **data, size_t *len, struct err *e)
{
	unz_file_info64 info;
	size_t most;

	if (unzGetCurrentFileInfo64(a->zip, &info, NULL, 0, NULL, 0, NULL, 0) != UNZ_OK ||
		info.compressed_size > a->map.len ||
		mem_size((size_t)info.compressed_size, DEFLATE_RATIO, &most) || info.uncompressed_size > most)
		return err_file(e, a->name, "file '%.80s' in the zip has impossible sizes", file);
	*len = (size_t)info.uncompressed_size;
	if (unzOpenCurrentFile(a->zip) != UNZ_OK)
		return err_file(e, a->name, "file '%.80s' in the zip cannot be read", file);
	*data = mem_alloc(*len + 1, 1, file, e);
	if (!*data) {
		unzCloseCurrentFile(a->zip);
		return -1;
	}
	size_t got = 0;
	for (int some = 1; some > 0 && got<*len; got += some> 0 ? (size_t)some : 0)
		some = unzReadCurrentFile(
			a->zip, *data + got, *len - got < 1u << 30 ? (unsigned)(*len - got) : 1u << 30);
	(*data)[got] = 0;
	/* Says also whether the checksum is right. */
	if (unzCloseCurrentFile(a->zip) == UNZ_OK && got == *len)
		return 0;
	free(*data);
	*data = NULL;
	return err_file(e, a->name, "file '%.80s' in the zip is damaged", file);
}

int archive_read(struct archive *a, const char *file, char **data, size_t *len, struct err *e)
{
	*data = NULL;
	if (!*file || strchr(file, '/') || !strcmp(file, "..") || !strcmp(file, "."))
		return err_file(e, a->name, "'%.80s' is not the name of a file beside meta.json", file);
	if (a->folder) {
		char *path = file_join(a->folder, file, "", e);
		const int bad = !path || file_read(path, data, len, e);
		free(path);
		return bad ? -1 : 0;
	}
	if (unzLocateFile(a->zip, file, 1) != UNZ_OK)
		return err_file(e, a->name, "no file '%.80s' in the zip", file);
	return read_current(a, file, data, len, e);
}

enum { NAME_ROOM = 4096 }; /* longer names are of no file of ours */

static int add_entry(
	struct archive *a, struct archive_entry **entries, size_t *capacity, size_t *n, struct err *e)
{
	unz_file_info64 info;
	unz64_file_pos at;
	char name[NAME_ROOM + 1] = "";

	if (unzGetCurrentFileInfo64(a->zip, &info, name, NAME_ROOM, NULL, 0, NULL, 0) != UNZ_OK ||
		unzGetFilePos64(a->zip, &at) != UNZ_OK)
		return err_file(e, a->name, "the zip's directory is damaged");
	if (mem_grow((void **)entries, capacity, *n + 1, sizeof **entries, a->name, e))
		return -1;
	char *copy = mem_strdup(name, e);
	if (!copy)
		return -1;
	(*entries)[(*n)++] = (struct archive_entry){copy, at.pos_in_zip_directory, at.num_of_file};
	return 0;
}

int archive_list(struct archive *a, struct archive_entry **entries, size_t *n, struct err *e)
{
	size_t capacity = 0;
	int at = unzGoToFirstFile(a->zip), bad = 0;

	*entries = NULL;
	for (*n = 0; at == UNZ_OK && !bad; at = unzGoToNextFile(a->zip))
		bad = add_entry(a, entries, &capacity, n, e);
	if (!bad && at != UNZ_END_OF_LIST_OF_FILE)
		bad = err_file(e, a->name, "the zip's directory is damaged");
	if (bad) {
		archive_free_entries(*entries, *n);
		*entries = NULL;
		*n = 0;
	}
	return bad ? -1 : 0;
}

void archive_free_entries(struct archive_entry *entries, size_t n)
{
	for (size_t i = 0; i < n; i++)
		free(entries[i].name);
	free(entries);
}

int archive_read_entry(
	struct archive *a, const struct archive_entry *entry, char **data, size_t *len, struct err *e)
{
	unz64_file_pos at = {entry->place, entry->number};

	*data = NULL;
	if (unzGoToFilePos64(a->zip, &at) != UNZ_OK)
		return err_file(e, a->name, "the zip's directory is damaged");
	return read_current(a, entry->name, data, len, e);
}
