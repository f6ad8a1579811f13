/* refer-render: the masks of sentences in any view, from a model. */
#include "answer/peak.h"
#include "base/file.h"
#include "base/mem.h"
#include "cli/cli.h"
#include "cmd/render/draw.h"
#include "cmd/render/request.h"

#include <math.h>

static struct {
	struct request_options request;
	struct draw_options draw;
	double time;
} options = {.request = REQUEST_DEFAULTS, .draw = {.split = SPLIT_TEST}, .time = NAN};

static const struct cli_option table[] = {REQUEST_FILES(options.request),
	CLI_ONE_OF("split", &options.draw.split, "train|test|all", "which views (default test)"),
	CLI_TEXT("views", &options.draw.views, "NAME,...", "these views instead of a split"),
	REQUEST_SENTENCES(options.request),
	CLI_ONE_OF("calibration", &options.request.is_plain, "peak|none",
		"peak (default): lift a sentence's responses until its best are clearly above 0; none: as trained"),
	{"min-probability", 0, CLI_REAL, &options.request.least, "P",
		"lifted models: a sentence less likely to mean anything gets no mask (default 0.5)", 0, 1},
	CLI_TEXT("without", &options.request.without, "PART,...",
		"lifted models: choose without words, names, knowledge, colours, surfaces, sizes, relations, except, sentence or purpose"),
	CLI_TEXT("viewpoint", &options.request.viewpoint, "VIEW|x,y,z|each",
		"lifted models: where sentences are said; each: in every view that is rendered (default: the view that a sentence names, else between the training views)"),
	{"time", 0, CLI_REAL, &options.time, "T",
		"of a scene that moves: everything at this time (default: each view at its own)", 0, 0},
	CLI_SWITCH("all-times", &options.draw.is_all_times,
		"of a scene that moves: each view at every stored time, as VIEW.tNNNNN"),
	CLI_SWITCH("when", &options.draw.is_when,
		"of a scene that moves: no mask in views of a time that a sentence of motion does not mean"),
	CLI_SWITCH("parts", &options.request.wants_parts,
		"lifted models: where a sentence means several objects, the mask of each too, in the key parts"),
	CLI_SWITCH("amodal", &options.draw.is_amodal,
		"outlines of whole objects as if nothing hid them, and the share in sight"),
	{"peak", 0, CLI_INT, &options.draw.peak, "N",
		"the pixel where the mean response of N x N pixels is largest too, in the key peak (LERF: 1, LangSplat: 30)",
		1, PEAK_MAX_WINDOW},
	{"size", 0, CLI_SIZE, &options.draw.size, "WxH", "size of the masks (default: the view's)", 1, 65536},
	{"scale", 0, CLI_REAL, &options.draw.scale, "S",
		"size of the masks as a share of the view's (default 1)", 1e-4, 16},
	CLI_TEXT("png", &options.draw.pictures.masks, "DIR", "write masks as DIR/VIEW/REF.png"),
	CLI_TEXT("response", &options.draw.pictures.responses, "DIR",
		"write response maps as DIR/VIEW/REF.png or .npy"),
	CLI_ONE_OF("response-type", &options.draw.pictures.is_npy, "png|npy",
		"png (default): 16 bits, 65535 times the sigmoid of the response; npy: the response"),
	CLI_TEXT("overlay", &options.draw.pictures.overlays, "DIR",
		"draw masks over the scene's colours as DIR/VIEW/REF.png"),
	{0}};

static const struct cli_tool tool = {.name = "refer-render",
	.operands = "--scene SCENE --text TEXT --model MODEL",
	.summary = "Render the masks of sentences in any view of a scene.",
	.options = table,
	.common = CLI_VERBOSE | CLI_QUIET | CLI_THREADS | CLI_OUTPUT};

static void check(const struct cli *c)
{
	const struct request_options *o = &options.request;

	if (!o->scene || !o->text || !o->model)
		cli_usage(c, "--scene, --text and --model are required");
	cli_refuse_overwrite(
		c, CLI_SCENE " text model", "output png:*.png response:*.png overlay:*.png", NULL);
	if (options.draw.size[0] && options.draw.scale)
		cli_usage(c, "--size and --scale do not go together");
	if (options.draw.peak && options.draw.is_amodal)
		cli_usage(c, "--peak and --amodal do not go together");
	if (options.draw.is_all_times && !isnan(options.time))
		cli_usage(c, "--time and --all-times do not go together");
	options.request.time = isnan(options.time) ? NULL : &options.time;
	options.draw.is_each = o->viewpoint && !strcmp(o->viewpoint, "each");
}

static int run(const struct cli *c, const struct report *to, struct err *e)
{
	SCOPED_BY(request_free) struct request r = {0};
	SCOPED_BY(drawing_free) struct drawing d = {0};
	struct viewpoint from;

	check(c);
	const int has_viewpoint = options.request.viewpoint && !options.draw.is_each;
	if (request_read(&r, &options.request, e) || draw_choose(&d, &options.draw, &r, e) ||
		request_choose(&r, e))
		return -1;
	if (!d.view_count || !r.count)
		cli_warn(c, "%s: no %s in this split",
			d.view_count ? file_name(options.request.text) : options.request.scene,
			d.view_count ? "sentence" : "view");
	if (has_viewpoint && request_viewpoint(&r, &from, e))
		return -1;
	return draw(&d, has_viewpoint ? &from : NULL, c->output, to, e);
}

CLI_MAIN(tool, run)
