#include "cmd/ask/saying_drafts.h"

#include "base/mem.h"
#include "lang/kinds.h"

#include <math.h>
#include <stdio.h>

enum { FACT_TRIES = 60, STREAM_SAY = 7 };

/* A fact may hold, and surely does not. */
static const double likely = 0.4, unlikely = 0.1;

/* Relations that gs-synth has no training wording of. */
static const struct synth_row more_kinds[] = {{.list = SYNTH_SAID, .text = "larger than %A", .anchors = 1},
	{.list = SYNTH_SAID, .text = "smaller than %A", .anchors = 1},
	{.list = SYNTH_SAID, .text = "taller than %A", .anchors = 1},
	{.list = SYNTH_SAID, .text = "with %A on it", .anchors = 1},
	{.list = SYNTH_SAID, .text = "with nothing on it"}};

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

	return noun ? noun : d->facts.asking->model.lifted.names[object];
}

/* Only those stay that have the part, or that have not. */
static void narrow(struct drafter *d, enum saying_part kind, const char *text, int is_denied)
{
	for (size_t o = 0; o < d->objects; o++)
		if (saying_parts_have(&d->parts, o, kind, text) == is_denied)
			d->fits[o] = 0;
}

/* Only those stay of which it may hold, or may not. */
static void narrow_by_fact(struct drafter *d, const struct fact *f, int is_denied)
{
	for (size_t o = 0; o < d->objects; o++) {
		const double holds = facts_hold(&d->facts, f, o);
		d->fits[o] &= (is_denied ? 1 - holds : holds) > likely;
	}
}

static const struct fact *draw_look(struct drafter *d, size_t object)
{
	const char *text = draw_part(d, object, SAYING_LOOK);

	return text ? facts_look(&d->facts, text) : NULL;
}

static const struct fact *draw_fact(struct drafter *d, size_t object, int is_true)
{
	return facts_draw(&d->facts, object, is_true, &d->rng);
}

/* "small red mug": what it is called, with one look in `looks` of a hundred, and more seldom two. */
static void put_name(struct drafter *d, struct draft *to, size_t object, uint32_t looks, int narrows)
{
	const char *noun = draw_noun(d, object);
	const struct fact *first = NULL;

	for (int i = 0; i < 2 && is_likely(d, looks); i++) {
		const struct fact *look = draw_look(d, object);
		if (!look || look == first)
			continue;
		first = look;
		put(to, look->look);
		if (narrows)
			narrow_by_fact(d, look, 0);
	}
	put(to, noun);
	if (narrows)
		narrow(d, SAYING_NOUN, noun, 0);
}

/* "with nothing on it" */
static int is_with(const struct fact *f)
{
	return !strncmp(f->kind->text, "with ", 5);
}

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
		put_name(d, to, anchor, 30, 0);
		const struct fact *own = depth ? draw_fact(d, anchor, 1) : NULL;
		if (own) {
			if (!is_with(own))
				put(to, "that is");
			put_fact(d, to, own, 0);
		}
	}
	if (*t)
		put(to, t + (*t == ' '));
}

static size_t count_fitting(const struct drafter *d)
{
	size_t n = 0;

	for (size_t o = 0; o < d->objects; o++)
		n += (size_t)d->fits[o];
	return n;
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
			const double along = d->facts.centres[o][end / 2] - d->facts.centres[object][end / 2];
			if (!is_any && !saying_parts_have(&d->parts, o, SAYING_NOUN, noun))
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

/* What the object is not: a relation that does not hold, a look or a name of another that fits so far, what
 * another has. Behind an anchor, nothing that may be said of that. */
static void put_denial(struct drafter *d, struct draft *to, size_t object, int has_anchor)
{
	static const char *const nots[] = {", not the", "but not the"};
	const int is_near = count_fitting(d) > 1;
	size_t other;
	do
		other = rng_below(&d->rng, (uint32_t)d->objects);
	while (d->objects > 1 && (other == object || (is_near && !d->fits[other])));
	const struct fact *look = draw_look(d, other), *f = is_likely(d, 60) ? draw_fact(d, object, 0) : NULL;
	const char *has = draw_part(d, other, SAYING_HAVING);

	if (f) {
		put(to, has_anchor || is_with(f) || is_likely(d, 40) ? ", not the one" : "that is not");
		put_fact(d, to, f, 0);
		narrow_by_fact(d, f, 1);
	} else if (has && !has_anchor && is_likely(d, 30) &&
		   !saying_parts_have(&d->parts, object, SAYING_HAVING, has)) {
		put(to, "without");
		put(to, has + strcspn(has, " ") + 1);
		narrow(d, SAYING_HAVING, has, 1);
	} else if (look && facts_hold(&d->facts, look, object) < unlikely) {
		const int is_plain = !has_anchor && is_likely(d, 50);
		put(to, is_plain ? "that is not" : draw_text(d, nots, 2));
		put(to, look->look);
		if (!is_plain)
			put(to, "one");
		narrow_by_fact(d, look, 1);
	} else {
		put(to, draw_text(d, nots, 2));
		put_name(d, to, other, 30, 0);
		d->fits[other] = 0;
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
	const struct fact *look = draw_look(d, other);
	const char *has = draw_part(d, other, SAYING_HAVING);
	const struct fact *f = way < 7 ? draw_fact(d, object, way < 2) : NULL;

	if ((way < 2 && is_likely(d, 30)) || way == 9)
		if (look)
			put(to, look->look);
	if (way < 2)
		put_any_noun(d, to);
	else
		put(to, draw_noun(d, object));
	if (has && way > 6 && (way < 9 || !look))
		put(to, has);
	if (f)
		put_fact(d, to, f, 0);
}

/* One or two relations that hold. Returns how many there are. */
static int put_facts(struct drafter *d, struct draft *to, size_t object, int n)
{
	static const char *const copulas[] = {"", "", "that is", "which is", "standing", "lying"};

	for (int k = 0; k < n; k++) {
		const struct fact *f = draw_fact(d, object, 1);
		if (!f)
			return k;
		const char *before = k ? "and" : draw_text(d, copulas, 6);
		if (*before && (k || !is_with(f)))
			put(to, before);
		put_fact(d, to, f, is_likely(d, 12));
		narrow_by_fact(d, f, 0);
	}
	return n;
}

/* Returns whether it tells the object, as far as is known; a denial by what it says. */
static int try_draft(struct drafter *d, size_t object, int is_named, int is_denied, struct draft *to)
{
	const int is_ranked = is_named && !is_denied && is_likely(d, 10);
	const char *has = NULL;
	size_t before;

	*to = (struct draft){0};
	memset(d->fits, 1, d->objects);
	put(to, "the");
	if (is_ranked)
		put_ranking(d, to);
	if (is_named)
		put_name(d, to, object, is_denied ? 30 : 60, 1);
	else
		put(to, draw_thing(d));
	if (is_named && is_likely(d, is_denied ? 5 : 20) && (has = draw_part(d, object, SAYING_HAVING))) {
		put(to, has);
		narrow(d, SAYING_HAVING, has, 0);
	}
	const int facts = put_facts(d, to, object,
		is_named ? is_likely(d, is_denied ? 30 : 60) : 1 + (!is_denied && is_likely(d, 50)));
	before = count_fitting(d);
	if (is_denied)
		put_denial(d, to, object, facts || has);
	return is_ranked || (count_fitting(d) == 1 && (before > 1 || !is_denied));
}

void drafter_draw(struct drafter *d, size_t object, struct draft *to)
{
	const int is_absent = object == d->objects, is_counted = !is_absent && is_likely(d, 4),
		  is_named = is_likely(d, 55), is_denied = is_likely(d, 18);

	*to = (struct draft){0};
	put(to, "the");
	if (is_absent)
		put_absent(d, to);
	if (is_counted)
		put_ordinal(d, to, object);
	for (int i = 0; i < FACT_TRIES && !is_absent && !is_counted; i++)
		if (try_draft(d, object, is_named, is_denied, to))
			break;
}

/* Every look that is said of any object. */
static int learn_looks(struct drafter *d, struct err *e)
{
	for (size_t o = 0; o < d->objects; o++) {
		const struct saying_list *looks = &d->parts.lists[o * SAYING_KINDS + SAYING_LOOK];
		for (size_t i = 0; i < looks->n; i++) {
			const struct fact look = {looks->items[i], NULL, {d->objects, d->objects}};
			struct draft one = {0};
			put(&one, "the");
			put(&one, look.look);
			put(&one, "thing");
			if (!facts_look(&d->facts, look.look) &&
				facts_learn(&d->facts, &look, (const char *[]){one.text}, 1, e))
				return -1;
		}
	}
	d->facts.looks = d->facts.n;
	return 0;
}

/* Relations of a kind: to each object, to as many pairs, or to none. */
static int learn_kind(struct drafter *d, const struct synth_row *kind, struct err *e)
{
	const size_t n = kind->anchors < 1 ? 1 : d->objects > 1 ? d->objects : 0, none = d->objects;
	SCOPED struct draft *drafts = mem_zalloc(n, sizeof *drafts, "sentences", e);
	SCOPED struct fact *facts = mem_alloc(n, sizeof *facts, "sentences", e);
	SCOPED const char **texts = mem_alloc(n, sizeof *texts, "sentences", e);

	if (!drafts || !facts || !texts)
		return -1;
	for (size_t k = 0; k < n; k++) {
		const size_t other = n > 1 ? (k + 1 + rng_below(&d->rng, (uint32_t)n - 1)) % n : none;
		facts[k] = (struct fact){
			NULL, kind, {kind->anchors > 0 ? k : none, kind->anchors > 1 ? other : none}};
		put(&drafts[k], "the thing");
		put_fact(d, &drafts[k], &facts[k], 0);
		texts[k] = drafts[k].text;
	}
	return facts_learn(&d->facts, facts, texts, n, e);
}

int drafter_make(struct drafter *d, struct asking *a, uint64_t seed, struct err *e)
{
	char noun[KINDS_LENGTH];

	*d = (struct drafter){.objects = a->model.lifted.objects};
	d->fits = mem_alloc(d->objects, 1, "objects", e);
	int bad = !d->fits || facts_make(&d->facts, a, e) || saying_parts_read(&d->parts, a, e) ||
		  synth_wordings_load(&d->wordings, SYNTH_TABLE_SENTENCES, e);
	rng_seed(&d->rng, seed, STREAM_SAY);
	for (long at = 0; kinds_next(&at, noun);)
		d->nouns++;
	bad = bad || learn_looks(d, e);
	for (int i = 0; i < d->wordings.n && !bad; i++)
		if (d->wordings.rows[i].list == SYNTH_RELATIONS && d->wordings.rows[i].form == 'R')
			bad = learn_kind(d, &d->wordings.rows[i], e);
	for (size_t i = 0; i < sizeof more_kinds / sizeof *more_kinds && !bad; i++)
		bad = learn_kind(d, &more_kinds[i], e);
	return bad ? -1 : 0;
}

void drafter_free(struct drafter *d)
{
	saying_parts_free(&d->parts);
	synth_wordings_free(&d->wordings);
	facts_free(&d->facts);
	free(d->fits);
}
