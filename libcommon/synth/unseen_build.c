/* Each build takes an object, describes it with random words, and adds what the build is about. Nothing here
 * looks whether the result is true: most is not, and is thrown away by who judges it. */
#include "synth/unseen_build.h"

#include <string.h>

#define BIT(x) (1u << (x))

static const struct synth_unseen_sense anything = {~0u, ~0u, ~0u, ~0u, 0, 0, 0};

static int is_likely(struct synth_unseen_draft *d, int in_hundred)
{
	return (int)rng_below(d->rng, 100) < in_hundred;
}

/* -1 where there is no room. */
static int new_phrase(struct synth_unseen_draft *d)
{
	struct synth_unseen *x = &d->x;

	if (x->phrase_count == SYNTH_UNSEEN_PHRASES)
		return -1;
	x->phrases[x->phrase_count] =
		(struct synth_unseen_phrase){.noun = "", .plural = "", .count = PARSE_ONE, .sense = anything};
	return x->phrase_count++;
}

static void add_colour(struct synth_unseen_draft *d, struct synth_unseen_phrase *p, enum synth_colour c)
{
	p->colour = synth_unseen_hue(c, d->rng);
	p->sense.colours = BIT(c);
	p->sense.maybe_colours = 0;
}

static void add_noun(struct synth_unseen_draft *d, struct synth_unseen_phrase *p, enum synth_shape s)
{
	const struct synth_unseen_noun *n = synth_unseen_noun(s, d->rng);

	p->noun = n->one;
	p->plural = n->many;
	p->sense.shapes = n->shapes;
	p->sense.maybe_shapes = n->maybe;
}

static void add_word(struct synth_unseen_phrase *p, const char *word)
{
	p->words[p->word_count++] = word;
}

/* Random true words for an object: so many in a hundred say colour, finish and size. */
static void describe(struct synth_unseen_draft *d, int phrase, int object, int colour, int finish, int size)
{
	struct synth_unseen_phrase *p = &d->x.phrases[phrase];
	const struct synth_object *o = &d->stand->objects[object];

	add_noun(d, p, o->shape);
	if (o->size != SYNTH_MEDIUM && is_likely(d, size)) {
		p->size = synth_unseen_size(o->size, d->rng);
		p->sense.sizes = BIT(o->size);
		p->sense.maybe_sizes = BIT(SYNTH_MEDIUM);
	}
	if (o->finish != SYNTH_PLAIN && is_likely(d, finish)) {
		add_word(p, synth_unseen_finish(o->finish, d->rng));
		p->sense.finishes = BIT(o->finish);
	}
	if (is_likely(d, colour))
		add_colour(d, p, o->colour);
}

/* A phrase that means that object alone, as briefly as a few tries find. -1: none. */
static int name_anchor(struct synth_unseen_draft *d, int object)
{
	int phrase = new_phrase(d);
	uint64_t set;

	for (int i = 0; i < 6 && phrase >= 0; i++) {
		d->x.phrases[phrase] = (struct synth_unseen_phrase){
			.noun = "", .plural = "", .count = PARSE_ONE, .sense = anything};
		describe(d, phrase, object, 30 * i + 20, 15 * i, 0);
		if (!synth_unseen_resolve(d->stand, &d->x, phrase, 0, &set) && set == (uint64_t)1 << object)
			return phrase;
	}
	return -1;
}

static int add_clause(
	struct synth_unseen_draft *d, int phrase, enum parse_relation r, enum parse_degree degree)
{
	struct synth_unseen *x = &d->x;
	struct synth_unseen_phrase *p = &x->phrases[phrase];

	if (x->clause_count == SYNTH_UNSEEN_CLAUSES || p->clause_count == SYNTH_UNSEEN_LIST)
		return -1;
	x->clauses[x->clause_count] = (struct synth_unseen_clause){.relation = r, .degree = degree};
	p->clauses[p->clause_count++] = x->clause_count;
	return x->clause_count++;
}

static int word_clause(struct synth_unseen_draft *d, int clause, int anchors, const char *forms)
{
	struct synth_unseen_clause *c = &d->x.clauses[clause];
	const struct synth_unseen_wording *w =
		synth_unseen_wording(c->relation, c->degree, anchors, forms, d->rng);

	if (!w)
		return -1;
	c->text = w->text;
	c->form = w->form;
	return 0;
}

static int other_object(struct synth_unseen_draft *d, int object)
{
	int o = (int)rng_below(d->rng, (uint32_t)d->stand->n - 1);

	return o + (o >= object);
}

/* What stands on it, or it stands on, for the relations that speak of that. */
static int stacked_object(const struct synth_stand *s, enum parse_relation r, int object)
{
	if (r == PARSE_ON)
		return s->objects[object].on;
	for (int i = 0; i < s->n; i++)
		if (s->objects[i].on == object)
			return i;
	return -1;
}

static int add_viewer(struct synth_unseen_draft *d, struct synth_unseen_clause *c)
{
	int phrase = new_phrase(d);

	if (phrase < 0)
		return -1;
	d->x.phrases[phrase].viewer = 1;
	d->x.phrases[phrase].noun = strrchr(c->text, ' ') + 1;
	c->anchors[c->anchor_count++] = phrase;
	return 0;
}

/* Anchors a clause on what stands there; `depth` more hops. */
static int add_relation(struct synth_unseen_draft *d, int phrase, int object, int depth, const char *forms)
{
	static const struct {
		enum parse_relation relation;
		enum parse_degree degree;
		int anchors, often;
	} kinds[] = {{PARSE_LEFT, PARSE_PLAIN, 1, 6}, {PARSE_RIGHT, PARSE_PLAIN, 1, 6},
		{PARSE_FRONT, PARSE_PLAIN, 1, 5}, {PARSE_BEHIND, PARSE_PLAIN, 1, 5},
		{PARSE_NEAR, PARSE_PLAIN, 1, 6}, {PARSE_BETWEEN, PARSE_PLAIN, 2, 4},
		{PARSE_ON, PARSE_PLAIN, 1, 3}, {PARSE_BELOW, PARSE_PLAIN, 1, 2},
		{PARSE_SUPPORTS, PARSE_PLAIN, 1, 3}, {PARSE_NEAR, PARSE_MOST, 1, 3},
		{PARSE_FAR, PARSE_MOST, 1, 2}, {PARSE_NEAR, PARSE_MOST, -1, 2},
		{PARSE_FAR, PARSE_MOST, -1, 1}, {PARSE_LEFT, PARSE_PLAIN, 0, 1},
		{PARSE_RIGHT, PARSE_PLAIN, 0, 1}, {PARSE_FRONT, PARSE_PLAIN, 0, 1},
		{PARSE_BEHIND, PARSE_PLAIN, 0, 1}, {PARSE_MIDDLE, PARSE_PLAIN, 0, 1}};
	int sum = 0, k = -1;

	for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
		sum += depth && kinds[i].anchors != 1 ? 0 : kinds[i].often;
	int at = (int)rng_below(d->rng, (uint32_t)sum);
	while (at >= 0) {
		k++;
		at -= depth && kinds[k].anchors != 1 ? 0 : kinds[k].often;
	}
	int clause = add_clause(d, phrase, kinds[k].relation, kinds[k].degree);
	if (clause < 0 || word_clause(d, clause, kinds[k].anchors, forms))
		return -1;
	struct synth_unseen_clause *c = &d->x.clauses[clause];
	if (kinds[k].anchors < 0)
		return add_viewer(d, c);
	for (int i = 0; i < kinds[k].anchors; i++) {
		int is_stack = c->relation == PARSE_ON || c->relation == PARSE_BELOW ||
			       c->relation == PARSE_SUPPORTS;
		int other =
			is_stack ? stacked_object(d->stand, c->relation, object) : other_object(d, object);
		if (other < 0)
			return -1;
		int anchor = depth ? new_phrase(d) : name_anchor(d, other);
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

static int target(struct synth_unseen_draft *d, int object, int colour, int finish, int size)
{
	d->x.phrase_count = d->x.clause_count = 0;
	new_phrase(d);
	describe(d, 0, object, colour, finish, size);
	return 0;
}

/* "the red one", "the blue thing" */
static void blur_noun(struct synth_unseen_draft *d, int with_one)
{
	struct synth_unseen_phrase *p = &d->x.phrases[0];
	int one = with_one && rng_below(d->rng, 2);

	p->noun = one ? "" : rng_below(d->rng, 2) ? "thing" : "object";
	p->plural = one ? "" : p->noun[0] == 't' ? "things" : "objects";
	p->sense.shapes = ~0u;
	p->sense.maybe_shapes = 0;
}

static int build_relation(struct synth_unseen_draft *d, int object, int two_hop)
{
	int two = !two_hop && is_likely(d, 12);

	target(d, object, 55, 25, 12);
	if (d->x.phrases[0].colour && is_likely(d, 12))
		blur_noun(d, 1);
	if (!two_hop && is_likely(d, 8))
		return 0;
	return add_relation(d, 0, object, two_hop, "phw") || (two && add_relation(d, 0, object, 0, "phw"));
}

static int build_not(struct synth_unseen_draft *d, int object)
{
	target(d, object, 60, 20, 0);
	if (add_relation(d, 0, other_object(d, object), 0, "p"))
		return -1;
	d->x.clauses[0].negated = 1;
	return d->x.clauses[0].degree != PARSE_PLAIN ? -1 : 0;
}

/* A phrase for another object of the target's shape, told by its colour, finish or a relation. */
static int leave_out(struct synth_unseen_draft *d, int object, int is_named)
{
	int phrase = new_phrase(d);

	if (phrase < 0)
		return -1;
	struct synth_unseen_phrase *p = &d->x.phrases[phrase], *t = &d->x.phrases[0];
	describe(d, phrase, object, 70, 20, 0);
	p->noun = is_named ? t->noun : "";
	p->plural = is_named ? t->plural : "";
	p->sense.shapes = t->sense.shapes;
	p->sense.maybe_shapes = t->sense.maybe_shapes;
	if (!p->colour && !p->word_count && !p->size && add_relation(d, phrase, object, 0, "p"))
		return -1;
	return phrase;
}

static int build_except(struct synth_unseen_draft *d, enum synth_unseen_build b, int object)
{
	int n = b == SYNTH_BUILD_NEITHER ? 2 : 1, is_other = strstr(d->fill.frame, "other %N") != NULL;

	target(d, object, b == SYNTH_BUILD_EXCEPT ? 30 : 0, 0, 0);
	for (int i = 0; i < n; i++) {
		int phrase = leave_out(d, other_object(d, object), rng_below(d->rng, 2) != 0);
		if (phrase < 0)
			return -1;
		struct synth_unseen_phrase *p = &d->x.phrases[0];
		p->except[p->except_count++] = d->fill.left_out[i] = phrase;
	}
	if (is_other)
		add_word(&d->x.phrases[0], "other");
	d->x.phrases[0].count = b == SYNTH_BUILD_EXCEPT ? PARSE_ALL : PARSE_ONE;
	return 0;
}

static int build_nothing(struct synth_unseen_draft *d, int object)
{
	target(d, object, 50, 10, 0);
	int clause = add_clause(d, 0, PARSE_SUPPORTS, PARSE_PLAIN), phrase = new_phrase(d);
	struct synth_unseen_clause *c = &d->x.clauses[clause];
	c->negated = 1;
	c->anchors[c->anchor_count++] = phrase;
	d->x.phrases[phrase].is_anything = 1;
	return 0;
}

static int build_ordinal(struct synth_unseen_draft *d, int object)
{
	static const enum parse_relation ends[] = {
		PARSE_LEFT, PARSE_RIGHT, PARSE_LEFT, PARSE_RIGHT, PARSE_FRONT, PARSE_BEHIND};

	target(d, object, 35, 5, 0);
	if (d->x.phrases[0].colour && is_likely(d, 25))
		blur_noun(d, 0);
	d->x.phrases[0].ordinal = 2 + (int)rng_below(d->rng, 3);
	d->x.phrases[0].from = ends[rng_below(d->rng, sizeof ends / sizeof *ends)];
	return 0;
}

static int build_ranked(struct synth_unseen_draft *d, int object, const enum parse_relation *relations, int n,
	enum parse_degree degree)
{
	target(d, object, 45, 5, 0);
	if (d->x.phrases[0].colour && is_likely(d, 20))
		blur_noun(d, 0);
	int clause = add_clause(d, 0, relations[rng_below(d->rng, (uint32_t)n)], degree);
	d->x.phrases[0].of_several = strstr(d->fill.frame, "of all the %P") != NULL;
	return word_clause(d, clause, 0, strstr(d->fill.frame, "%C") ? "c" : "p");
}

static int build_group(struct synth_unseen_draft *d, int object)
{
	static const enum parse_relation where[] = {
		PARSE_LEFT, PARSE_RIGHT, PARSE_LEFT, PARSE_RIGHT, PARSE_FRONT, PARSE_BEHIND, PARSE_MIDDLE};

	if (build_ranked(d, object, where, 7, PARSE_MORE))
		return -1;
	d->x.phrases[0].group = 2 + (d->x.clauses[0].relation == PARSE_MIDDLE || is_likely(d, 25));
	/* "the left one" compares, but does not say so. */
	d->x.clauses[0].degree = PARSE_PLAIN;
	return 0;
}

/* Nobody speaks of a tall plate. */
static int has_height(enum synth_shape s)
{
	return s == SYNTH_BOTTLE || s == SYNTH_CONE || s == SYNTH_CYLINDER || s == SYNTH_MUG ||
	       s == SYNTH_BOX;
}

static int build_compared(struct synth_unseen_draft *d, enum synth_unseen_build b, int object)
{
	static const enum parse_relation sizes[] = {PARSE_LARGER, PARSE_SMALLER, PARSE_TALLER, PARSE_SHORTER};

	if (build_ranked(d, object, sizes, has_height(d->stand->objects[object].shape) ? 4 : 2,
		    b == SYNTH_BUILD_MOST ? PARSE_MOST : PARSE_MORE))
		return -1;
	if (b == SYNTH_BUILD_PAIR)
		d->x.phrases[0].group = 2;
	if (b == SYNTH_BUILD_THAN) {
		int anchor = name_anchor(d, other_object(d, object));
		if (anchor < 0)
			return -1;
		struct synth_unseen_clause *c = &d->x.clauses[0];
		c->anchors[c->anchor_count++] = anchor;
	}
	return 0;
}

static int build_several(struct synth_unseen_draft *d, enum synth_unseen_build b, int object)
{
	target(d, object, 55, 0, 0);
	if (d->x.phrases[0].colour && is_likely(d, 30))
		blur_noun(d, 0);
	d->x.phrases[0].count = b == SYNTH_BUILD_ALL ? PARSE_ALL : 2 + (int)rng_below(d->rng, 2);
	return is_likely(d, 50) && add_relation(d, 0, object, 0, "phw") ? -1 : 0;
}

static int build_also(struct synth_unseen_draft *d, int object)
{
	target(d, object, 60, 20, 0);
	int phrase = name_anchor(d, other_object(d, object));
	if (phrase < 0)
		return -1;
	struct synth_unseen_phrase *p = &d->x.phrases[0];
	p->also[p->also_count++] = d->fill.left_out[0] = phrase;
	return 0;
}

static int build_function(struct synth_unseen_draft *d, int object)
{
	const struct synth_unseen_use *use = synth_unseen_use(d->stand->objects[object].shape, d->rng);

	if (!use)
		return -1;
	target(d, object, 50, 15, 0);
	blur_noun(d, 0);
	struct synth_unseen_clause *c = &d->x.clauses[add_clause(d, 0, PARSE_OTHER, PARSE_PLAIN)];
	for (; c->word_count < 2 && use->words[c->word_count]; c->word_count++)
		c->words[c->word_count] = use->words[c->word_count];
	c->does = use->shapes;
	c->may_do = use->maybe;
	d->fill.use = use->text;
	return 0;
}

int synth_unseen_build(struct synth_unseen_draft *d, enum synth_unseen_build b, int object, int two_hop)
{
	static const enum parse_relation ends[] = {
		PARSE_LEFT, PARSE_RIGHT, PARSE_LEFT, PARSE_RIGHT, PARSE_FRONT, PARSE_BEHIND};
	int frame = (int)rng_below(d->rng, (uint32_t)synth_unseen_frame_count(b));

	d->fill = (struct synth_unseen_fill){.frame = synth_unseen_frame(b, frame), .left_out = {-1, -1}};
	switch (b) {
	case SYNTH_BUILD_PLAIN:
	case SYNTH_BUILD_CHATTY:
		return build_relation(d, object, two_hop);
	case SYNTH_BUILD_NOT:
		return build_not(d, object);
	case SYNTH_BUILD_OTHER:
	case SYNTH_BUILD_NEITHER:
	case SYNTH_BUILD_EXCEPT:
		return build_except(d, b, object);
	case SYNTH_BUILD_NOTHING:
		return build_nothing(d, object);
	case SYNTH_BUILD_ORDINAL:
		return build_ordinal(d, object);
	case SYNTH_BUILD_EXTREME:
		return build_ranked(d, object, ends, 6, PARSE_MOST);
	case SYNTH_BUILD_GROUP:
		return build_group(d, object);
	case SYNTH_BUILD_MOST:
	case SYNTH_BUILD_PAIR:
	case SYNTH_BUILD_THAN:
		return build_compared(d, b, object);
	case SYNTH_BUILD_ALL:
	case SYNTH_BUILD_COUNT:
		return build_several(d, b, object);
	case SYNTH_BUILD_ALSO:
		return build_also(d, object);
	case SYNTH_BUILD_FUNCTION:
		return build_function(d, object);
	default:
		return -1;
	}
}

int synth_unseen_build_absent(struct synth_unseen_draft *d, int object)
{
	enum synth_unseen_build b = rng_below(d->rng, 2) ? SYNTH_BUILD_PLAIN : SYNTH_BUILD_CHATTY;
	const struct synth_stand *s = d->stand;
	int how = (int)rng_below(d->rng, 3);

	if (synth_unseen_build(d, b, object, 0))
		return -1;
	struct synth_unseen_phrase *p = &d->x.phrases[0];
	if (how == 0) { /* something that is in no scene */
		const struct synth_unseen_noun *n = synth_unseen_foreign(d->rng);
		p->noun = n->one;
		p->plural = n->many;
		p->sense.shapes = p->sense.maybe_shapes = 0;
		p->word_count = 0;
		p->size = NULL;
		p->sense.finishes = p->sense.sizes = ~0u;
	} else if (how == 1) { /* a colour that another thing has */
		enum synth_colour c = s->objects[other_object(d, object)].colour;
		add_colour(d, p, c);
		p->sense.maybe_colours = synth_unseen_near_hues(c);
		return *p->noun && strcmp(p->noun, "thing") && strcmp(p->noun, "object") ? 0 : -1;
	} else if (!d->x.clause_count) { /* a relation that does not hold */
		return -1;
	}
	return 0;
}
