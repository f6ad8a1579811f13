#include "synth/unseen.h"

#include "base/mem.h"
#include "synth/occlusion.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>

enum { TRIES = 4000, FRAME_TRIES = 4, MAX_VIEWS = 64 };

/* Of what a camera shows of an object at least so much must be in sight, in cells of synth/occlusion.h and as
 * a share. */
enum { LEAST_CELLS = 12 };
static const double least_seen = 0.4;

/* From where sentences are said: the reference viewpoint, and the test cameras. */
struct places {
	struct synth_viewpoint reference, views[MAX_VIEWS];
	int n, camera[MAX_VIEWS]; /* of views */
};

struct maker {
	struct synth_sentences *list;
	struct rng rng;
	const struct places *places;
	int wanted;
};

const char *synth_unseen_kind_name(int kind)
{
	static const char *const names[SYNTH_UNSEEN_KINDS] = {"plain", "chatty", "two-hop", "negation",
		"ordinal", "comparative", "several", "function", "view", "absent"};

	return names[kind];
}

static int make_places(struct places *s, const struct synth_object *objects, int n,
	const struct synth_table *table, const struct cameras *cameras, struct err *e)
{
	int visible[SYNTH_MAX_OBJECTS], whole[SYNTH_MAX_OBJECTS];
	SCOPED_BY(synth_occlusion_free) struct synth_occlusion occlusion = {0};

	synth_viewpoint_reference(&s->reference, objects, n, table, cameras, 1);
	if (synth_occlusion_make(&occlusion, objects, n, e))
		return -1;
	for (size_t i = 0; i < cameras->n && s->n < MAX_VIEWS; i++) {
		const struct camera *c = &cameras->views[i];
		const double *m = c->world_to_camera[2];
		double centre[3], length = hypot(m[0], m[1]);
		if (c->split != SPLIT_TEST)
			continue;
		struct synth_viewpoint *v = &s->views[s->n];
		camera_centre(c, centre);
		synth_viewpoint_make(v, objects, n, table, centre,
			(double[2]){m[1] / length, -(m[0] / length)},
			(double[2]){m[0] / length, m[1] / length}, 1);
		synth_occlusion_look(&occlusion, c, visible, whole);
		v->visible = 0;
		for (int k = 0; k < n; k++)
			v->visible |=
				(uint64_t)(visible[k] >= LEAST_CELLS && visible[k] >= least_seen * whole[k])
				<< k;
		s->camera[s->n++] = (int)i;
	}
	return 0;
}

/* 1 where the same was said, or, for what is made `afresh`, a sentence of the kind that means the same with
 * the same relation. */
static int is_said(const struct synth_sentences *list, const struct synth_sentence *x, int afresh)
{
	for (size_t i = 0; i < list->n; i++) {
		const struct synth_sentence *y = &list->items[i];
		if (!strcmp(y->text, x->text) && y->view == x->view)
			return 1;
		if (afresh && x->objects && y->kind == x->kind && y->objects == x->objects &&
			!x->clause_count == !y->clause_count &&
			(!x->clause_count || (x->clauses[0].is.relation == y->clauses[0].is.relation &&
						     x->clauses[0].is.degree == y->clauses[0].is.degree)))
			return 1;
	}
	return 0;
}

/* Numbers the sentence within its kind and adds it; -1 with *e. */
static int add(struct maker *m, struct synth_sentence *x, struct err *e)
{
	int number = 1;

	for (size_t i = 0; i < m->list->n; i++)
		number += m->list->items[i].kind == x->kind;
	snprintf(x->ref, sizeof x->ref, "unseen-%s-%d", synth_unseen_kind_name(x->kind), number);
	return synth_sentences_add(m->list, x, e);
}

/* 1 where the target's words alone say as much as with its first clause. */
static int is_idle(const struct synth_viewpoint *v, const struct synth_sentence *x)
{
	struct synth_sentence bare = *x;
	uint64_t set;

	bare.phrases[0].clause_count = 0;
	return x->phrases[0].clause_count && !synth_resolve(v, &bare, 0, 0, &set);
}

static int write_sentence(struct synth_draft *d)
{
	for (int i = 0; i < FRAME_TRIES; i++)
		if (!synth_write(&d->s, d->frame, NULL, d->rng))
			return 0;
	return -1;
}

/* A sentence of the kind about an object of the scene, seen from `v`; -1 where chance made none. */
static int draft(struct maker *m, enum synth_unseen_kind kind, const struct synth_viewpoint *v, int object,
	struct synth_draft *d)
{
	const struct synth_query q = {.list = SYNTH_KINDS, .text = synth_unseen_kind_name(kind)};
	int is_absent = kind == SYNTH_UNSEEN_ABSENT;

	*d = (struct synth_draft){.w = &m->list->wordings,
		.v = v,
		.rng = &m->rng,
		.build = synth_draw(&m->list->wordings, &q, &m->rng)->frames,
		.s = {.kind = kind, .view = -1, .split = SPLIT_TEST, .object = object}};
	if ((is_absent ? synth_unseen_build_absent(d)
		       : synth_unseen_build(d, kind == SYNTH_UNSEEN_TWO_HOP)) ||
		synth_resolve(v, &d->s, 0, is_absent, &d->s.objects) || is_absent != !d->s.objects ||
		(d->s.objects & ~v->visible))
		return -1;
	if (!is_absent && is_idle(v, &d->s) && (kind != SYNTH_UNSEEN_PLAIN || rng_below(&m->rng, 8)))
		return -1;
	return write_sentence(d);
}

/* Makes one word of five letters or more wrong: two letters change places, one is missing, or one is there
 * twice. The first and last letters stay. */
static void slip(char *text, struct rng *rng)
{
	char *best = NULL;
	size_t length = 0;
	uint32_t n = 0;

	for (char *p = text; *p;) {
		size_t k = 0;
		while (islower((unsigned char)p[k]))
			k++;
		if (k >= 5 && (p == text || p[-1] == ' ') && (!p[k] || p[k] == ' ') && !rng_below(rng, ++n)) {
			best = p;
			length = k;
		}
		p += k ? k : 1;
	}
	if (!best || strlen(text) + 1 >= SYNTH_TEXT)
		return;
	char *at = best + 1 + rng_below(rng, (uint32_t)length - 3);
	uint32_t how = at[0] == at[1] ? 1 : rng_below(rng, 3);
	if (how == 0) {
		char letter = at[0];
		at[0] = at[1];
		at[1] = letter;
	} else if (how == 1) {
		memmove(at, at + 1, strlen(at));
	} else {
		memmove(at + 1, at, strlen(at) + 1);
	}
}

/* One in three with a capital and a full stop; some others without apostrophes or the question mark; one in
 * fourteen with a misspelt word. */
static void type(char *text, struct rng *rng)
{
	size_t n = strlen(text);

	if (!rng_below(rng, 3)) {
		text[0] = (char)toupper((unsigned char)text[0]);
		if (text[n - 1] != '?' && n + 1 < SYNTH_TEXT)
			memcpy(text + n, ".", 2);
	} else if (!rng_below(rng, 5)) {
		char *apostrophe = strchr(text, '\'');
		if (apostrophe)
			memmove(apostrophe, apostrophe + 1, strlen(apostrophe));
		if (text[strlen(text) - 1] == '?')
			text[strlen(text) - 1] = 0;
	}
	if (!rng_below(rng, 14))
		slip(text, rng);
}

static int make_kind(struct maker *m, enum synth_unseen_kind kind, struct err *e)
{
	struct synth_draft d;
	int n = m->places->reference.n;

	for (int i = 0, made = 0; made < m->wanted && i < TRIES; i++) {
		/* Every object in turn, so that none is left out. */
		int object = (made + i / 200) % n;
		if (draft(m, kind, &m->places->reference, object, &d) ||
			(kind <= SYNTH_UNSEEN_CHATTY && !(d.s.objects >> object & 1)))
			continue;
		type(d.s.text, &m->rng);
		if (is_said(m->list, &d.s, i < TRIES / 2))
			continue;
		if (add(m, &d.s, e))
			return -1;
		made++;
	}
	return 0;
}

/* The first view in which the same words plainly mean something else that is to be seen; -1. */
static int other_view(const struct maker *m, const struct synth_sentence *x, uint64_t *objects)
{
	const struct places *s = m->places;

	for (int i = 0; i < s->n; i++)
		if (s->camera[i] != x->view && !synth_resolve(&s->views[i], x, 0, 0, objects) &&
			*objects != x->objects && !(*objects & ~s->views[i].visible))
			return s->camera[i];
	return -1;
}

/* Puts words around a sentence, to be said of a picture; none around whole sentences. */
static int frame_view(struct synth_draft *d)
{
	const struct synth_query q = {.list = SYNTH_VIEW};
	char inner[SYNTH_TEXT];

	memcpy(inner, d->s.text, sizeof inner);
	int is_phrase = !strncmp(inner, "the ", 4) && !strchr(inner, '?');
	return synth_write(&d->s, is_phrase ? synth_draw(d->w, &q, d->rng)->text : "%I", inner, d->rng);
}

/* Sentences in pairs: the same words of two test pictures, with other answers. */
static int make_views(struct maker *m, struct err *e)
{
	const struct places *s = m->places;
	struct synth_draft d;

	for (int i = 0, made = 0; made < m->wanted && i < TRIES && s->n; i++) {
		int at = (int)rng_below(&m->rng, (uint32_t)s->n);
		uint64_t other;
		if (draft(m, SYNTH_UNSEEN_VIEW, &s->views[at], i % s->views[at].n, &d))
			continue;
		d.s.view = s->camera[at];
		int view = other_view(m, &d.s, &other);
		if (view < 0 || frame_view(&d))
			continue;
		type(d.s.text, &m->rng);
		if (is_said(m->list, &d.s, 0))
			continue;
		if (add(m, &d.s, e))
			return -1;
		d.s.view = view;
		d.s.objects = other;
		if (add(m, &d.s, e))
			return -1;
		made += 2;
	}
	return 0;
}

int synth_unseen_make(struct synth_sentences *list, const struct synth_object *objects, int n,
	const struct synth_table *table, const struct cameras *cameras, uint64_t seed, struct err *e)
{
	struct places *places = mem_zalloc(1, sizeof *places, "viewpoints", e);
	struct maker m = {.list = list, .places = places};

	*list = (struct synth_sentences){0};
	int bad = !places || synth_wordings_load(&list->wordings, SYNTH_TABLE_UNSEEN, e) ||
		  make_places(places, objects, n, table, cameras, e);
	for (int k = 0; k < SYNTH_UNSEEN_KINDS && !bad; k++) {
		/* A stream for each kind: more of one leave the others as they were. */
		rng_seed(&m.rng, seed, (uint64_t)SYNTH_STREAM_UNSEEN + (uint64_t)k);
		m.wanted = k <= SYNTH_UNSEEN_CHATTY ? n : n / 2 + 2;
		bad = k == SYNTH_UNSEEN_VIEW ? make_views(&m, e)
					     : make_kind(&m, (enum synth_unseen_kind)k, e);
	}
	free(places);
	return bad ? -1 : 0;
}
