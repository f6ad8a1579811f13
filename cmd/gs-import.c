/* gs-import: makes a scene folder from a trained 3DGS scene and its cameras. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "formats/camerafile.h"
#include "formats/colmap.h"
#include "formats/ply.h"
#include "formats/scene.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *cameras_path, *images_path, *test_views;

static const struct cli_option options[] = {
	{"cameras", 0, CLI_STRING, &cameras_path, "PATH",
		"COLMAP model, 3DGS cameras.json, transforms.json, or their folder (default: beside SPLATS)",
		0, 0},
	{"images", 0, CLI_STRING, &images_path, "DIR", "folder of the photographs, to be named in the scene",
		0, 0},
	{"test-views", 0, CLI_STRING, &test_views, "NAMES",
		"views kept for testing: NAME,... or every:N (default: the camera file's, else none)", 0, 0},
	{0},
};

static const struct cli_tool tool = {
	.name = "gs-import",
	.operands = "SPLATS",
	.summary = "Make a scene folder from a trained 3DGS .ply and its cameras.",
	.options = options,
	.common = CLI_OUTPUT | CLI_VERBOSE | CLI_QUIET,
	.min_operands = 1,
	.max_operands = 1,
	.output_arg = "SCENE",
	.needs_output = 1,
};

/* 0, N, 2N ... in name order, as 3DGS holds out every 8th. */
static void split_every(const struct cli *cli, struct cameras *c, const char *text)
{
	char *end;
	unsigned long n = strtoul(text, &end, 10);

	if (text[0] < '0' || text[0] > '9' || *end || n < 1 || n > 1000000000)
		cli_usage(cli, "--test-views: '%s' is not every:N with N from 1 to 1000000000", test_views);
	for (size_t i = 0; i < c->n; i++)
		c->views[i].split = i % n ? SPLIT_TRAIN : SPLIT_TEST;
}

static int split_names(struct cameras *c, struct err *e)
{
	char *is_test = mem_zalloc(c->n, 1, "views", e);
	int bad = is_test ? cameras_mark(c, test_views, "--test-views", is_test, e) : -1;

	for (size_t i = 0; i < c->n && !bad; i++)
		c->views[i].split = is_test[i] ? SPLIT_TEST : SPLIT_TRAIN;
	free(is_test);
	return bad;
}

/* What is beside SPLATS or, where 3DGS put it into point_cloud/iteration_N, in the folder of the trained
 * model. */
static char *find_beside(const char *splats, struct err *e)
{
	char *dir = file_dir(splats, e), *found = dir ? camerafile_find(dir, e) : NULL;
	const char *slash = dir ? strrchr(dir, '/') : NULL;

	if (dir && !found && !strncmp(slash ? slash + 1 : dir, "iteration_", 10)) {
		struct err ignored;
		char *model = file_join(dir, "../..", "", e);
		found = model ? camerafile_find(model, &ignored) : NULL;
		free(model);
	}
	free(dir);
	return found;
}

/* The camera file; free() it. NULL with *e set. */
static char *choose_cameras(const struct cli *cli, const char *splats, struct err *e)
{
	if (cameras_path)
		return file_is_dir(cameras_path) ? camerafile_find(cameras_path, e)
						 : mem_strdup(cameras_path, e);
	char *found = find_beside(splats, e);
	if (!found && e->code == ERR_FORMAT)
		cli_usage(cli, "--cameras is not given, and %s", e->message);
	return found;
}

static void refuse_overwrite(const struct cli *cli, const char *cameras)
{
	const struct cli_file found[] = {
		{"--cameras", cameras, CLI_READS, file_is_dir(cameras) ? COLMAP_PARTS : NULL}, {0}};

	cli_refuse_overwrite(cli, "SPLATS", "output:" CLI_SCENE_PARTS, found);
}

static void note_splats(
	const struct cli *cli, const struct scene *s, const struct ply_report *r, const char *splats)
{
	size_t dropped = r->not_finite + r->zero_quat;
	int degree = 0;

	while ((degree + 1) * (degree + 1) < s->splats.sh_coefficients)
		degree++;
	cli_note(cli, 1, "%s: %zu Gaussians, spherical harmonics of degree %d, offset %.17g %.17g %.17g",
		file_name(splats), s->splats.n, degree, s->offset[0], s->offset[1], s->offset[2]);
	if (!dropped)
		return;
	cli_warn(cli, "%s: left out %zu of %zu Gaussians: %zu not finite, %zu with a zero quaternion",
		file_name(splats), dropped, r->read, r->not_finite, r->zero_quat);
	for (size_t i = 0; i < dropped; i++)
		cli_note(cli, i < 20 ? 1 : 2, "%s: left out Gaussian %zu", file_name(splats), r->dropped[i]);
}

static void note_cameras(const struct cli *cli, const struct cameras *c, const char *path, size_t missing)
{
	size_t test = 0;

	for (size_t i = 0; i < c->n; i++)
		test += c->views[i].split == SPLIT_TEST;
	cli_note(cli, 1, "%s: %zu views, %zu of them for testing", file_name(path), c->n, test);
	if (images_path && missing)
		cli_warn(cli, "%s: no photograph for %zu of %zu views", images_path, missing, c->n);
}

/* For the scene's metadata. No paths: a scene's bytes do not depend on where its sources were. */
static char *describe_options(struct err *e)
{
	size_t bytes = (test_views ? strlen(test_views) : 0) + 16;
	char *text = mem_alloc(bytes, 1, "options", e);

	if (text)
		snprintf(
			text, bytes, "%s%s", test_views ? "--test-views " : "", test_views ? test_views : "");
	return text;
}

static int check_images(struct err *e)
{
	if (!images_path || file_is_dir(images_path))
		return 0;
	errno = file_exists(images_path) ? ENOTDIR : ENOENT;
	return err_errno(e, "%s", images_path);
}

/* So that a file that is missing is said to be so before cameras are looked for beside it. */
static int check_splats(const char *path, struct err *e)
{
	return strcmp(path, "-") && !file_exists(path) ? err_errno(e, "%s", path) : 0;
}

static int run(
	const struct cli *cli, struct scene *s, struct ply_report *report, char **cameras, struct err *e)
{
	const char *splats = cli->operands[0];
	char *metadata;
	size_t missing;

	if (check_images(e) || check_splats(splats, e))
		return -1;
	*cameras = choose_cameras(cli, splats, e);
	if (!*cameras)
		return -1;
	refuse_overwrite(cli, *cameras);
	if (ply_read(&s->splats, s->offset, report, splats, e) || camerafile_read(&s->cameras, *cameras, e))
		return -1;
	if (test_views && !strncmp(test_views, "every:", 6))
		split_every(cli, &s->cameras, test_views + 6);
	else if (test_views && split_names(&s->cameras, e))
		return -1;
	cameras_shift(&s->cameras, s->offset);
	metadata = describe_options(e);
	int bad = !metadata || file_make_dir(cli->output, e) ||
		  camerafile_images(&s->cameras, images_path, cli->output, &missing, e) ||
		  scene_write(s, cli->output, metadata, e);
	free(metadata);
	if (bad)
		return -1;
	note_splats(cli, s, report, splats);
	note_cameras(cli, &s->cameras, *cameras, missing);
	return 0;
}

int main(int argc, char **argv)
{
	struct scene s = {0};
	struct ply_report report = {0};
	struct err e = {0};
	struct cli cli;
	char *cameras = NULL;

	cli_parse(&cli, &tool, argc, argv);
	if (!strcmp(cli.output, "-"))
		cli_usage(&cli, "-o: a scene is a folder and cannot go to stdout");
	if (!cameras_path && !strcmp(cli.operands[0], "-"))
		cli_usage(&cli, "--cameras is required where SPLATS is stdin");
	if (cameras_path && !strcmp(cameras_path, "-") && !strcmp(cli.operands[0], "-"))
		cli_usage(&cli, "--cameras and SPLATS cannot both be stdin");
	int bad = run(&cli, &s, &report, &cameras, &e);
	scene_free(&s);
	free(report.dropped);
	free(cameras);
	return bad ? cli_fail(&cli, &e) : cli_done(&cli);
}
