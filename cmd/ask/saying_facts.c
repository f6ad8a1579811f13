#include "cmd/ask/saying_facts.h"

#include "base/mem.h"

enum { TRIES = 60 };

/* A relation surely holds, and surely does not. */
static const double sure = 0.5, unlikely = 0.1;

int facts_make(struct facts *f, struct asking *a, struct err *e)
{
	*f = (struct facts){.asking = a, .objects = a->model.lifted.objects};
	f->centres = mem_zalloc(f->objects, sizeof *f->centres, "objects", e);
	return f->centres ? 0 : -1;
}

void facts_free(struct facts *f)
{
	mem_free_all(f->items, f->holds, f->centres);
}

int facts_learn(struct facts *f, const struct fact *more, const char *const *texts, size_t n, struct err *e)
{
	const size_t all = f->n + n, bytes = f->objects * sizeof *f->holds;
	int bad = mem_grow((void **)&f->items, &f->room, all, sizeof *f->items, "relations", e) ||
		  mem_grow((void **)&f->holds, &f->holds_room, all * f->objects, sizeof *f->holds,
			  "relations", e);

	if (!bad)
		asking_expect(f->asking, texts, n);
	for (size_t k = 0; k < n && !bad; k++) {
		SCOPED_BY(asking_answer_free) struct asking_answer answer = {0};
		bad = asking_ask(f->asking, texts[k], 0, &answer, &report_silent, e);
		if (bad)
			break;
		memcpy(f->holds + f->n * f->objects, answer.holds, bytes);
		memcpy(f->centres, answer.centres, f->objects * sizeof *f->centres);
		f->items[f->n++] = more[k];
	}
	return bad ? -1 : 0;
}

double facts_hold(const struct facts *f, const struct fact *one, size_t object)
{
	return object == one->anchors[0] || object == one->anchors[1]
		       ? 0
		       : f->holds[(size_t)(one - f->items) * f->objects + object];
}

const struct fact *facts_draw(const struct facts *f, size_t object, int is_true, struct rng *r)
{
	const size_t relations = f->n - f->looks;

	for (int i = 0; i < TRIES && relations; i++) {
		const struct fact *one = &f->items[f->looks + rng_below(r, (uint32_t)relations)];
		const double holds = facts_hold(f, one, object);
		if (object != one->anchors[0] && object != one->anchors[1] &&
			(is_true ? holds > sure : holds < unlikely))
			return one;
	}
	return NULL;
}

const struct fact *facts_look(const struct facts *f, const char *text)
{
	for (size_t i = 0; i < f->n; i++)
		if (f->items[i].look && !strcmp(f->items[i].look, text))
			return &f->items[i];
	return NULL;
}
