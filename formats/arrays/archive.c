/* minizip reads zips through streams: here from memory. Zips are written as PKWARE's APPNOTE.TXT has them:
 * local headers with the files after them, then the central directory and its end record. Dates are the
 * format's first day, so that the same files make the same zip. */
#include "formats/arrays/archive.h"

#include "base/little.h"
#include "base/mem.h"

#include <minizip/unzip.h>
#include <zlib.h>

/* What a byte of deflate can become at most. */
enum { DEFLATE_RATIO = 1032 };

static voidpf zip_open(voidpf archive, const void *name, int mode)
{
	const struct archive *a = archive;

	(void)name;
	(void)mode;
	return fmemopen((void *)(size_t)a->map.data, a->map.len, "rb");
}

enum { NAME_ROOM = 4096 }; /* longer names are of no file of ours */

static int add_entry(struct archive *a, struct err *e)
{
	unz_file_info64 info;
	unz64_file_pos at;
	char name[NAME_ROOM + 1] = "";

	if (unzGetCurrentFileInfo64(a->zip, &info, name, NAME_ROOM, NULL, 0, NULL, 0) != UNZ_OK ||
		unzGetFilePos64(a->zip, &at) != UNZ_OK)
		return err_file(e, a->name, "the zip's directory is damaged");
	if (mem_grow((void **)&a->entries, &a->room, a->n + 1, sizeof *a->entries, a->name, e))
		return -1;
	char *copy = mem_strdup(name, e);
	if (copy)
		a->entries[a->n++] = (struct archive_entry){copy, at.pos_in_zip_directory, at.num_of_file};
	return copy ? 0 : -1;
}

static int list_entries(struct archive *a, struct err *e)
{
	int at = unzGoToFirstFile(a->zip), bad = 0;

	for (; at == UNZ_OK && !bad; at = unzGoToNextFile(a->zip))
		bad = add_entry(a, e);
	if (!bad && at != UNZ_END_OF_LIST_OF_FILE)
		bad = err_file(e, a->name, "the zip's directory is damaged");
	return bad || names_make(&a->index, a->entries, sizeof *a->entries,
			      offsetof(struct archive_entry, name), a->n, e);
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
	return a->zip ? list_entries(a, e) : err_file(e, name, "not a zip, or its end is missing");
}

void archive_open_folder(struct archive *a, const char *folder)
{
	*a = (struct archive){.name = folder, .folder = folder};
}

void archive_close(struct archive *a)
{
	if (a->zip)
		unzClose(a->zip);
	for (size_t i = 0; i < a->n; i++)
		free(a->entries[i].name);
	free(a->entries);
	names_free(&a->index);
	file_unmap(&a->map);
	*a = (struct archive){0};
}

/* The current file of the zip. Its sizes are checked before memory is taken for it. */
static int read_current(const struct archive *a, const char *file, char **data, size_t *len, struct err *e)
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
		SCOPED char *path = file_join(a->folder, file, "", e);
		return !path || file_read(path, data, len, e) ? -1 : 0;
	}
	const size_t entry = names_find(&a->index, file);
	if (entry == NAMES_NONE)
		return err_file(
			e, a->name, "no file '%.80s' in the zip: unzip it if it is a packed file", file);
	return archive_read_entry(a, entry, data, len, e);
}

int archive_read_entry(const struct archive *a, size_t entry, char **data, size_t *len, struct err *e)
{
	unz64_file_pos at = {a->entries[entry].place, a->entries[entry].number};

	*data = NULL;
	if (unzGoToFilePos64(a->zip, &at) != UNZ_OK)
		return err_file(e, a->name, "the zip's directory is damaged");
	return read_current(a, a->entries[entry].name, data, len, e);
}

enum { ZIP_VERSION = 20, FIRST_DAY = 1 << 5 | 1, LOCAL = 30, CENTRAL = 46, END = 22 };

void zip_write_start(struct zip_write *z, FILE *out, const char *path)
{
	*z = (struct zip_write){.out = out, .path = path};
}

/* What both headers of a file have from its version to its name's length. */
static unsigned char *put_common(unsigned char *p, const struct zip_write *z, int i)
{
	p = little_put(p, ZIP_VERSION, 2);
	p = little_put(p, 0, 2); /* flags */
	p = little_put(p, 0, 2); /* stored */
	p = little_put(p, 0, 2); /* midnight */
	p = little_put(p, FIRST_DAY, 2);
	p = little_put(p, z->files[i].crc, 4);
	p = little_put(p, z->files[i].size, 4);
	p = little_put(p, z->files[i].size, 4);
	return little_put(p, strlen(z->files[i].name), 2);
}

static void put(struct zip_write *z, const void *bytes, size_t length)
{
	fwrite(bytes, 1, length, z->out);
	z->at += length;
}

int zip_write_file(struct zip_write *z, const char *name, const void *bytes, size_t length, struct err *e)
{
	unsigned char header[LOCAL], *p = header;
	const int i = z->n++;

	if (z->at + length > UINT32_MAX - (1 << 16))
		return err_file(e, z->path, "does not fit a zip of 4 GiB");
	snprintf(z->files[i].name, sizeof z->files[i].name, "%s", name);
	z->files[i].crc = (uint32_t)crc32_z(0, bytes, length);
	z->files[i].size = (uint32_t)length;
	z->files[i].at = (uint32_t)z->at;
	p = little_put(p, 0x04034b50, 4);
	p = put_common(p, z, i);
	little_put(p, 0, 2); /* no extra field */
	put(z, header, sizeof header);
	put(z, name, strlen(name));
	put(z, bytes, length);
	return ferror(z->out) ? err_errno(e, "%s", z->path) : 0;
}

int zip_write_end(struct zip_write *z, struct err *e)
{
	const uint64_t begin = z->at;
	unsigned char central[CENTRAL], end[END], *p;

	for (int i = 0; i < z->n; i++) {
		memset(central, 0, sizeof central);
		p = little_put(central, 0x02014b50, 4);
		p = little_put(p, ZIP_VERSION, 2);
		put_common(p, z, i);
		little_put(central + CENTRAL - 4, z->files[i].at, 4);
		put(z, central, sizeof central);
		put(z, z->files[i].name, strlen(z->files[i].name));
	}
	memset(end, 0, sizeof end);
	p = little_put(end, 0x06054b50, 4) + 4; /* one disk */
	p = little_put(p, (uint64_t)z->n, 2);
	p = little_put(p, (uint64_t)z->n, 2);
	p = little_put(p, z->at - begin, 4);
	little_put(p, begin, 4);
	put(z, end, sizeof end);
	return ferror(z->out) ? err_errno(e, "%s", z->path) : 0;
}
