/* Each build takes an object, describes it with random words, and adds what the build is about. Nothing here
 * looks whether the result is true: most is not, and is thrown away by who judges it. */
#include "synth/unseen.h"

#include <string.h>

static int is_likely(struct synth_draft *d, int in_hundred)
{
	return (int)rng_below(d->rng, 100) < in_hundred;
}

static void say_word(struct synth_draft *d, struct synth_phrase *p, enum synth_word w, int object)
{
	const struct synth_query q = {
		.list = synth_words_of(w), .of = &d->v->objects[object], .is_stepwise = w == SYNTH_NOUN};

	synth_say(p, w, synth_draw(d->w, &q, d->rng));
}

/* Random true words for an object: so many in a hundred say colour, finish and size. */
static void describe(struct synth_draft *d, int phrase, int object, int colour, int finish, int size)
{
	struct synth_phrase *p = &d->s.phrases[phrase];
	const struct synth_object *o = &d->v->objects[object];

	say_word(d, p, SYNTH_NOUN, object);
	if (o->size != SYNTH_MEDIUM && is_likely(d, size))
		say_word(d, p, SYNTH_SIZE_WORD, object);
	if (o->finish != SYNTH_PLAIN && is_likely(d, finish))
		say_word(d, p, SYNTH_FINISH_WORD, object);
	if (is_likely(d, colour))
		say_word(d, p, SYNTH_COLOUR_WORD, object);
	/* A colour that is there is called by its name. */
	p->sense.maybe[SYNTH_COLOUR] = 0;
}

/* A phrase that means that object alone, as briefly as a few tries find. -1: none. */
static int name_anchor(struct synth_draft *d, int object)
{
	int phrase = synth_add_phrase(&d->s);
	uint64_t set;

	for (int i = 0; i < 6 && phrase >= 0; i++) {
		d->s.phrase_count = phrase;
		synth_add_phrase(&d->s);
		describe(d, phrase, object, 30 * i + 20, 15 * i, 0);
		if (!synth_resolve(d->v, &d->s, phrase, 0, &set) && set == (uint64_t)1 << object)
			return phrase;
	}
	return -1;
}

static int word_clause(struct synth_draft *d, int clause, int anchors, const char *forms)
{
	struct synth_clause *c = &d->s.clauses[clause];
	const struct synth_row like = {
		.relation = c->is.relation, .degree = c->is.degree, .anchors = anchors};
	const struct synth_query q = {.list = SYNTH_SAID, .like = &like, .forms = forms, .is_stepwise = 1};

	c->said = synth_draw(d->w, &q, d->rng);
	return c->said ? 0 : -1;
}

/* Any but that. */
static int another(struct synth_draft *d, int object)
{
	int o = (int)rng_below(d->rng, (uint32_t)d->v->n - 1);

	return o + (o >= object);
}

static int other_object(struct synth_draft *d)
{
	return another(d, d->s.object);
}

/* An object for a relation of `object`: any, but of a stack the one that it can only be. -1: none. */
static int choose_other(struct synth_draft *d, enum parse_relation r, int object)
{
	if (r == PARSE_ON)
		return d->v->objects[object].on;
	if (r != PARSE_BELOW && r != PARSE_SUPPORTS)
		return another(d, object);
	for (int i = 0; i < d->v->n; i++)
		if (d->v->objects[i].on == object)
			return i;
	return -1;
}

static int add_viewer(struct synth_draft *d, struct synth_clause *c)
{
	int phrase = synth_add_phrase(&d->s);

	if (phrase < 0)
		return -1;
	d->s.phrases[phrase].viewer = 1;
	d->s.phrases[phrase].words[SYNTH_NOUN] = strrchr(c->said->text, ' ') + 1;
	c->anchors[c->anchor_count++] = phrase;
	return 0;
}

/* Anchors a clause on what stands there; `depth` more hops. */
static int add_relation(struct synth_draft *d, int phrase, int object, int depth, const char *forms)
{
	const struct synth_query q = {.list = SYNTH_RELATIONS, .forms = depth ? "1" : NULL};
	const struct synth_row *kind = synth_draw(d->w, &q, d->rng);
	int clause = synth_add_clause(&d->s, phrase, kind->relation, kind->degree);

	if (clause < 0 || word_clause(d, clause, kind->anchors, forms))
		return -1;
	struct synth_clause *c = &d->s.clauses[clause];
	if (kind->anchors < 0)
		return add_viewer(d, c);
	for (int i = 0; i < kind->anchors; i++) {
		int other = choose_other(d, kind->relation, object);
		if (other < 0)
			return -1;
		int anchor = depth ? synth_add_phrase(&d->s) : name_anchor(d, other);
		if (anchor < 0)
			return -1;
		c->anchors[c->anchor_count++] = anchor;
		if (depth) {
			describe(d, anchor, other, 60, 10, 0);
			if (add_relation(d, anchor, other, depth - 1, "p"))
				return -1;
		}
	}
	return 0;
}

/* "the red one", "the blue thing" */
static void blur_noun(struct synth_draft *d, int with_one)
{
	struct synth_phrase *p = &d->s.phrases[0];
	int is_one = with_one && rng_below(d->rng, 2), is_thing = !is_one && rng_below(d->rng, 2);

	p->words[SYNTH_NOUN] = is_one ? "" : is_thing ? "thing" : "object";
	p->plural = is_one ? "" : is_thing ? "things" : "objects";
	p->sense.surely[SYNTH_SHAPE] = ~0U;
	p->sense.maybe[SYNTH_SHAPE] = 0;
}

static int build_relation(struct synth_draft *d, int two_hop)
{
	int two = !two_hop && is_likely(d, 12), object = d->s.object;

	describe(d, 0, object, 55, 25, 12);
	if (d->s.phrases[0].words[SYNTH_COLOUR_WORD] && is_likely(d, 12))
		blur_noun(d, 1);
	if (!two_hop && is_likely(d, 8))
		return 0;
	return add_relation(d, 0, object, two_hop, "phw") || (two && add_relation(d, 0, object, 0, "phw"));
}

static int build_not(struct synth_draft *d)
{
	if (add_relation(d, 0, other_object(d), 0, "p"))
		return -1;
	d->s.clauses[0].negated = 1;
	return d->s.clauses[0].is.degree != PARSE_PLAIN ? -1 : 0;
}

/* A phrase for another object of the target's shape, told by its colour, finish or a relation. */
static int leave_out(struct synth_draft *d, int object, int is_named)
{
	int phrase = synth_add_phrase(&d->s);

	if (phrase < 0)
		return -1;
	struct synth_phrase *p = &d->s.phrases[phrase], *t = &d->s.phrases[0];
	describe(d, phrase, object, 70, 20, 0);
	p->words[SYNTH_NOUN] = is_named ? t->words[SYNTH_NOUN] : "";
	p->plural = is_named ? t->plural : "";
	p->sense.surely[SYNTH_SHAPE] = t->sense.surely[SYNTH_SHAPE];
	p->sense.maybe[SYNTH_SHAPE] = t->sense.maybe[SYNTH_SHAPE];
	if (!p->words[SYNTH_COLOUR_WORD] && !p->words[SYNTH_FINISH_WORD] &&
		add_relation(d, phrase, object, 0, "p"))
		return -1;
	return phrase;
}

static int build_except(struct synth_draft *d)
{
	struct synth_phrase *p = &d->s.phrases[0];

	while (p->except_count < (d->build == SYNTH_NEITHER ? 2 : 1)) {
		int is_named = rng_below(d->rng, 2) != 0, phrase = leave_out(d, other_object(d), is_named);
		if (phrase < 0)
			return -1;
		p->except[p->except_count++] = phrase;
	}
	if (strstr(d->frame, "other %N"))
		p->words[SYNTH_FINISH_WORD] = "other";
	p->count = d->build == SYNTH_EXCEPT ? PARSE_ALL : PARSE_ONE;
	return 0;
}

static int build_nothing(struct synth_draft *d)
{
	struct synth_clause *c = &d->s.clauses[synth_add_clause(&d->s, 0, PARSE_SUPPORTS, PARSE_PLAIN)];
	c->negated = 1;
	c->anchors[c->anchor_count++] = synth_add_phrase(&d->s);
	d->s.phrases[1].is_anything = 1;
	return 0;
}

static const enum parse_relation ends[] = {
	PARSE_LEFT, PARSE_RIGHT, PARSE_LEFT, PARSE_RIGHT, PARSE_FRONT, PARSE_BEHIND, PARSE_MIDDLE};
enum { ENDS = sizeof ends / sizeof *ends - 1 };

static int build_ordinal(struct synth_draft *d)
{
	d->s.phrases[0].ordinal = 2 + (int)rng_below(d->rng, 3);
	d->s.phrases[0].from = ends[rng_below(d->rng, ENDS)];
	return 0;
}

/* "the leftmost", "the left one of the two", "the biggest", "the bigger of the two", "bigger than that" */
static int build_ranked(struct synth_draft *d)
{
	static const enum parse_relation sizes[] = {PARSE_LARGER, PARSE_SMALLER, PARSE_TALLER, PARSE_SHORTER};
	enum synth_shape shape = d->v->objects[d->s.object].shape;
	int is_group = d->build == SYNTH_OF_GROUP, is_size = !is_group && d->build != SYNTH_EXTREME;
	/* Nobody speaks of a tall plate. */
	int is_flat =
		shape == SYNTH_PLATE || shape == SYNTH_BOOK || shape == SYNTH_BOWL || shape == SYNTH_BALL;
	uint32_t at = rng_below(d->rng, is_size ? (is_flat ? 2 : 4) : is_group ? ENDS + 1 : ENDS);
	int is_most = d->build == SYNTH_EXTREME || d->build == SYNTH_MOST;
	int clause =
		synth_add_clause(&d->s, 0, is_size ? sizes[at] : ends[at], is_most ? PARSE_MOST : PARSE_MORE);
	struct synth_phrase *p = &d->s.phrases[0];
	struct synth_clause *c = &d->s.clauses[clause];

	p->of_several = strstr(d->frame, "of all the %P") != NULL;
	if (word_clause(d, clause, 0, strstr(d->frame, "%Z") ? "c" : "p"))
		return -1;
	if (d->build == SYNTH_PAIR)
		p->group = 2;
	if (is_group) {
		p->group = 2 + (c->is.relation == PARSE_MIDDLE || is_likely(d, 25));
		/* "the left one" compares, but does not say so. */
		c->is.degree = PARSE_PLAIN;
	}
	if (d->build == SYNTH_THAN)
		c->anchors[c->anchor_count++] = name_anchor(d, other_object(d));
	return c->anchor_count && c->anchors[0] < 0 ? -1 : 0;
}

static int build_several(struct synth_draft *d)
{
	d->s.phrases[0].count = d->build == SYNTH_ALL ? PARSE_ALL : 2 + (int)rng_below(d->rng, 2);
	return is_likely(d, 50) && add_relation(d, 0, d->s.object, 0, "phw") ? -1 : 0;
}

static int build_also(struct synth_draft *d)
{
	struct synth_phrase *p = &d->s.phrases[0];

	p->also[0] = name_anchor(d, other_object(d));
	p->also_count = 1;
	return p->also[0] < 0 ? -1 : 0;
}

static int build_function(struct synth_draft *d)
{
	const struct synth_query q = {
		.list = SYNTH_USES, .of = &d->v->objects[d->s.object], .is_stepwise = 1};
	const struct synth_row *use = synth_draw(d->w, &q, d->rng);

	if (!use)
		return -1;
	describe(d, 0, d->s.object, 50, 15, 0);
	blur_noun(d, 0);
	d->s.clauses[synth_add_clause(&d->s, 0, PARSE_OTHER, PARSE_PLAIN)].said = use;
	return 0;
}

/* What a build adds to the target, and how many in a hundred targets say their colour and their finish, and
 * of those with a colour no shape. */
static const struct {
	int (*add)(struct synth_draft *d);
	int colour, finish, blurred;
} builds[SYNTH_FRAMES] = {
	[SYNTH_NOT] = {build_not, 60, 20, 0},
	[SYNTH_OTHER] = {build_except, 0, 0, 0},
	[SYNTH_NOTHING] = {build_nothing, 50, 10, 0},
	[SYNTH_NEITHER] = {build_except, 0, 0, 0},
	[SYNTH_ORDINAL] = {build_ordinal, 35, 5, 25},
	[SYNTH_EXTREME] = {build_ranked, 45, 5, 20},
	[SYNTH_OF_GROUP] = {build_ranked, 45, 5, 20},
	[SYNTH_MOST] = {build_ranked, 45, 5, 20},
	[SYNTH_PAIR] = {build_ranked, 45, 5, 20},
	[SYNTH_THAN] = {build_ranked, 45, 5, 20},
	[SYNTH_ALL] = {build_several, 55, 0, 30},
	[SYNTH_COUNT] = {build_several, 55, 0, 30},
	[SYNTH_ALSO] = {build_also, 60, 20, 0},
	[SYNTH_EXCEPT] = {build_except, 30, 0, 0},
};

int synth_unseen_build(struct synth_draft *d, int two_hop)
{
	const struct synth_query q = {.list = d->build};
	int blurred = builds[d->build].blurred;

	d->frame = synth_draw(d->w, &q, d->rng)->text;
	synth_add_phrase(&d->s);
	if (d->build == SYNTH_FUNCTION)
		return build_function(d);
	if (!builds[d->build].add)
		return build_relation(d, two_hop);
	describe(d, 0, d->s.object, builds[d->build].colour, builds[d->build].finish, 0);
	if (blurred && d->s.phrases[0].words[SYNTH_COLOUR_WORD] && is_likely(d, blurred))
		blur_noun(d, 0);
	return builds[d->build].add(d);
}

int synth_unseen_build_absent(struct synth_draft *d)
{
	int how = (int)rng_below(d->rng, 3);

	if (synth_unseen_build(d, 0))
		return -1;
	struct synth_phrase *p = &d->s.phrases[0];
	if (how == 0) { /* something that is in no scene */
		const struct synth_query q = {.list = SYNTH_FOREIGN};
		p->words[SYNTH_FINISH_WORD] = p->words[SYNTH_SIZE_WORD] = NULL;
		p->sense.surely[SYNTH_FINISH] = p->sense.surely[SYNTH_SIZE] = ~0U;
		synth_say(p, SYNTH_NOUN, synth_draw(d->w, &q, d->rng));
	} else if (how == 1) { /* a colour that another thing has */
		p->sense.surely[SYNTH_COLOUR] = ~0U;
		say_word(d, p, SYNTH_COLOUR_WORD, other_object(d));
		return *p->plural && strcmp(p->plural, "things") != 0 && strcmp(p->plural, "objects") != 0
			       ? 0
			       : -1;
	} else if (!d->s.clause_count) { /* a relation that does not hold */
		return -1;
	}
	return 0;
}
