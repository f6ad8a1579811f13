#include "cmd/report/reporting.h"

#include "base/mem.h"
#include "cmd/render/draw.h"

#include <math.h>

enum { MOST_VIEWS = 6 };

/* data: the set whose masks grow by a copy. */
static int keep_mask(void *data, const struct mask *m, const struct mask *parts, size_t n, struct err *e)
{
	struct report_set *s = data;
	struct mask own = {.score = m->score, .visible = NAN};

	(void)parts, (void)n;
	own.view = mem_strdup(m->view, e);
	own.ref = mem_strdup(m->ref, e);
	own.object = m->object ? mem_strdup(m->object, e) : NULL;
	if (!own.view || !own.ref || (m->object && !own.object) ||
		rle_from_runs(&own.rle, m->rle.runs, m->rle.n, m->rle.height, m->rle.width, e)) {
		mask_free(&own);
		return -1;
	}
	s->masks.n++;
	return masks_add(&s->masks.set, &own, e);
}

int report_answer(const struct report_run *r, struct report_set *s, const struct report *to, struct err *e)
{
	const size_t most = r->options->views < MOST_VIEWS ? (size_t)r->options->views : MOST_VIEWS;
	const struct request_options options = {.scene = r->scene.path,
		.text = "text.safetensors",
		.model = r->lifted_path,
		.least = RESPONSES_LEAST};
	const struct draw_options how = {0};
	struct camera views[MOST_VIEWS];
	SCOPED size_t *refs = mem_alloc(s->text.n, sizeof *refs, "sentences", e);
	/* what is read stays the run's */
	struct request q = {&options, r->scene, s->text, r->lifted, s->text.n, refs, CHOOSE_ALL, {0}};
	struct drawing d = {.options = &how, .request = &q, .put = keep_mask, .data = s};

	if (!refs)
		return -1;
	for (size_t i = 0; i < s->text.n; i++)
		refs[i] = i;
	d.view_count = cameras_spread(&r->scene.cameras, most, (int)r->options->width, views);
	d.views = views;
	const int bad = draw_each(&d, NULL, to, e);
	d.views = NULL;
	drawing_free(&d);
	responses_free(&q.responses);
	return bad;
}
