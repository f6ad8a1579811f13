#include "cmd/ask/reply.h"

static int draw(struct answer_told *t, const char *path, struct err *e)
{
	char caption[256];
	const char *const words[] = {t->question, caption};

	answer_caption(t, caption, sizeof caption);
	if (!t->drawn.view && t->asking->given.n)
		t->drawn.view = t->asking->given.views;
	t->picture = path;
	return answer_picture(t->asking, t->answer, words, path, &t->drawn, e);
}

static int answer(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	if (distance_ask(a, t->question, found, &t->distance, to, e))
		return -1;
	return t->distance.is_asked ? 0 : asking_ask(a, t->question, found, to, e);
}

/* What is at a place in a view, and how it could be called. */
static int pick(struct answer_told *t, struct asking_answer *found, struct asking *a, int is_box,
	const struct report *to, struct err *e)
{
	t->is_picked = 1;
	if (picking_find(a, t->question, is_box, found, &t->drawn.view, e))
		return -1;
	return found->count ? calling_find(a, found->things[0], &t->calling, found->centres, to, e) : 0;
}

int reply_make(struct answer_told *told, struct asking_answer *found, struct asking *a, const char *question,
	const struct reply_options *o, const struct report *to, struct err *e)
{
	const char *place = o->point ? o->point : o->box;

	*told = (struct answer_told){.asking = a, .answer = found, .question = place ? place : question};
	if (place ? pick(told, found, a, !o->point, to, e) : answer(told, found, a, to, e))
		return -1;
	return o->picture && found->count ? draw(told, o->picture, e) : 0;
}
