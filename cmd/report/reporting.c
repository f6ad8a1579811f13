#define _XOPEN_SOURCE 700 /* realpath; NOLINT(bugprone-reserved-identifier) */
#include "cmd/report/reporting.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"

#include <stdlib.h>
#include <string.h>

/* The page, with a byte of 0 after it: the assembler puts it in. */
__asm__(".section .rodata\n"
	".globl report_page_begin\nreport_page_begin:\n"
	".incbin \"cmd/report/report_page.html\"\n"
	".byte 0\n"
	".previous\n");
extern const char report_page_begin[];

/* Where the data and the viewer stand in the page. */
static const char data_mark[] = "{{data}}", viewer_mark[] = "{{viewer}}";

static int add_scene(cJSON *page, const struct report_run *r)
{
	const struct cameras *c = &r->scene.cameras;
	cJSON *scene = cJSON_AddObjectToObject(page, "scene");
	size_t tests = 0;

	for (size_t v = 0; v < c->n; v++)
		tests += c->views[v].split == SPLIT_TEST;
	return cJSON_AddNumberToObject(scene, "gaussians", (double)r->scene.splats.n) &&
	       cJSON_AddNumberToObject(scene, "views", (double)c->n) &&
	       cJSON_AddNumberToObject(scene, "test_views", (double)tests) &&
	       (!r->has_lifted ||
		       cJSON_AddNumberToObject(scene, "objects", (double)r->lifted.lifted.objects));
}

/* The folder's own name, also where it is called "." */
static int add_name(cJSON *page, const char *run)
{
	SCOPED char *full = realpath(run, NULL);
	int length;
	const char *last = path_last(full ? full : run, &length);
	SCOPED char *name = strndup(last, (size_t)length);
	return name && cJSON_AddStringToObject(page, "name", name) &&
	       cJSON_AddStringToObject(page, "version", VERSION);
}

/* What the page shows, but for the viewer. */
static cJSON *page_of(const struct report_run *r, const struct report *to, struct err *e)
{
	const char *run = r->options->run;
	struct report_outlines outlines = {0};
	cJSON *page = cJSON_CreateObject();

	*e = (struct err){0};
	const int fine = add_name(page, run) && add_scene(page, r) &&
			 report_add(page, "views", report_views(r, to, e)) &&
			 report_add(page, "sets", report_sentences(r, &outlines, e)) &&
			 report_add(page, "outlines", report_outlines_list(&outlines)) &&
			 report_add(page, "losses", report_losses(run, e)) &&
			 report_add(page, "steps", report_steps(run, e)) &&
			 report_add(page, "settings", report_settings(run, e));
	report_outlines_free(&outlines);
	if (fine)
		return page;
	if (!e->code)
		err_set(e, ERR_SYSTEM, "page: out of memory");
	cJSON_Delete(page);
	return NULL;
}

static int put_page(
	FILE *out, const struct report_run *r, const cJSON *page, const struct report *to, struct err *e)
{
	const char *data = strstr(report_page_begin, data_mark),
		   *viewer = strstr(report_page_begin, viewer_mark);

	if (!data || !viewer || viewer < data)
		return err_set(e, ERR_SYSTEM, "the page has no place for its data");
	fwrite(report_page_begin, 1, (size_t)(data - report_page_begin), out);
	if (report_json_put(out, page, e))
		return -1;
	data += sizeof data_mark - 1;
	fwrite(data, 1, (size_t)(viewer - data), out);
	if (report_viewer_put(out, r, to, e))
		return -1;
	fputs(viewer + sizeof viewer_mark - 1, out);
	return 0;
}

static int write_page(const struct report_run *r, const char *path, const struct report *to, struct err *e)
{
	cJSON *page = page_of(r, to, e);
	struct file_out out;

	if (!page || file_out_open(&out, path, e)) {
		cJSON_Delete(page);
		return -1;
	}
	int bad = put_page(out.stream, r, page, to, e);
	cJSON_Delete(page);
	if (!bad)
		return file_out_commit(&out, e);
	file_out_abort(&out);
	return -1;
}

int reporting_write(
	const struct report_options *options, const char *path, const struct report *to, struct err *e)
{
	struct report_run r = {0};
	const int bad = report_run_read(&r, options, to, e) || write_page(&r, path, to, e);

	report_run_free(&r);
	return bad ? -1 : 0;
}
