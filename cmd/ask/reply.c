#include "cmd/ask/reply.h"

#include <string.h>

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

/* The other one of two: the answer less the thing that was answered before. */
static void take_other(struct asking_answer *found, size_t before)
{
	if (found->count != 1 || found->things[0] != before || found->runner_up == ASKING_NONE)
		return;
	found->things[0] = found->runner_up;
	found->runner_up = before;
}

static int answer(struct answer_told *t, struct asking_answer *found, struct asking *a, struct talk *talk,
	const struct report *to, struct err *e)
{
	char *const *names = a->model.lifted.names;
	const int is_other =
		talk_understand(talk, names, a->model.lifted.objects, t->question, t->understood);

	question_read(&t->asked, t->understood, 0);
	if (kinds_answer(t, found, a, to, e))
		return -1;
	if (is_other)
		take_other(found, talk->thing);
	t->is_unsure = t->is_unsure && !is_other;
	if (talk)
		talk_take(talk, t);
	return 0;
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
	struct talk *talk, const struct reply_options *o, const struct report *to, struct err *e)
{
	const char *place = o->point ? o->point : o->box;

	memset(told, 0, sizeof *told);
	told->asking = a;
	told->answer = found;
	told->question = place ? place : question;
	told->is_verbose = o->is_verbose;
	if (place ? pick(told, found, a, !o->point, to, e) : answer(told, found, a, talk, to, e))
		return -1;
	return o->picture && found->count ? draw(told, o->picture, e) : 0;
}
