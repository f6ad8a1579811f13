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

static int refuse(struct asking_answer *found, const struct asking *a, struct err *e)
{
	if (asking_answer_make(found, a->model.lifted.objects, e))
		return -1;
	snprintf(found->reason, sizeof found->reason, "it does not say which thing is meant");
	return 0;
}

/* "How tall is it?", and nothing was spoken of. */
static int is_of_nothing(const struct question_asked *q)
{
	const int may_be = q->kind != QUESTION_WHICH && (q->kind != QUESTION_SET || q->relation >= 0);
	int is = 0;

	for (int k = 0; k < 3 && may_be; k++)
		is |= talk_points(q->text[k]);
	return is;
}

static int answer(struct answer_told *t, struct asking_answer *found, struct asking *a, struct talk *talk,
	const struct report *to, struct err *e)
{
	const struct meaning_set *of = talk_understand(
		talk, a->model.lifted.names, a->model.lifted.objects, t->question, t->understood);
	chooser_within(a->chooser, of);
	question_read(&t->asked, t->understood, 0);
	if (of && t->asked.kind == QUESTION_LIST) { /* "name them" */
		t->asked.kind = QUESTION_WHICH;
		snprintf(t->asked.text[0], sizeof t->asked.text[0], "all the things");
	}
	int bad = is_of_nothing(&t->asked) ? refuse(found, a, e) : kinds_answer(t, found, a, to, e);
	chooser_within(a->chooser, NULL);
	/* "how many mugs are brown? how many are blue?": of the mugs, as no brown one is */
	if (!bad && of && t->asked.kind == QUESTION_NUMBER && !found->count && talk_is_of_looks(talk)) {
		asking_answer_free(found);
		*t->value = 0;
		bad = kinds_answer(t, found, a, to, e);
	}
	if (bad)
		return -1;
	if (talk)
		talk_take(talk,
			&(struct talk_answer){a->model.lifted.names, a->model.lifted.objects, &t->asked,
				t->understood, found->things, found->count, found->runner_up, t->is_unsure},
			of != NULL);
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
