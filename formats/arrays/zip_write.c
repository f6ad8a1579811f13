/* Local headers with the files after them, then the central directory and its end record, of PKWARE's
 * APPNOTE.TXT. Dates are the format's first day, so that the same files make the same zip. */
#include "formats/arrays/zip_write.h"

#include "base/little.h"

#include <string.h>
#include <zlib.h>

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
