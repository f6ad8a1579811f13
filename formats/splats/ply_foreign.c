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
	{"filter_3D", NULL,
		"a scene of Mip-Splatting (property 'filter_3D'), which 3DGS's rendering gets wrong",
		"its 'python create_fused_ply.py -m MODEL --output_ply fused.ply' makes one that is right"},
	{"f_anchor_feat_0", NULL, "anchors of Scaffold-GS, which its networks make Gaussians of",
		FOREIGN_TRAIN},
	{"f_offset_0", NULL, "anchors of Scaffold-GS, which its networks make Gaussians of", FOREIGN_TRAIN},
	{"trbf_center", NULL, "Gaussians that move (property 'trbf_center')", FOREIGN_TRAIN},
	{"scale_t", NULL, "Gaussians that move (property 'scale_t')", FOREIGN_TRAIN},
	{"binding_0", NULL, "Gaussians that a mesh moves (property 'binding_0')", FOREIGN_TRAIN},
	{"beta", NULL, "kernels that are no Gaussians (property 'beta')", FOREIGN_TRAIN},
	{"scale_1", "scale_2", "flat Gaussians of 2DGS, with two scales, which are rendered in another way",
		FOREIGN_TRAIN},
	{"f_0", "f_dc_0", "features of SAGA without colours (property 'f_0')",
		"give its scene_point_cloud.ply"},
	{"red", "f_dc_0", "Gaussians with colours in place of spherical harmonics (property 'red')",
		"'ns-export gaussian-splat --ply-color-mode sh_coeffs' writes these"},
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
