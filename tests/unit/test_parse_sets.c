/* How many things a parse means, which of them by an ordinal, and of what set (lang/parse_counts.c,
 * parse_ordinals.c, parse_members.c), of analyses that were made by hand. */
#include "rules_help.h"
#include "unit.h"

#include <string.h>

static void counts(const char *text, const char *roles, int count, int group)
{
	struct parse p = built(text, roles, PARSE_SMALLER);
	const struct parse_phrase *f = &p.phrases[0];

	CHECK(f->count == count && f->group == group, "'%s': count %d, group %d", text, f->count, f->group);
	parse_free(&p);
}

static void ordinal(const char *text, const char *roles, int k, enum parse_relation from)
{
	struct parse p = built(text, roles, PARSE_NEAR);
	const struct parse_phrase *f = &p.phrases[0];

	CHECK(f->ordinal == k && (!k || f->from == from), "'%s': ordinal %d from %s", text, f->ordinal,
		parse_relation_name(f->from));
	parse_free(&p);
}

/* One of those that are told of first. */
static void counts_things(void)
{
	counts("both lamps", ". T", 2, 0);
	counts("two lamps, mine is broken", ". T . . a", PARSE_ONE, 2);
	counts("two lamps, not the red one. bring the other", ". T . . a5 E . . .", PARSE_ONE, 2);
	counts("both lamps are mine", ". T . .", 2, 0);
	counts("two lamps, not that lamp", ". T . . E", 2, 0);
	counts("two lamps and one small plate", ". T . . P5 L", 2, 0);
	counts("two lamps, the smallest", ". T . P", PARSE_ONE, 2);
	counts("the lamps at the back", ". T . . P", PARSE_SEVERAL, 0);
	counts("think of both lamps", ". . . T", 2, 0);
	counts("which of the lamps", ". . . T", PARSE_ONE, PARSE_SEVERAL);
	counts("all the lamps. the smallest", ". . T . P", PARSE_ONE, PARSE_ALL);
	counts("all but the smallest lamp", ". . . P4 E", PARSE_ONE, 0);
	counts("the tweezers", ". T", PARSE_ONE, 0);
	counts("an atlas", ". T", PARSE_ONE, 0);
}

/* Superlatives before a list choose from it; those within one do not. */
static void choices(const char *text, const char *roles, int among)
{
	struct parse p = built(text, roles, PARSE_SMALLER);
	const struct parse_phrase *f = &p.phrases[0];

	CHECK(f->among.n == among && f->also.n == !among && (!among || (f->clauses.n == 1 && !f->noun.n)),
		"'%s': one of %d, %d also", text, f->among.n, f->also.n);
	parse_free(&p);
}

/* What is said of all that are listed is said of each. */
static void shares(const char *text, const char *roles, int count, int attributes)
{
	struct parse p = built(text, roles, PARSE_SMALLER);
	const struct parse_phrase *f = &p.phrases[0];

	CHECK(f->count == count && f->attributes.n == attributes && f->also.n == 1,
		"'%s': count %d, %d attributes, %d also", text, f->count, f->attributes.n, f->also.n);
	parse_free(&p);
}

static void shares_what_is_said(void)
{
	shares("the lamp and the plate that are blue", ". T . . L . . a4", PARSE_ALL, 1);
	shares("the lamp and the plate that is blue", ". T . . L . . a4", PARSE_ONE, 0);
	shares("the lamp and the blue plate", ". T . . a5 L", PARSE_ONE, 0);
	shares("the lamp and the red plate that are small", ". T . . a5 L . . a5", PARSE_ALL, 1);
}

static void counts_choices(void)
{
	choices("the smallest of the lamp and the plate", ". P . . T . . L", 2);
	choices("the lamp and the smallest plate", ". T . . P5 L", 0);
	choices("the smallest lamp and the plate", ". P T . . L", 0);
}

/* "Last" and "second" of time and steps count nothing. */
static void counts_in_order(void)
{
	ordinal("the third lamp from the left", ". . T . . .", 3, PARSE_LEFT);
	ordinal("the lamp, third from the left", ". T . . . .", 3, PARSE_LEFT);
	ordinal("which lamp comes fourth, going left to right", ". T . . . . . .", 4, PARSE_LEFT);
	ordinal("a lamp I bought last week", ". T . . . .", 0, 0);
	ordinal("give me a second, the lamp", ". . . . . T", 0, 0);
	ordinal("the lamp that we put away first", ". T . . . . .", 0, 0);
	ordinal("a row of lamps, the third lamp", ". . . T . . .", 3, PARSE_OTHER);
	ordinal("the last lamp", ". . T", -1, PARSE_OTHER);
	ordinal("lamp number two", "T . .", 2, PARSE_OTHER);
	ordinal("the second nearest lamp", ". . P T", 2, PARSE_OTHER);
}

/* "Left to right" is a way and no place. */
static void tells_way(void)
{
	struct parse p = built("going left to right the second mug", ". P . P . . T", PARSE_RIGHT);

	CHECK(!p.clause_count && p.phrases[0].ordinal == 2 && p.phrases[0].from == PARSE_LEFT,
		"%d clauses, number %d", p.clause_count, p.phrases[0].ordinal);
	parse_free(&p);
	p = built("the mug to the left", ". T . . P", PARSE_LEFT);
	CHECK(p.clause_count == 1, "%d clauses", p.clause_count);
	parse_free(&p);
}

/* "Two boxes, a red one and a blue one" are a red box and a blue box. */
static void tells_members(void)
{
	struct parse p =
		built("two small boxes, a red one and a blue one", ". P T . a5 L . . a9 L", PARSE_SMALLER);
	const struct parse_phrase *f = &p.phrases[0];

	CHECK(f->count == PARSE_ONE && f->also.n == 1 && f->attributes.n == 1 && f->clauses.n == 1,
		"a red box: count %d, %d also, %d looks", f->count, f->also.n, f->attributes.n);
	const struct parse_phrase *other = &p.phrases[f->also.item[0]];
	CHECK(other->noun.n == 1 && other->clauses.n == 1 && other->attributes.n == 1 &&
			!strcmp(p.words[other->attributes.item[0]].text, "blue"),
		"a blue box: %d nouns", other->noun.n);
	parse_free(&p);

	p = built("two boxes and a cone", ". T . . L", PARSE_SMALLER);
	CHECK(p.phrases[0].count == 2 && p.phrases[0].also.n == 1, "two boxes and a cone are three");
	parse_free(&p);

	p = built("of the jar and the tin the smallest", ". . M . . M . P", PARSE_SMALLER);
	CHECK(p.phrases[0].among.n == 2 && p.phrases[0].group == 2 && p.phrases[0].count == PARSE_ONE,
		"of two: %d", p.phrases[0].group);
	parse_free(&p);
}

/* How many more than the target a sentence means that tells where it is. */
static void tells(const char *text, const char *roles, enum parse_relation relation, int also)
{
	struct parse p = built(text, roles, relation);

	CHECK(p.phrases[0].also.n == also, "'%s': %d more", text, p.phrases[0].also.n);
	parse_free(&p);
}

static void tells_places(void)
{
	tells("the sled and the jug behind it", ". A5 . . T P .", PARSE_BEHIND, 1);
	tells("there is the sled and the jug behind it", ". . . A7 . . T P .", PARSE_BEHIND, 0);
	tells("the sled and the jug. the bell behind it", ". . . . A7 . T P .", PARSE_BEHIND, 0);
	tells("a sled and a jug and the bell between them", ". A8 . . A8 . . T P .", PARSE_BETWEEN, 0);
}

/* What a thing is for is all that is said of it. */
static void tells_use(void)
{
	struct parse p = built(
		"a cone to put on the road to warn drivers, quick", ". T . P . . . . . . .", PARSE_OTHER);

	CHECK(p.clause_count == 1 && p.clauses[0].words.n == 4 && p.unexplained.n == 1,
		"%d words, %d unexplained", p.clauses[0].words.n, p.unexplained.n);
	parse_free(&p);
}

int main(void)
{
	tells_use();
	tells_places();
	counts_things();
	counts_choices();
	shares_what_is_said();
	counts_in_order();
	tells_way();
	tells_members();
	return unit_end();
}
