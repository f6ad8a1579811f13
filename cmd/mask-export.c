/* mask-export: mask records as COCO's JSON, and as pictures. */
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/masks/exporting.h"

static const char *scene, *png;
static int distort;

static const struct cli_option table[] = {
	CLI_TEXT("scene", &scene, "SCENE",
		"scene folder, whose photographs' names the JSON gets (default: VIEW.png)"),
	CLI_SWITCH("distort", &distort,
		"make masks of views whose photographs' lens distorts masks of the photographs (needs --scene)"),
	CLI_TEXT("png", &png, "DIR", "also write each mask as DIR/VIEW/NAME.png, white on black"), {0}};

static const struct cli_tool tool = {.name = "mask-export",
	.operands = "[MASKS]",
	.summary = "Write masks (JSON Lines; stdin by default) as COCO's JSON, and as pictures.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_OUTPUT,
	.max_operands = 1};

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(exporting_free) struct exporting x = {0};
	struct file_out out;

	(void)to;
	if (distort && !scene)
		cli_usage(c, "--distort needs --scene SCENE");
	cli_refuse_overwrite(c, "MASKS scene:cameras.json", "output png:*.png", NULL);
	return -(exporting_read(&x, c->operand_count ? c->operands[0] : "-", scene, distort, e) ||
		 (png && exporting_write_pngs(&x, png, e)) || file_out_open(&out, c->output, e) ||
		 file_out_end(&out, exporting_put_coco(&x, out.stream, e), e));
}

CLI_MAIN(tool, run)
