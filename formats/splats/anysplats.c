#include "formats/splats/anysplats.h"

#include "base/file.h"
#include "base/path.h"
#include "formats/records/foreign.h"
#include "formats/splats/glb.h"
#include "formats/splats/ply.h"
#include "formats/splats/sog.h"
#include "formats/splats/splat.h"
#include "formats/splats/spz.h"

#include <string.h>

int anysplats_is_meta(const char *path)
{
	int length;

	return !strcmp(path_last(path, &length), "meta.json");
}

int anysplats_read(
	struct splats *s, double offset[3], struct rows_report *report, const char *path, struct err *e)
{
	const char *name = file_name(path);
	struct file_map map;

	*s = (struct splats){0};
	if (report)
		*report = (struct rows_report){0};
	if (anysplats_is_meta(path))
		return sog_read_meta(s, offset, report, path, e);
	if (file_map(path, &map, e))
		return -1;
	const int is_ply = map.len >= 4 && (!memcmp(map.data, "ply\n", 4) || !memcmp(map.data, "ply\r", 4));
	if (!is_ply && !spz_is(&map) && !glb_is(&map) &&
		foreign_file(name, FOREIGN_SPLATS, map.data, map.len, e)) {
		file_unmap(&map);
		return -1;
	}
	if (!is_ply && (spz_is(&map) || path_ends(name, ".spz")))
		return spz_read_map(s, offset, report, name, &map, e);
	if (!is_ply && path_ends(name, ".splat"))
		return splat_read_map(s, offset, report, name, &map, e);
	if (!is_ply && (sog_is(&map) || path_ends(name, ".sog")))
		return sog_read_map(s, offset, report, name, &map, e);
	if (!is_ply && (glb_is(&map) || path_ends(name, ".glb") || path_ends(name, ".gltf")))
		return glb_read_map(s, offset, report, name, &map, e);
	return ply_read_map(s, offset, report, name, &map, e);
}

int anysplats_format_of(const char *path)
{
	static const char *const tails[] = {[ANYSPLATS_PLY] = ".ply",
		[ANYSPLATS_SPLAT] = ".splat",
		[ANYSPLATS_SPZ] = ".spz",
		[ANYSPLATS_GLB] = ".glb",
		[ANYSPLATS_SOG] = ".sog"};

	for (int i = 0; i < ANYSPLATS_FORMATS; i++)
		if (path_ends(path, tails[i]))
			return i;
	return -1;
}

int anysplats_write(const struct splats *s, const double offset[3], enum anysplats_format format,
	int spz_version, const char *path, struct err *e)
{
	switch (format) {
	case ANYSPLATS_SPLAT:
		return splat_write(s, offset, path, e);
	case ANYSPLATS_SPZ:
		return spz_write(s, offset, spz_version, path, e);
	case ANYSPLATS_SOG:
		return sog_write(s, offset, path, e);
	case ANYSPLATS_GLB:
		return glb_write(s, offset, path, e);
	default:
		return ply_write(s, offset, path, e);
	}
}
