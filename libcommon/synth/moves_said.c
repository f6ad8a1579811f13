/* A sentence is drawn at random (a list of wordings, words for the thing, another thing, an event), judged,
 * and kept where nobody could doubt what it means. */
#include "synth/moves_judge.h"

#include "base/mem.h"
#include "synth/cameras.h"

#include <stdio.h>

enum { TRIES = 300, WANTED = 3, ABSENT = 1 };

/* Words for an object: none ("thing"), its noun, with its colour. */
static void describe(struct teller *t, struct phrase *p, int object, int words)
{
	const struct synth_object *o = &t->m->scene->objects[object];
	const struct synth_query noun = {.list = SYNTH_NOUNS, .of = o},
				 colour = {.list = SYNTH_COLOURS_SAID, .of = o};

	*p = (struct phrase){.sense = synth_anything};
	if (words > 0)
		synth_sense_add(&p->sense, p->noun = synth_draw(&t->words, &noun, &t->rng));
	if (words > 1)
		synth_sense_add(&p->sense, p->colour = synth_draw(&t->words, &colour, &t->rng));
	p->sense.maybe[SYNTH_COLOUR] = 0;
}

/* 1 where the phrase means that object alone. */
static int is_alone(const struct teller *t, const struct phrase *p, int object)
{
	for (int i = 0; i < t->n; i++)
		if (synth_sense_judge(&p->sense, &t->m->scene->objects[i]) != (i == object ? 1 : -1))
			return 0;
	return 1;
}

static int put_phrase(char *to, size_t room, const struct phrase *p, int is_plural)
{
	const char *noun = p->noun     ? (is_plural ? p->noun->more : p->noun->text)
			   : is_plural ? "things"
				       : "thing";

	return snprintf(to, room, "%s%s%s", p->colour ? p->colour->text : "", p->colour ? " " : "", noun);
}

/* %T %P the thing, the things; %A the other with its article; %Y the event. */
static void put_text(const struct draft *d, const char *frame, const char *event, char *to, size_t room)
{
	for (; *frame && room > 1; frame++) {
		int n = 1;
		if (*frame != '%') {
			*to = *frame;
		} else if (*++frame == 'Y') {
			put_text(d, event, "", to, room);
			n = (int)strlen(to);
		} else if (*frame == 'A') {
			n = snprintf(to, room, "the ");
			n += put_phrase(to + n, room - (size_t)n, &d->about, 0);
		} else {
			n = put_phrase(to, room, &d->thing, *frame == 'P');
		}
		to += n;
		room -= (size_t)n;
	}
	*to = 0;
}

static int has_other(enum synth_list kind)
{
	return (kind >= SYNTH_TOWARDS && kind <= SYNTH_CHANGES_PLACES) || kind >= SYNTH_WHILE;
}

/* Draws what is said; -1 where the other has no name of its own. */
static int draw(struct teller *t, struct draft *d)
{
	static const enum synth_list events[] = {
		SYNTH_RAISED, SYNTH_FALLS_DOWN, SYNTH_ROLLS_OFF, SYNTH_PUT_DOWN, SYNTH_ANY_MOVE};

	d->other = has_other(d->kind) ? (int)rng_below(&t->rng, (uint32_t)t->n) : -1;
	d->event = d->kind >= SYNTH_WHILE ? events[rng_below(&t->rng, 5)] : SYNTH_LISTS;
	describe(t, &d->thing, (int)rng_below(&t->rng, (uint32_t)t->n), (int)rng_below(&t->rng, 3));
	if (d->kind == SYNTH_PLAIN_THING && !d->thing.colour)
		return -1;
	for (int i = 0; i < t->n; i++)
		d->fits[i] = synth_sense_judge(&d->thing.sense, &t->m->scene->objects[i]);
	if (d->other < 0)
		return 0;
	if (d->thing.noun && d->fits[d->other] >= 0)
		return -1;
	describe(t, &d->about, d->other, 1 + (int)rng_below(&t->rng, 2));
	return is_alone(t, &d->about, d->other) &&
			       (d->kind < SYNTH_WHILE || moves_judge(t, d, d->event, d->other).is > 0)
		       ? 0
		       : -1;
}

/* The objects that are meant, and the time of the last of them; -1 where that could be argued. */
static int resolve(const struct teller *t, const struct draft *d, struct synth_moving_sentence *x)
{
	int n = 0, fitting = 0;

	x->objects = 0;
	for (int i = 0; i < t->n; i++) {
		const struct finding f =
			d->fits[i] < 0 ? (struct finding){-1, 0, 0} : moves_judge(t, d, d->kind, i);
		if (!f.is || (f.is > 0 && d->fits[i] == 0))
			return -1;
		fitting += d->fits[i] > 0;
		if (f.is < 0)
			continue;
		x->objects |= (uint64_t)1 << i;
		x->first = f.first;
		x->last = f.last;
		n++;
	}
	x->is_several = n > 1;
	return n ? n : fitting ? 0 : -1;
}

static int is_said(const struct synth_moving_sentences *list, const struct synth_moving_sentence *x)
{
	for (size_t i = 0; i < list->n; i++)
		if (!strcmp(list->items[i].text, x->text))
			return 1;
	return 0;
}

static int make_kind(
	struct synth_moving_sentences *list, struct teller *t, enum synth_list kind, struct err *e)
{
	int made[3] = {0};
	static const int wanted[3] = {ABSENT, WANTED, 1};

	for (int tries = 0; tries < TRIES; tries++) {
		struct draft d = {.kind = kind};
		struct synth_moving_sentence x = {.kind = kind};
		const int n = draw(t, &d) ? -1 : resolve(t, &d, &x), k = n > 1 ? 2 : n;
		const struct synth_query q = {.list = kind, .forms = k == 2 ? "p" : "s"};
		const struct synth_query event = {.list = d.event, .forms = "e"};
		const struct synth_row *row =
			n < 0 || made[k] == wanted[k] ? NULL : synth_draw(&t->said, &q, &t->rng);
		if (!row)
			continue;
		put_text(&d, row->text,
			kind >= SYNTH_WHILE ? synth_draw(&t->said, &event, &t->rng)->text : "", x.text,
			sizeof x.text);
		if (is_said(list, &x))
			continue;
		if (mem_grow((void **)&list->items, &list->capacity, list->n + 1, sizeof x, "sentences", e))
			return -1;
		list->items[list->n++] = x;
		made[k]++;
	}
	return 0;
}

int synth_moving_make(struct synth_moving_sentences *list, const struct synth_moves *m, int is_kept_back,
	uint64_t seed, struct err *e)
{
	SCOPED struct teller *t = mem_zalloc(1, sizeof *t, "sentences", e);
	int bad = !t ||
		  synth_wordings_load(
			  &t->words, is_kept_back ? SYNTH_TABLE_UNSEEN : SYNTH_TABLE_SENTENCES, e) ||
		  synth_wordings_load(&t->said, is_kept_back ? SYNTH_TABLE_MOVES_KEPT : SYNTH_TABLE_MOVES, e);

	if (!bad) {
		t->m = m;
		t->n = m->scene->object_count;
		rng_seed(&t->rng, seed, SYNTH_STREAM_MOVES + 1 + (uint64_t)is_kept_back);
		synth_cameras_reference(&m->scene->cameras, t->centre, t->right, t->away);
	}
	for (int k = SYNTH_MOTIONS; k < SYNTH_LISTS && !bad; k++)
		bad = make_kind(list, t, (enum synth_list)k, e);
	if (t) {
		synth_wordings_free(&t->words);
		synth_wordings_free(&t->said);
	}
	return bad ? -1 : 0;
}
