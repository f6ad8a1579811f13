#include "cmd/ask/saying_drafts.h"

#include "base/mem.h"
#include "lang/kinds.h"

#include <math.h>
#include <stdio.h>

enum { FACT_TRIES = 60, STREAM_SAY = 7 };

/* A relation surely holds, may hold, and surely does not. */
static const double sure = 0.5, likely = 0.4, unlikely = 0.1;

/* Relations that gs-synth has no training wording of. */
static const struct synth_row compared[] = {
	{.list = SYNTH_SAID, .text = "larger than %A", .anchors = 1},
	{.list = SYNTH_SAID, .text = "bigger than %A", .anchors = 1},
	{.list = SYNTH_SAID, .text = "smaller than %A", .anchors = 1},
	{.list = SYNTH_SAID, .text = "taller than %A", .anchors = 1},
	{.list = SYNTH_SAID, .text = "shorter than %A", .anchors = 1},
};

static int is_likely(struct drafter *d, uint32_t in_hundred)
{
	return rng_below(&d->rng, 100) < in_hundred;
}

static const char *draw_text(struct drafter *d, const char *const *texts, uint32_t n)
{
	return texts[rng_below(&d->rng, n)];
}

static const char *draw_thing(struct drafter *d)
{
	static const char *const things[] = {"thing", "object", "item"};

	return draw_text(d, things, 3);
}

/* With a blank before it, where it is no comma. */
static void put(struct draft *to, const char *text)
{
	const int more = snprintf(
		to->text + to->n, SAYING_LENGTH - to->n, "%s%s", to->n && *text != ',' ? " " : "", text);

	to->n = to->n + (size_t)more < SAYING_LENGTH ? to->n + (size_t)more : SAYING_LENGTH - 1;
}

static const char *draw_part(struct drafter *d, size_t object, enum saying_part kind)
{
	return saying_parts_draw(&d->parts, object, kind, &d->rng);
}

static const char *draw_noun(struct drafter *d, size_t object)
{
	const char *synonym = is_likely(d, 30) ? draw_part(d, object, SAYING_SYNONYM) : NULL,
		   *noun = synonym ? synonym : draw_part(d, object, SAYING_NOUN);

	return noun ? noun : d->asking->model.lifted.names[object];
}

/* "small red mug": what it is called, with one look in `looks` of a hundred, and more seldom two. */
static void put_name(struct drafter *d, struct draft *to, size_t object, uint32_t looks)
{
	const char *noun = draw_noun(d, object), *first = NULL;

	for (int i = 0; i < 2 && is_likely(d, looks); i++) {
		const char *look = draw_part(d, object, SAYING_LOOK);
		if (look && look != first)
			put(to, first = look);
	}
	put(to, noun);
}

static const struct fact *draw_fact(struct drafter *d, size_t object, int is_true);

/* "left of the plate", in any wording, with names of the anchors in place of %A and %B; depth: what is true
 * of an anchor is said too. */
static void put_fact(struct drafter *d, struct draft *to, const struct fact *f, int depth)
{
	const struct synth_query q = {.list = SYNTH_SAID, .like = f->kind};
	const char *t = (f->kind->list == SYNTH_SAID ? f->kind : synth_draw(&d->wordings, &q, &d->rng))->text;
	char part[SAYING_LENGTH];

	for (const char *slot; (slot = strchr(t, '%')); t = slot + 2) {
		const size_t anchor = f->anchors[slot[1] == 'B'];
		t += *t == ' ';
		snprintf(part, sizeof part, "%.*s", slot > t ? (int)(slot - t - 1) : 0, t);
		if (*part)
			put(to, part);
		put(to, "the");
		put_name(d, to, anchor, 30);
		const struct fact *own = depth ? draw_fact(d, anchor, 1) : NULL;
		if (own) {
			put(to, "that is");
			put_fact(d, to, own, 0);
		}
	}
	if (*t)
		put(to, t + (*t == ' '));
}

/* How far a relation holds of an object; of its own anchors never. */
static double holds_of(const struct drafter *d, const struct fact *f, size_t object)
{
	return object == f->anchors[0] || object == f->anchors[1]
		       ? 0
		       : d->holds[(size_t)(f - d->facts) * d->objects + object];
}

/* A random relation that holds of an object, or plainly does not; NULL where none was met. */
static const struct fact *draw_fact(struct drafter *d, size_t object, int is_true)
{
	for (int i = 0; i < FACT_TRIES && d->fact_count; i++) {
		const struct fact *f = &d->facts[rng_below(&d->rng, (uint32_t)d->fact_count)];
		const double holds = holds_of(d, f, object);
		if (object != f->anchors[0] && object != f->anchors[1] &&
			(is_true ? holds > sure : holds < unlikely))
			return f;
	}
	return NULL;
}

/* Whether two relations, the second denied or not, together hold of that object alone. */
static int tell(
	const struct drafter *d, const struct fact *const facts[2], int n, int is_denied, size_t object)
{
	for (size_t o = 0; o < d->objects; o++) {
		const double first = holds_of(d, facts[0], o), second = n > 1 ? holds_of(d, facts[1], o) : 1;
		if (o != object && fmin(first, n > 1 && is_denied ? 1 - second : second) > likely)
			return 0;
	}
	return 1;
}

/* "the thing left of the plate and behind the mug", "left of the plate but not behind the mug": -1 where a
 * few tries find nothing that tells it. */
static int put_relations(struct drafter *d, struct draft *to, size_t object)
{
	const int n = 1 + is_likely(d, 50), is_denied = n > 1 && is_likely(d, 30);
	const struct fact *facts[2];

	for (int i = 0; i < FACT_TRIES; i++) {
		for (int k = 0; k < n; k++)
			if (!(facts[k] = draw_fact(d, object, !k || !is_denied)))
				return -1;
		if (!tell(d, facts, n, is_denied, object))
			continue;
		put(to, "the");
		put(to, draw_thing(d));
		put_fact(d, to, facts[0], is_likely(d, 10));
		if (n > 1) {
			put(to, is_denied ? "but not" : "and");
			put_fact(d, to, facts[1], is_likely(d, 10));
		}
		return 0;
	}
	return -1;
}

/* "leftmost" */
static void put_ranking(struct drafter *d, struct draft *to)
{
	const struct synth_query q = {.list = SYNTH_SAID, .forms = "c"};

	put(to, synth_draw(&d->wordings, &q, &d->rng)->text);
}

/* "the second box from the left" of what is called so; of all things where it is the only one. */
static void put_ordinal(struct drafter *d, struct draft *to, size_t object)
{
	static const char *const ends[] = {"from the left", "from the right", "from the front",
		"from the back"},
				 *const ordinals[] = {"first", "second", "third", "fourth", "last"};
	const char *noun = draw_noun(d, object);
	size_t of = 0, before = 0;

	for (int is_any = 0; of < 2 && is_any < 2; is_any++) {
		const uint32_t end = rng_below(&d->rng, 4);
		of = before = 0;
		noun = is_any ? draw_thing(d) : noun;
		for (size_t o = 0; o < d->objects; o++) {
			const double along = d->centres[o][end / 2] - d->centres[object][end / 2];
			if (!is_any && !saying_parts_have(&d->parts, o, noun))
				continue;
			of++;
			before += o != object && (end % 2 ? along > 0 : along < 0);
		}
		if (of < 2)
			continue;
		put(to, before + 1 == of && before ? ordinals[4] : ordinals[before < 3 ? before : 3]);
		put(to, noun);
		put(to, ends[end]);
	}
}

/* What the object is not: a relation that does not hold, a look or a name of another, what another has. */
static void put_denial(struct drafter *d, struct draft *to, size_t object)
{
	static const char *const nots[] = {", not", "but not", "other than"};
	const size_t other = rng_below(&d->rng, (uint32_t)d->objects);
	const enum saying_part kind = is_likely(d, 60) ? SAYING_LOOK : SAYING_HAVING;
	const char *part = draw_part(d, other, kind);
	const struct fact *f = is_likely(d, 50) || !part || other == object ? draw_fact(d, object, 0) : NULL;

	if (f) {
		put(to, is_likely(d, 70) ? "that is not" : ", not the one");
		put_fact(d, to, f, is_likely(d, 12));
	} else if (!part || other == object || is_likely(d, 25)) {
		put(to, draw_text(d, nots, 3));
		put(to, "the");
		put_name(d, to, other, 30);
	} else if (kind == SAYING_HAVING) {
		put(to, "without");
		put(to, part + strcspn(part, " ") + 1);
	} else if (is_likely(d, 50)) {
		put(to, "that is not");
		put(to, part);
	} else {
		put(to, draw_text(d, nots, 3));
		put(to, "the");
		put(to, part);
		put(to, "one");
	}
}

/* An everyday noun (lang/kinds.h). */
static void put_any_noun(struct drafter *d, struct draft *to)
{
	char noun[KINDS_LENGTH];
	long at = 0;

	for (uint32_t n = 1 + rng_below(&d->rng, d->nouns); n && kinds_next(&at, noun); n--)
		;
	put(to, noun);
}

/* What is not here, likely: another thing, or one of these with a look, a companion or a place that it has
 * not. */
static void put_absent(struct drafter *d, struct draft *to)
{
	const size_t object = rng_below(&d->rng, (uint32_t)d->objects),
		     other = rng_below(&d->rng, (uint32_t)d->objects);
	const uint32_t way = rng_below(&d->rng, 10);
	const char *look = draw_part(d, other, SAYING_LOOK), *has = draw_part(d, other, SAYING_HAVING);
	const struct fact *f = way < 7 ? draw_fact(d, object, way < 2) : NULL;

	if ((way < 2 && is_likely(d, 30)) || way == 9)
		if (look)
			put(to, look);
	if (way < 2)
		put_any_noun(d, to);
	else
		put(to, draw_noun(d, object));
	if (has && way > 6 && (way < 9 || !look))
		put(to, has);
	if (f)
		put_fact(d, to, f, 0);
}

void drafter_draw(struct drafter *d, size_t object, struct draft *to)
{
	static const char *const copulas[] = {"", "", "that is", "which is", "standing", "lying"};
	const struct fact *f;

	*to = (struct draft){0};
	if (object == d->objects) {
		put(to, "the");
		put_absent(d, to);
		return;
	}
	if (is_likely(d, 40) && !put_relations(d, to, object))
		return;
	put(to, "the");
	if (is_likely(d, 8)) {
		put_ordinal(d, to, object);
		return;
	}
	if (is_likely(d, 10))
		put_ranking(d, to);
	put_name(d, to, object, 60);
	const char *has = is_likely(d, 20) ? draw_part(d, object, SAYING_HAVING) : NULL;
	if (has)
		put(to, has);
	if (is_likely(d, 55) && (f = draw_fact(d, object, 1))) {
		const char *copula = draw_text(d, copulas, 6);
		if (*copula)
			put(to, copula);
		put_fact(d, to, f, is_likely(d, 12));
	}
	if (is_likely(d, 20))
		put_denial(d, to, object);
}

/* Of relations of a kind: to each object, to as many pairs, or to none. */
static int learn_kind(struct drafter *d, const struct synth_row *kind, struct err *e)
{
	const size_t n = kind->anchors < 1 ? 1
			 : d->objects > 1  ? d->objects
					   : 0,
		     before = d->fact_count, none = d->objects;
	SCOPED struct draft *drafts = mem_zalloc(n, sizeof *drafts, "sentences", e);
	SCOPED const char **texts = mem_alloc(n, sizeof *texts, "sentences", e);
	int bad = !drafts || !texts ||
		  mem_grow((void **)&d->facts, &d->fact_room, before + n, sizeof *d->facts, "relations", e) ||
		  mem_grow((void **)&d->holds, &d->holds_room, (before + n) * d->objects, sizeof *d->holds,
			  "relations", e);

	for (size_t k = 0; k < n && !bad; k++) {
		const size_t other = n > 1 ? (k + 1 + rng_below(&d->rng, (uint32_t)n - 1)) % n : none;
		d->facts[before + k] =
			(struct fact){kind, {kind->anchors > 0 ? k : none, kind->anchors > 1 ? other : none}};
		put(&drafts[k], "the thing");
		put_fact(d, &drafts[k], &d->facts[before + k], 0);
		texts[k] = drafts[k].text;
	}
	if (!bad)
		asking_expect(d->asking, texts, n);
	for (size_t k = 0; k < n && !bad; k++) {
		SCOPED_BY(asking_answer_free) struct asking_answer answer = {0};
		bad = asking_ask(d->asking, texts[k], 0, &answer, &report_silent, e);
		if (!bad) {
			memcpy(d->holds + (before + k) * d->objects, answer.holds,
				d->objects * sizeof *d->holds);
			memcpy(d->centres, answer.centres, d->objects * sizeof *d->centres);
		}
	}
	d->fact_count = before + n;
	return bad;
}

int drafter_make(struct drafter *d, struct asking *a, uint64_t seed, struct err *e)
{
	char noun[KINDS_LENGTH];

	*d = (struct drafter){.asking = a, .objects = a->model.lifted.objects};
	d->centres = mem_zalloc(d->objects, sizeof *d->centres, "objects", e);
	int bad =
		!d->centres || saying_parts_read(&d->parts, a, e) || synth_wordings_load(&d->wordings, 0, e);
	rng_seed(&d->rng, seed, STREAM_SAY);
	for (long at = 0; kinds_next(&at, noun);)
		d->nouns++;
	for (int i = 0; i < d->wordings.n && !bad; i++)
		if (d->wordings.rows[i].list == SYNTH_RELATIONS && d->wordings.rows[i].form == 'R')
			bad = learn_kind(d, &d->wordings.rows[i], e);
	for (size_t i = 0; i < sizeof compared / sizeof *compared && !bad; i++)
		bad = learn_kind(d, &compared[i], e);
	return bad ? -1 : 0;
}

void drafter_free(struct drafter *d)
{
	saying_parts_free(&d->parts);
	synth_wordings_free(&d->wordings);
	mem_free_all(d->facts, d->holds, d->centres);
}
