/* What other methods than 3DGS write into a .ply, told by its properties. formats/records/foreign.md. */
#include "formats/records/foreign.h"
#include "formats/splats/ply.h"
#include "formats/splats/plyfile.h"

#include <stdio.h>
#include <string.h>

/* Properties of a .ply's vertices that one method writes, and 3DGS does not, or the other way round. */
static const struct {
	const char *has, *lacks, *what, *way_out;
} layouts[] = {
#define FOREIGN_PLY(...) {__VA_ARGS__},
#include "formats/records/foreign.def"
};

/* Codes where 3DGS has floats: half floats, or quantised. */
static int check_types(const struct plyfile *f, const struct plyfile_element *vertex, struct err *e)
{
	static const char *const names[] = {"f_dc_0", "opacity", "scale_0"};

	for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
		const long at = plyfile_property(vertex, names[i]);
		if (at >= 0 && vertex->properties[at].type < PLY_F32 && !vertex->properties[at].is_list)
			return err_file(e, f->path,
				"property '%s' has whole numbers, half floats or codes of a packed scene: export it with floats where it was made",
				names[i]);
	}
	return 0;
}

int ply_check_foreign(const struct plyfile *f, const struct plyfile_element *vertex, struct err *e)
{
	const struct plyfile_element *face = plyfile_find(f, "face");
	char mode[128];

	for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
		if (plyfile_property(vertex, layouts[i].has) >= 0 &&
			(!layouts[i].lacks || plyfile_property(vertex, layouts[i].lacks) < 0) &&
			(!layouts[i].lacks || plyfile_property(vertex, "rot_0") >= 0))
			return foreign_say(f->path, layouts[i].what, layouts[i].way_out, e);
	if (plyfile_property(vertex, "x") >= 0 && plyfile_property(vertex, "scale_0") < 0 &&
		plyfile_property(vertex, "rot_0") < 0 && plyfile_property(vertex, "packed_position") < 0)
		return err_file(e, f->path,
			"a %s, not a trained scene: it has points without scale and rotation; 3D Gaussian Splatting trains a scene from them, point_cloud/iteration_N/point_cloud.ply",
			face && face->rows ? "mesh" : "point cloud");
	if (f->mode) {
		snprintf(mode, sizeof mode, "%.*s", (int)strcspn(f->mode, "\r"), f->mode);
		return err_file(e, f->path,
			"trained for another way of rendering ('%s'), which would be wrong here: train it without that mode",
			mode);
	}
	return check_types(f, vertex, e);
}
