#include "refer/trainer.h"

#include "base/mem.h"

#include <stdlib.h>

/* The Gaussians that learn, and their positions. */
static int choose_gaussians(
	struct trainer *t, const struct trainer_source *from, double tolerance, struct err *e)
{
	t->ids = mem_alloc(from->scene_gaussians, sizeof *t->ids, "ids", e);
	if (!t->ids || train_active_set(from->views, from->view_count, from->scene_gaussians, tolerance,
			       t->ids, &t->n, e))
		return -1;
	if (!t->n)
		return err_set(e, ERR_FORMAT, "no Gaussian has weight in a view with masks");
	t->position = mem_alloc(t->n, 3 * sizeof(float), "positions", e);
	if (!t->position || train_bounds(from->means, t->ids, t->n, t->low, t->high, e))
		return -1;
	train_positions(from->means, t->ids, t->n, t->low, t->high, t->position);
	return 0;
}

static int init(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	if (choose_gaussians(t, from, o->tolerance, e))
		return -1;
	const struct step_setup setup = {.layout = &t->layout,
		.similarity = o->similarity,
		.contrast = o->contrast,
		.temperature = o->temperature,
		.lambda = o->lambda,
		.gaussians = t->n,
		.ids = t->ids,
		.scene_gaussians = from->scene_gaussians,
		.position = t->position,
		.sentences = from->sentences,
		.offsets = from->offsets,
		.words = from->words,
		.objects = from->objects,
		.pixels = from->pixels,
		.batch = (int)o->batch};
	t->step = step_new(&setup, e);
	if (!t->step ||
		train_order_init(
			&t->order, from->views, from->view_count, (int)o->batch, (uint64_t)o->seed, e) ||
		train_state_init(&t->state, &t->layout, t->n, (uint64_t)o->seed, e))
		return -1;
	return 0;
}

int trainer_init(
	struct trainer *t, const struct trainer_source *from, const struct trainer_options *o, struct err *e)
{
	*t = (struct trainer){.rates = o->rates};
	refer_layout_init(&t->layout, o->interaction, from->text_width);
	int bad = init(t, from, o, e);
	if (bad)
		trainer_free(t);
	return bad;
}

void trainer_free(struct trainer *t)
{
	step_free(t->step);
	train_order_free(&t->order);
	train_state_free(&t->state);
	free(t->ids);
	free(t->position);
	*t = (struct trainer){0};
}

struct step_losses trainer_step(struct trainer *t)
{
	return train_step(&t->state, t->step, &t->order, &t->rates, t->n);
}
