/* Another part of what closed-class words settle (analysis_mend.c): what a first sentence introduces for the
 * next one. */
#include "lang/analysis.h"
#include "lang/closed.h"

#include <string.h>

/* What the words before `end` say of what is meant is said of word noun, which is an anchor of word place. */
static void make_anchor(struct analysis *a, int noun, int end, int place)
{
	for (int i = 0; i < end; i++) {
		struct analysis_word *w = &a->word[i];
		if (w->head == ROOT && i != noun &&
			(w->role == ROLE_ATTRIBUTE || w->role == ROLE_NAME || w->role == ROLE_PREDICATE))
			w->head = noun;
	}
	a->word[noun] = (struct analysis_word){.role = ROLE_ANCHOR, .head = place};
	a->word[place].head = ROOT;
}

/* Where the second sentence begins, or -1; the first one says that something "is there". */
static int after_introduction(const struct tokens *t)
{
	int i = 0;

	while (i < t->n && tokens_class(t, i) == CLOSED_REQUEST)
		i++;
	if (!tokens_is(t, i, "there") && !tokens_is(t, i, "here"))
		return -1;
	if (tokens_class(t, i + 1) != CLOSED_BE)
		return -1;
	for (i += 2; i < t->n; i++)
		if (t->word[i].before == PAUSE_STOP)
			return i;
	return -1;
}

/* "There is a plate. Give me what is on it": what is on the plate. */
static void mend_introduced(struct analysis *a, const struct tokens *t)
{
	static const char *const things[] = {
		"what", "whatever", "thing", "something", "object", "everything", NULL};
	const int second = after_introduction(t);
	int noun = -1, thing = -1, place = -1;

	for (int i = 0; i < second; i++)
		if (a->word[i].role == ROLE_TARGET)
			noun = i;
	for (int i = second; i >= 0 && i < t->n; i++) {
		if (role_is_phrase(a->word[i].role) && !tokens_is_any(t, i, things) && !tokens_is(t, i, "it"))
			return;
		thing = thing < 0 && tokens_is_any(t, i, things) ? i : thing;
		place = analysis_is_predicate(a, i) && thing >= 0 ? i : place;
	}
	if (noun < 0 || place < 0 || !tokens_is(t, t->n - 1, "it") || analysis_has_anchor(a, place))
		return;
	make_anchor(a, noun, second, place);
	a->word[thing] = (struct analysis_word){.role = ROLE_TARGET, .head = ROOT};
	for (int i = second; i < t->n; i++)
		if (tokens_is(t, i, "it"))
			analysis_give_up(&a->word[i]);
}

/* The first phrase of the words before `end` where it is what they are about: what is meant, or the figure of
 * a place; or -1. */
static int subject_of(const struct analysis *a, int end)
{
	int i = 0;

	while (i < end && !role_is_phrase(a->word[i].role))
		i++;
	if (i == end || (a->word[i].role != ROLE_TARGET && a->word[i].role != ROLE_ANCHOR))
		return -1;
	return a->word[i].role == ROLE_TARGET || a->word[i].head > i ? i : -1;
}

/* The last place after word i that "it" is named for; or -1. */
static int place_of_it(const struct analysis *a, const struct tokens *t, int i)
{
	int found = -1;

	for (; i < t->n; i++)
		if (analysis_is_predicate(a, i) && !analysis_has_anchor(a, i) &&
			analysis_it_after(a, t, i) >= 0)
			found = i;
	return found;
}

/* "There is a ball on the big plate. Which mug is nearest to it?": the mug is meant, and it is the ball. */
static void mend_two_sentences(struct analysis *a, const struct tokens *t)
{
	int second = 1, other = -1;

	while (second < t->n && t->word[second].before != PAUSE_STOP)
		second++;
	const int first = second < t->n ? subject_of(a, second) : -1, place = place_of_it(a, t, second);
	if (first < 0 || place < 0 || t->word[first].closed >= 0)
		return;
	for (int i = second; i < place; i++)
		if (a->word[i].role == ROLE_TARGET && t->word[i].closed < 0 &&
			strcmp(t->word[i].lemma, t->word[first].lemma) != 0)
			other = i;
	if (other < 0)
		return;
	const int was = a->word[first].role == ROLE_ANCHOR ? a->word[first].head : -1;
	make_anchor(a, first, second, place);
	if (was >= 0)
		a->word[was].head = first;
}

void analysis_sentences(struct analysis *a, const struct tokens *t)
{
	mend_introduced(a, t);
	mend_two_sentences(a, t);
}
