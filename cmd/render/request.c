#include "cmd/render/request.h"

#include "base/list.h"
#include "base/mem.h"

#include <stdlib.h>

int request_read(struct request *r, const struct request_options *options, struct err *e)
{
	r->options = options;
	return scene_read(&r->scene, options->scene, e) || text_read(&r->text, options->text, e) ||
			       anymodel_read(&r->model, options->model, e)
		       ? -1
		       : 0;
}

int request_choose(struct request *r, struct err *e)
{
	const struct request_options *o = r->options;
	SCOPED char *chosen = mem_zalloc(r->text.n, 1, "sentences", e);
	struct list_name name;
	int bad = !chosen || !(r->refs = mem_alloc(r->text.n, sizeof *r->refs, "sentences", e)) ||
		  (o->refs && text_mark(&r->text, o->refs, "--refs", chosen, e));

	if (!bad && choose_without(o->without, &r->parts, &name))
		bad = err_set(e, ERR_USAGE, "--without: no part '%.*s'", (int)name.length, name.text);
	for (size_t i = 0; i < r->text.n && !bad; i++)
		if (o->refs ? chosen[i]
			    : o->sentences == REQUEST_ALL || (int)r->text.splits[i] == o->sentences)
			r->refs[r->count++] = i;
	return bad ? -1 : 0;
}

int request_viewpoint(const struct request *r, struct viewpoint *from, struct err *e)
{
	const char *text = r->options->viewpoint;

	if (viewpoint_read(from, text, &r->scene.cameras, r->scene.offset))
		return err_set(e, ERR_USAGE, "--viewpoint: '%s' is no view and no x,y,z", text);
	return 0;
}

int request_answer(struct request *r, const struct viewpoint *from, struct err *e)
{
	const struct request_options *o = r->options;
	const struct anymodel_ask ask = {&r->scene, &r->text, o->model, o->scene, o->text, r->refs, r->count,
		!o->is_plain, r->parts, o->least, o->wants_parts, from};

	responses_free(&r->responses);
	return anymodel_answer(&r->model, &ask, &r->responses, e);
}

void request_free(struct request *r)
{
	scene_free(&r->scene);
	text_free(&r->text);
	anymodel_free(&r->model);
	responses_free(&r->responses);
	free(r->refs);
}
