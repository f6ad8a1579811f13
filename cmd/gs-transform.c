/* gs-transform: splats from one format into another, cut and moved. */
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/import/transforming.h"
#include "formats/splats/anysplats.h"

static struct transforming options = {.scale = 1};
static int format;
static long long spz_version = ANYSPLATS_SPZ_VERSION;

static const struct cli_option table[] = {
	CLI_ONE_OF("format", &format, "auto|ply|splat|spz|glb|sog",
		"what to write (default: as FILE is called)"),
	{"spz-version", 0, CLI_INT, &spz_version, "N", "version of .spz to write, 2 to 4 (default 3)", 2, 4},
	CLI_TEXT("crop", &options.crop, "X0,Y0,Z0,X1,Y1,Z1", "keep what is within this box"),
	CLI_SWITCH("drop-strays", &options.drop_strays, "leave out Gaussians that are far from all others"),
	{"scale", 0, CLI_REAL, &options.scale, "S", "make everything S times as large, about the origin",
		1e-9, 1e9},
	CLI_TEXT("known", &options.known, "X0,Y0,Z0,X1,Y1,Z1=LENGTH",
		"in place of --scale: two points, and how far they are apart when all is done"),
	CLI_TEXT("up-from", &options.up_from, "CAMERAS",
		"level the scene: what is up for these cameras, which people hold level, becomes -y, as viewers have it"),
	CLI_TEXT("rotate", &options.rotate, "W,X,Y,Z|X,Y,Z:DEGREES",
		"turn about the origin: a quaternion, or an axis and an angle"),
	CLI_TEXT("translate", &options.translate, "X,Y,Z", "shift by so much"),
	{0},
};

static const struct cli_tool tool = {
	.name = "gs-transform",
	.operands = "SPLATS",
	.summary = "Write splats in another format, cut, scaled, turned and shifted.",
	.options = table,
	.common = CLI_OUTPUT | CLI_THREADS | CLI_VERBOSE | CLI_QUIET,
	.min_operands = 1,
	.max_operands = 1,
	.needs_output = 1,
};

static enum anysplats_format choose_format(const struct cli *cli)
{
	const int found = format ? format - 1 : anysplats_format_of(cli->output);

	if (found < 0)
		cli_usage(cli, "-o %s: not .ply, .splat, .spz, .glb or .sog, and --format is not given",
			cli->output);
	return (enum anysplats_format)found;
}

static void note(const struct cli *cli, const struct splats *s, const struct rows_report *r,
	const struct transforming_count *left_out)
{
	if (r->read > s->n + left_out->outside + left_out->strays)
		cli_warn(cli, "%s: left out %zu of %zu Gaussians: %zu not finite, %zu with a zero quaternion",
			cli->operands[0], r->not_finite + r->zero_quat, r->read, r->not_finite, r->zero_quat);
	if (options.crop)
		cli_note(cli, 1, "%zu Gaussians are outside the box", left_out->outside);
	if (options.drop_strays)
		cli_note(cli, 1, "%zu Gaussians are strays", left_out->strays);
	if (options.up_from)
		cli_note(cli, 1, "up was %.3f %.3f %.3f", left_out->up[0], left_out->up[1], left_out->up[2]);
	if (options.known)
		cli_note(cli, 1, "everything is %.6g times as large", left_out->scale);
	cli_note(cli, 1, "%zu Gaussians are written", s->n);
}

static int warn_loss(
	const struct cli *cli, const struct splats *s, const double offset[3], int to, struct err *e)
{
	char text[ANYSPLATS_LOSS];
	const int found = anysplats_loss(s, offset, (enum anysplats_format)to, text, e);

	if (found > 0)
		cli_warn(cli, "%s: %s", cli->output, text);
	return found < 0;
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(splats_free) struct splats s = {0};
	struct rows_report rows = {0};
	struct transforming_count left_out;
	const enum anysplats_format format_to = choose_format(c);
	double offset[3];

	(void)to;
	if (options.known && options.scale != 1)
		cli_usage(c, "--known and --scale do not go together");
	if (transforming_check(&options, e))
		cli_usage(c, "%s", e->message);
	cli_refuse_terminal(c);
	cli_refuse_overwrite(c, "SPLATS up-from", "output", NULL);
	const int bad = anysplats_read(&s, offset, &rows, c->operands[0], e) ||
			transforming_do(&s, offset, &options, &left_out, e) ||
			anysplats_write(&s, offset, format_to, (int)spz_version, c->output, e) ||
			warn_loss(c, &s, offset, format_to, e);
	if (!bad)
		note(c, &s, &rows, &left_out);
	free(rows.dropped);
	return bad ? -1 : 0;
}

CLI_MAIN(tool, run)
