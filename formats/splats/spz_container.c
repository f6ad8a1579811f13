/* The two containers of .spz: up to version 3 one gzip stream of header, arrays and extensions; from version
 * 4 on a plain header, extensions, a table, and a zstd stream for each array. formats/splats/spz.md. */
#include "base/little.h"
#include "base/mem.h"
#include "base/path.h"
#include "formats/splats/spz.h"

#include <zlib.h>
#include <zstd.h>

/* What a byte of a stream can become at most: of deflate, and a zstd block of 4 bytes for 131,072. */
enum { DEFLATE_RATIO = 1032, ZSTD_RATIO = 32768 };

enum { GZIP_HEADER = 16, PLAIN_HEADER = 32, TABLE_ROW = 16 };
enum { FLAG_ANTIALIASED = 1, FLAG_EXTENSIONS = 2 };

/* Adobe's extension that says which way the axes point: 1 to 8, 9 to 16 with y and z exchanged. */
#define COORDINATES 0xadbe0003u
enum { COORDINATES_DEFAULT = 4, COORDINATES_PLAIN = 8 };

size_t spz_width(const struct spz *f, enum spz_part part)
{
	const size_t sh = 3 * ((size_t)(f->degree + 1) * (size_t)(f->degree + 1) - 1);
	const size_t widths[SPZ_PARTS] = {9, 1, 3, 3, f->version == 2 ? 3 : 4, sh};

	return widths[part];
}

size_t spz_row(const struct spz *f)
{
	size_t row = 0;

	for (int i = 0; i < SPZ_PARTS; i++)
		row += spz_width(f, (enum spz_part)i);
	return row;
}

void spz_place(struct spz *f, const unsigned char *p)
{
	for (int i = 0; i < SPZ_PARTS; i++) {
		f->part[i] = p;
		p += f->n * spz_width(f, (enum spz_part)i);
	}
}

/* Right, up and back are what 4 means; of a .ply, right, down and front. */
static int take_coordinates(struct spz *f, unsigned system, struct err *e)
{
	if (system < 1 || system > COORDINATES_PLAIN)
		return err_file(e, f->name, "coordinate system %u of an extension is not 1 to 8", system);
	system--;
	f->axes = (system & 1 ? 0 : FLIP_X) | (system & 2 ? FLIP_Y : 0) | (system & 4 ? 0 : FLIP_Z);
	return 0;
}

/* Records of a type, a length and so many bytes. Those of no meaning here are passed over. */
static int read_extensions(struct spz *f, const unsigned char *p, size_t len, struct err *e)
{
	while (len) {
		const size_t bytes = len < 8 ? 0 : (size_t)little_get(p + 4, 4);
		if (len < 8 || bytes > len - 8)
			return err_file(e, f->name, "an extension is cut off");
		if (little_get(p, 4) == COORDINATES && bytes >= 4 &&
			take_coordinates(f, (unsigned)little_get(p + 8, 4), e))
			return -1;
		p += 8 + bytes;
		len -= 8 + bytes;
	}
	return 0;
}

/* What both headers begin with. */
static int read_header(struct spz *f, const unsigned char *h, struct err *e)
{
	const uint64_t version = little_get(h + 4, 4);

	if (little_get(h, 4) != SPZ_MAGIC)
		return err_file(e, f->name, "not an .spz file: it does not begin with 'NGSP'%s",
			path_ends(f->name, ".spz") ? "" : "; gunzip unpacks what else it may be");
	if (version < SPZ_OLDEST || version > SPZ_LATEST)
		return err_file(
			e, f->name, "version %llu of .spz, expected 2 to 4", (unsigned long long)version);
	f->version = (int)version;
	f->n = (size_t)little_get(h + 8, 4);
	f->degree = h[12];
	f->fraction_bits = h[13];
	if (f->degree > 3)
		return err_file(e, f->name, "spherical harmonics of degree %d, expected 0 to 3", f->degree);
	if (f->fraction_bits > 24)
		return err_file(e, f->name, "%d fraction bits in coordinates of 24", f->fraction_bits);
	if (h[14] & FLAG_ANTIALIASED)
		return err_file(e, f->name,
			"trained for another way of rendering (antialiased, as Mip-Splatting), which would be wrong here: train it without that mode");
	return take_coordinates(f, COORDINATES_DEFAULT, e);
}

/* Room for all arrays, whose `compressed` bytes can become no more than `ratio` times as many. */
static int make_room(struct spz *f, size_t compressed, size_t ratio, struct err *e)
{
	const size_t row = spz_row(f);
	size_t total, most;

	if (mem_size(compressed, ratio, &most))
		most = SIZE_MAX;
	if (mem_size(f->n, row, &total) || total > most)
		return err_file(e, f->name, "%zu Gaussians of %zu bytes do not fit %zu packed bytes", f->n,
			row, compressed);
	f->bytes = mem_alloc(total, 1, f->name, e);
	if (!f->bytes)
		return -1;
	spz_place(f, f->bytes);
	return 0;
}

/* The next bytes of the stream, as many as there are up to `len`: their number, or -1 with *e. */
static long long inflate_some(struct spz *f, z_stream *z, unsigned char *to, size_t len, struct err *e)
{
	size_t got = 0;
	int status = Z_OK;

	while (got < len && status == Z_OK) {
		const size_t want = len - got < 1u << 30 ? len - got : 1u << 30;
		z->next_out = to + got;
		z->avail_out = (uInt)want;
		status = inflate(z, Z_NO_FLUSH);
		got += want - z->avail_out;
	}
	if (status != Z_OK && status != Z_STREAM_END)
		return err_file(e, f->name, "%s, after %zu bytes of contents",
			status == Z_BUF_ERROR ? "the gzip stream is cut off" : "the gzip stream is damaged",
			(size_t)z->total_out);
	return (long long)got;
}

/* What is after the arrays: extensions, where the header says so, and else nothing. */
static int inflate_rest(struct spz *f, z_stream *z, int has_extensions, struct err *e)
{
	unsigned char rest[4096];
	const long long got = inflate_some(f, z, rest, sizeof rest, e);

	if (got < 0)
		return -1;
	if (got == sizeof rest || (got && !has_extensions) || z->avail_in)
		return err_file(e, f->name, "more than %zu Gaussians", f->n);
	return has_extensions ? read_extensions(f, rest, (size_t)got, e) : 0;
}

static int open_inflated(struct spz *f, z_stream *z, size_t packed, struct err *e)
{
	unsigned char header[GZIP_HEADER];
	const long long got = inflate_some(f, z, header, sizeof header, e);

	if (got < 0)
		return -1;
	if (got < GZIP_HEADER)
		return err_file(e, f->name, "%lld bytes of contents, the header has 16", got);
	if (read_header(f, header, e))
		return -1;
	if (f->version > 3)
		return err_file(e, f->name, "version %d of .spz in gzip", f->version);
	if (make_room(f, packed, DEFLATE_RATIO, e))
		return -1;
	const size_t total = f->n * spz_row(f);
	const long long arrays = inflate_some(f, z, f->bytes, total, e);
	if (arrays < 0)
		return -1;
	if ((size_t)arrays < total)
		return err_file(e, f->name, "%lld bytes of contents, %zu Gaussians have %zu",
			arrays + GZIP_HEADER, f->n, total + GZIP_HEADER);
	return inflate_rest(f, z, header[14] & FLAG_EXTENSIONS, e);
}

static int open_gzip(struct spz *f, const struct file_map *map, struct err *e)
{
	z_stream z = {.next_in = (Bytef *)(uintptr_t)map->data};

	if (map->len > (uInt)-1)
		return err_file(e, f->name, "%zu bytes, more than a gzip stream of .spz can have", map->len);
	z.avail_in = (uInt)map->len;
	if (inflateInit2(&z, 16 + MAX_WBITS) != Z_OK)
		return err_set(e, ERR_SYSTEM, "%s: out of memory", f->name);
	const int bad = open_inflated(f, &z, map->len, e);
	inflateEnd(&z);
	return bad;
}

/* The streams follow the table, each as long as it says. */
static int unpack_streams(struct spz *f, const struct file_map *map, size_t table, int streams, struct err *e)
{
	size_t at = table + (size_t)streams * TABLE_ROW;
	const unsigned char *row = map->data + table;

	for (int i = 0; i < SPZ_PARTS; i++) {
		const size_t bytes = f->n * spz_width(f, (enum spz_part)i);
		if (!bytes)
			continue;
		const uint64_t packed = little_get(row, 8), unpacked = little_get(row + 8, 8);
		if (unpacked != bytes)
			return err_file(e, f->name, "stream %d has %llu bytes, %zu Gaussians have %zu", i,
				(unsigned long long)unpacked, f->n, bytes);
		if (packed > map->len - at)
			return err_file(e, f->name,
				"stream %d of %llu bytes from offset %zu does not fit a file of %zu", i,
				(unsigned long long)packed, at, map->len);
		unsigned char *to = f->bytes + (f->part[i] - f->bytes);
		const size_t got = ZSTD_decompress(to, bytes, map->data + at, (size_t)packed);
		if (ZSTD_isError(got) || got != bytes)
			return err_file(e, f->name, "stream %d is damaged: %s", i,
				ZSTD_isError(got) ? ZSTD_getErrorName(got) : "it is too short");
		at += (size_t)packed;
		row += TABLE_ROW;
	}
	if (at != map->len)
		return err_file(
			e, f->name, "%zu bytes after the last stream, from offset %zu", map->len - at, at);
	return 0;
}

static int open_plain(struct spz *f, const struct file_map *map, struct err *e)
{
	const unsigned char *h = map->data;
	int wanted = 0;

	if (map->len < PLAIN_HEADER)
		return err_file(e, f->name, "%zu bytes, the header has 32", map->len);
	if (read_header(f, h, e))
		return -1;
	if (f->version < 4)
		return err_file(e, f->name, "version %d of .spz without gzip", f->version);
	const size_t streams = h[15], table = (size_t)little_get(h + 16, 4);
	for (int i = 0; i < SPZ_PARTS; i++)
		wanted += f->n && spz_width(f, (enum spz_part)i);
	if (streams != (size_t)wanted)
		return err_file(e, f->name, "%zu streams, expected %d", streams, wanted);
	if (table < PLAIN_HEADER || table > map->len || streams * TABLE_ROW > map->len - table)
		return err_file(e, f->name, "a table of %zu streams at offset %zu does not fit a file of %zu",
			streams, table, map->len);
	if (h[14] & FLAG_EXTENSIONS && read_extensions(f, h + PLAIN_HEADER, table - PLAIN_HEADER, e))
		return -1;
	if (make_room(f, map->len, ZSTD_RATIO, e))
		return -1;
	return unpack_streams(f, map, table, (int)streams, e);
}

int spz_is(const struct file_map *map)
{
	return map->len >= 4 && (!memcmp(map->data, "\x1f\x8b", 2) || little_get(map->data, 4) == SPZ_MAGIC);
}

int spz_open(struct spz *f, const char *name, const struct file_map *map, struct err *e)
{
	*f = (struct spz){.name = name};
	const int is_gzip = map->len >= 2 && map->data[0] == 0x1f && map->data[1] == 0x8b;
	return is_gzip ? open_gzip(f, map, e) : open_plain(f, map, e);
}

void spz_close(struct spz *f)
{
	free(f->bytes);
	*f = (struct spz){0};
}
