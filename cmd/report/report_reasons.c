#include "cmd/report/reporting.h"

#include "base/mem.h"
#include "cmd/render/draw.h"

#include <math.h>

struct choosing {
	const struct report_run *run;
	const struct text *text;
	struct report_reason *reasons;
	struct choice *choices;
	float *probability; /* (n, objects) */
	char *chosen;
	int is_out_of_memory;
};

static struct viewpoint viewpoint_of(const struct choosing *c, size_t i)
{
	const char *view = c->text->views ? c->text->views[i] : "";
	const struct camera *camera = cameras_find(&c->run->scene.cameras, view);

	return (struct viewpoint){.kind = camera ? VIEWPOINT_CAMERA : VIEWPOINT_USUAL, .camera = camera};
}

static void watch(void *data, size_t i, const struct meaning *m)
{
	struct choosing *c = data;
	const struct explained x = {m, m->sentence->parse, c->text->texts[i]};

	explain_refusal(&x, c->reasons[i].refusal);
	if (!(c->reasons[i].explained = explain_meaning(&x, 1)))
		c->is_out_of_memory = 1;
}

static int choose_all(struct choosing *c, struct err *e)
{
	const struct lifted *l = &c->run->lifted.lifted;
	const struct text *t = c->text;
	const struct parser parser = {.weights = &c->run->lifted.weights, .encoder = t->encoder.hex};
	const struct choose_scene of = {l, &c->run->scene.splats, &c->run->scene.cameras, &parser, 1, NULL};
	const struct choose_watch watching = {c, watch};
	SCOPED struct choose_sentence *sentences = mem_alloc(t->n, sizeof *sentences, "sentences", e);

	if (!sentences || !(c->choices = mem_alloc(t->n, sizeof *c->choices, "sentences", e)) ||
		!(c->probability = mem_alloc(t->n, l->objects * sizeof *c->probability, "sentences", e)) ||
		!(c->chosen = mem_alloc(t->n, l->objects, "sentences", e)))
		return -1;
	for (size_t i = 0; i < t->n; i++)
		sentences[i] = asking_sentence(t, i, viewpoint_of(c, i));
	return choose(&of, sentences, t->n, CHOOSE_ALL, c->choices, c->probability, c->chosen, &watching, e);
}

/* The likeliest object that is chosen, or not chosen; objects where there is none. Takes it off. */
static size_t take_best(const float *probability, char *chosen, int is_chosen, size_t objects)
{
	size_t best = objects;

	for (size_t o = 0; o < objects; o++)
		if (chosen[o] == is_chosen && (best == objects || probability[o] > probability[best]))
			best = o;
	if (best < objects)
		chosen[best] = 2;
	return best;
}

static int take_answer(struct choosing *c, size_t i, struct err *e)
{
	const struct lifted *l = &c->run->lifted.lifted;
	const float *probability = c->probability + i * l->objects;
	char *chosen = c->chosen + i * l->objects;
	struct report_reason *to = &c->reasons[i];
	size_t o;

	if (!(to->things = mem_alloc(l->objects, sizeof *to->things, "answer", e)))
		return -1;
	to->there = c->choices[i].there;
	if (to->there < RESPONSES_LEAST)
		memset(chosen, 0, l->objects);
	while ((o = take_best(probability, chosen, 1, l->objects)) < l->objects)
		to->things[to->count++] = o;
	if ((o = take_best(probability, chosen, 0, l->objects)) < l->objects) {
		to->runner_up = l->names[o];
		to->runner_up_chance = to->there * (double)probability[o];
	}
	return 0;
}

int report_reasons(
	const struct report_run *r, const struct report_set *s, struct report_reason *reasons, struct err *e)
{
	struct choosing c = {.run = r, .text = &s->text, .reasons = reasons};
	int bad;

	if (s->text.width != r->lifted.lifted.width)
		return err_set(e, ERR_FORMAT, "%s: is of sentences of another width than those of the run",
			r->lifted_path);
	bad = choose_all(&c, e);
	for (size_t i = 0; i < s->text.n && !bad; i++)
		bad = c.is_out_of_memory ? err_set(e, ERR_SYSTEM, "explanation: out of memory")
					 : take_answer(&c, i, e);
	mem_free_all(c.choices, c.probability, c.chosen);
	return bad ? -1 : 0;
}

void report_reasons_free(struct report_reason *reasons, size_t n)
{
	for (size_t i = 0; reasons && i < n; i++)
		mem_free_all(reasons[i].things, reasons[i].explained);
}

enum { MOST_VIEWS = 6 };

/* data: the set whose masks grow by a copy. */
static int keep_mask(void *data, const struct mask *m, const struct mask *parts, size_t n, struct err *e)
{
	struct report_set *s = data;
	struct mask own;

	(void)parts, (void)n;
	if (mask_copy(&own, m, m->ref, m->object, e))
		return -1;
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
	struct request q = {&options, r->scene, s->text, r->lifted, s->text.n, refs, CHOOSE_ALL, {0}, {0}};
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
	parser_memo_free(&q.memo);
	return bad;
}
