/* gs-import: makes a scene folder from a trained 3DGS scene and its cameras. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/import/import.h"
#include "formats/cameras/colmap.h"
#include "formats/cameras/dataparser.h"

#include <math.h>

static struct import_options files = {.time = NAN};

static const struct cli_option options[] = {
	CLI_TEXT("cameras", &files.cameras, "PATH",
		"COLMAP model, 3DGS cameras.json, transforms.json, or their folder (default: beside SPLATS)"),
	CLI_TEXT("images", &files.images, "DIR", "folder of the photographs, to be named in the scene"),
	CLI_TEXT("test-views", &files.test_views, "NAMES",
		"views kept for testing: NAME,... or every:N (default: the camera file's, else none)"),
	CLI_TEXT("motion", &files.motion, "FILE.npz",
		"where the Gaussians of SPLATS are at other times: arrays means or displacements, times, perhaps quats"),
	CLI_TEXT("times", &files.times, "FILE|T0:T1|Nfps",
		"the times of frames, of a scene that moves: numbers in a file, evenly, or so many a second (default 0:1)"),
	{"time", 0, CLI_REAL, &files.time, "T",
		"the time of all views of a scene that moves, whose cameras say none", 0, 0},
	CLI_SWITCH("metres", &files.is_metric,
		"a unit of SPLATS is a metre, as gs-transform --known makes it: answers then say lengths so"),
	CLI_SWITCH("undistort", &files.undistort,
		"where a camera distorts, make the view the pinhole of the same view, and keep the lens beside it"),
	{0},
};

static const struct cli_tool tool = {
	.name = "gs-import",
	.operands = "SPLATS",
	.summary = "Make a scene folder from a trained 3DGS scene and its cameras.",
	.options = options,
	.common = CLI_OUTPUT | CLI_VERBOSE | CLI_QUIET,
	.min_operands = 1,
	.max_operands = 1,
	.output_arg = "SCENE",
	.needs_output = 1,
};

static void refuse_overwrite(const struct cli *cli, const char *cameras)
{
	const struct cli_file found[] = {
		{"--cameras", cameras, CLI_READS, file_is_dir(cameras) ? COLMAP_PARTS : NULL}, {0}};

	cli_refuse_overwrite(cli, "SPLATS motion", "output:" CLI_SCENE_PARTS, found);
}

static void note_splats(const struct cli *cli, const struct scene *s, const struct rows_report *r,
	const struct import_found *moved, const char *splats)
{
	size_t dropped = r->not_finite + r->zero_quat;
	int degree = 0;

	while ((degree + 1) * (degree + 1) < s->splats.sh_coefficients)
		degree++;
	cli_note(cli, 1, "%s: %zu Gaussians, spherical harmonics of degree %d, offset %.17g %.17g %.17g",
		file_name(splats), s->splats.n, degree, s->offset[0], s->offset[1], s->offset[2]);
	if (moved->times)
		cli_note(cli, 1, "%s: moves: %zu times, %zu of %zu Gaussians ever move", file_name(splats),
			moved->times, moved->moved, s->splats.n);
	if (s->splats.near != SPLATS_NEAR)
		cli_note(cli, 1, "%s: views leave out what is within %.3g of the camera", file_name(splats),
			s->splats.near);
	if (!dropped)
		return;
	cli_warn(cli, "%s: left out %zu of %zu Gaussians: %zu not finite, %zu with a zero quaternion",
		file_name(splats), dropped, r->read, r->not_finite, r->zero_quat);
	for (size_t i = 0; i < dropped; i++)
		cli_note(cli, i < 20 ? 1 : 2, "%s: left out Gaussian %zu", file_name(splats), r->dropped[i]);
}

static void note_cameras(
	const struct cli *cli, const struct cameras *c, const char *path, const struct import_found *found)
{
	const struct resemblance *r = &found->resemblance;
	size_t test = 0, first = 0;

	while (first + 1 < c->n && c->views[first].image)
		first++;
	for (size_t i = 0; i < c->n; i++)
		test += c->views[i].split == SPLIT_TEST;
	cli_note(cli, 1, "%s: %zu views, %zu of them for testing", file_name(path), c->n, test);
	if (!files.images)
		cli_note(cli, 0,
			"%s: without --images the sizes of the photographs, how EXIF turns them, and whether the scene looks like them are not checked; masks of another shape, and masks that show no one scene, are refused by pseudomask-select, refer-lift and refer-train",
			file_name(path));
	if (files.images && found->missing)
		cli_warn(cli,
			"%s: no photograph for %zu of %zu views, such as '%s': give the folder with files of these names",
			files.images, found->missing, c->n, c->views[first].name);
	const int is_alike = !r->views || r->typical >= RESEMBLANCE_LEAST;
	if (found->near < POINT_FRAME_LEAST && is_alike)
		cli_warn(cli,
			"%s: the splats are in another frame than the cameras, or of another scene: %.0f%% of the points beside the cameras are near a splat, or the other way round, at least %.0f%% is right: " DATAPARSER_WAY_OUT,
			file_name(path), 100 * found->near, 100 * POINT_FRAME_LEAST);
	if (r->unread)
		cli_warn(cli, "%zu of %zu photographs are not compared with the scene: %s", r->unread,
			r->unread + r->views, r->why.message);
	if (r->turned)
		cli_warn(cli,
			"%s: the photographs of %zu of %zu views are turned against their cameras ('%s' is right after %d degrees clockwise): "
			"turn their pixels as EXIF says ('mogrify -auto-orient'), or give those that the cameras are of",
			files.images, r->turned, r->views, r->first, r->degrees);
	if (r->misshapen && !r->turned)
		cli_warn(cli,
			"%s: the photographs of %zu of %zu views have another shape than their cameras ('%s' is %dx%d): give those that the cameras are of",
			files.images, r->misshapen, r->views, r->odd, r->width, r->height);
	if (!is_alike)
		cli_warn(cli,
			"%s: the scene does not look like its photographs (by %.2f in the middle of %zu views, at least %.2g is right): "
			"are %s the cameras that it was trained with, and in its frame? " DATAPARSER_WAY_OUT,
			files.images, r->typical, r->views, RESEMBLANCE_LEAST, file_name(path));
}

static int import(const struct cli *cli, char *splats, const struct report *to, struct err *e)
{
	SCOPED_BY(scene_free) struct scene s = {0};
	struct rows_report rows = {0};
	struct import_found found;

	files.splats = cli->operands[0] = splats;
	SCOPED char *cameras = import_find_cameras(&files, e);
	if (!cameras)
		return -1;
	refuse_overwrite(cli, cameras);
	const int bad = import_scene(&s, &rows, &files, cameras, cli->output, &found, to, e);
	if (!bad) {
		note_splats(cli, &s, &rows, &found, files.splats);
		note_cameras(cli, &s.cameras, cameras, &found);
	}
	free(rows.dropped);
	return bad;
}

static int run(const struct cli *cli, const struct report *to, struct err *e)
{
	if (!strcmp(cli->output, "-"))
		cli_usage(cli, "-o: a scene is a folder and cannot go to stdout");
	if (!files.cameras && !strcmp(cli->operands[0], "-"))
		cli_usage(cli, "--cameras is required where SPLATS is stdin");
	if (files.cameras && !strcmp(files.cameras, "-") && !strcmp(cli->operands[0], "-"))
		cli_usage(cli, "--cameras and SPLATS cannot both be stdin");
	SCOPED char *splats = import_find_splats(cli->operands[0], e);
	return splats ? import(cli, splats, to, e) : -1;
}

CLI_MAIN(tool, run)
