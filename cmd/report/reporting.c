#define _XOPEN_SOURCE 700 /* realpath; NOLINT(bugprone-reserved-identifier) */
#include "cmd/report/reporting.h"

#include "base/embed.h"
#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"

EMBED(report_page, "cmd/report/report_page.html");
extern const char report_page_begin[];

/* Where the data and the viewer stand in the page. */
static const char data_mark[] = "{{data}}", viewer_mark[] = "{{viewer}}";

static void put_scene(struct jsontext *to, const struct report_run *r)
{
	const struct cameras *c = &r->scene.cameras;
	size_t tests = 0;

	for (size_t v = 0; v < c->n; v++)
		tests += c->views[v].split == SPLIT_TEST;
	jsontext_open(to, "scene", '{');
	jsontext_number(to, "gaussians", (double)r->scene.splats.n);
	jsontext_number(to, "views", (double)c->n);
	jsontext_number(to, "test_views", (double)tests);
	if (r->has_lifted)
		jsontext_number(to, "objects", (double)r->lifted.lifted.objects);
	jsontext_close(to, '}');
}

/* The folder's own name, also where it is called "." */
static void put_name(struct jsontext *to, const char *run)
{
	SCOPED char *full = realpath(run, NULL);
	int length;
	const char *last = path_last(full ? full : run, &length);
	char name[256];

	snprintf(name, sizeof name, "%.*s", length, last);
	jsontext_string(to, "name", name);
	jsontext_string(to, "version", VERSION);
}

/* What the page shows, but for the viewer. */
static int put_data(FILE *out, const struct report_run *r, const struct report *told, struct err *e)
{
	const char *run = r->options->run;
	SCOPED_BY(report_outlines_free) struct report_outlines outlines = {0};
	struct jsontext to = {.out = out, .is_page = 1};

	jsontext_open(&to, NULL, '{');
	put_name(&to, run);
	put_scene(&to, r);
	if (report_views(&to, r, told, e) || report_sentences(&to, r, &outlines, e))
		return -1;
	jsontext_open(&to, "outlines", '[');
	for (size_t i = 0; i < outlines.n; i++)
		jsontext_string(&to, NULL, outlines.items[i].path);
	jsontext_close(&to, ']');
	if (report_losses(&to, run, e))
		return -1;
	report_steps(&to, run);
	if (report_settings(&to, run, e))
		return -1;
	jsontext_close(&to, '}');
	return 0;
}

/* The same in memory, so that a page that fails is not begun; free() it. NULL with *e set. */
static char *make_data(const struct report_run *r, const struct report *told, struct err *e)
{
	char *data = NULL;
	size_t length;
	FILE *out = open_memstream(&data, &length);
	const int bad = out && put_data(out, r, told, e);

	return mem_text_end(out, &data, bad, "page", e);
}

static int put_page(FILE *out, struct report_run *r, const char *made, const struct report *to, struct err *e)
{
	const char *data = strstr(report_page_begin, data_mark),
		   *viewer = strstr(report_page_begin, viewer_mark);

	if (!data || !viewer || viewer < data)
		return err_set(e, ERR_SYSTEM, "the page has no place for its data");
	fwrite(report_page_begin, 1, (size_t)(data - report_page_begin), out);
	fputs(made, out);
	data += sizeof data_mark - 1;
	fwrite(data, 1, (size_t)(viewer - data), out);
	if (report_viewer_put(out, r, to, e))
		return -1;
	fputs(viewer + sizeof viewer_mark - 1, out);
	return 0;
}

int reporting_write(
	const struct report_options *options, const char *path, const struct report *to, struct err *e)
{
	SCOPED_BY(report_run_free) struct report_run r = {0};
	struct file_out out;

	if (report_run_read(&r, options, to, e))
		return -1;
	SCOPED char *data = make_data(&r, to, e);
	return !data ? -1
		     : file_out_end(&out,
			       file_out_open(&out, path, e) || put_page(out.stream, &r, data, to, e), e);
}
