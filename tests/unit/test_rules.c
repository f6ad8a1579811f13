/* What the rules of lang/rules.def make of analyses that were made wrong here by hand, and of parses. */
#include "tests/unit/default_parser.h"
#include "lang/parser.h"
#include "lang/rules.h"
#include "rules_help.h"
#include "unit.h"

#include <stdio.h>

/* How something looks, and how it does not. */
static void looks(void)
{
	rules_make("the door that isn't brown", ". T . . . a", 0, 5, ROLE_EXCEPT, ROOT, 0);
	rules_make("the door that is brown", ". T . . a", 0, 4, ROLE_ATTRIBUTE, ROOT, 0);
	/* what is said of a noun stays */
	rules_make("the can, not the orange box", ". T . . a5 E", 0, 4, ROLE_ATTRIBUTE, 5, 0);
	rules_make("the can that is not by an orange box", ". T . . . P . a8 A5", PARSE_NEAR, 7,
		ROLE_ATTRIBUTE, 8, 0);
	rules_make("the darkest can", ". P T", PARSE_SMALLER, 1, ROLE_PREDICATE, ROOT, PARSE_OTHER);
	rules_make("the smallest can", ". P T", PARSE_SMALLER, 1, ROLE_PREDICATE, ROOT, PARSE_SMALLER);
	rules_make("the most colourful can", ". . a T", 0, 2, ROLE_PREDICATE, ROOT, PARSE_OTHER);
	rules_make("shinier than the pot", "a . . .", 0, 3, ROLE_ANCHOR, 0, 0);
	rules_make("the orange can", ". a T", 0, 1, ROLE_ATTRIBUTE, ROOT, 0);

	const struct analysis a = ruled("the empty vase", ". a T", 0);
	CHECK(a.word[1].role == ROLE_PREDICATE && a.word[1].relation == PARSE_SUPPORTS && a.word[1].negated,
		"an empty vase: role %d", a.word[1].role);
}

/* Whoever has the scarf is meant, where no anchor has been found. */
static void who(void)
{
	static const char said[] = "who is wearing the yellow scarf";

	rules_make(said, ". . P . a T", PARSE_WITH, 0, ROLE_TARGET, ROOT, 0);
	rules_make(said, ". . P . a T", PARSE_WITH, 2, ROLE_PREDICATE, ROOT, PARSE_WITH);
	rules_make(said, ". . P . a T", PARSE_WITH, 4, ROLE_ATTRIBUTE, 5, 0);
	rules_make(said, ". . P . a T", PARSE_WITH, 5, ROLE_ANCHOR, 2, 0);
	rules_make("who has a scarf on", ". . . T P", PARSE_SUPPORTS, 3, ROLE_ANCHOR, 4, 0);
	rules_make("who hides under the tray", ". . P . T", PARSE_BELOW, 4, ROLE_ANCHOR, 2, 0);
	rules_make("the man who has a scarf", ". T . P1 . A3", PARSE_WITH, 1, ROLE_TARGET, ROOT, 0);
}

static void places(void)
{
	rules_make("the lamp over by the sink", ". T P P . A2", PARSE_NEAR, 5, ROLE_ANCHOR, 3, 0);
	rules_make("the lamp over by the sink", ". T P P . A2", PARSE_NEAR, 2, ROLE_NONE, ROOT, 0);
	rules_make("the lamp on the sink by the door", ". T P . A2 P . A5", PARSE_NEAR, 7, ROLE_ANCHOR, 5, 0);

	const char *top = "the jug on the very top";
	rules_make(top, ". T P . . P", PARSE_ABOVE, 2, ROLE_NONE, ROOT, 0);
	rules_make(top, ". T P . . P", PARSE_ABOVE, 5, ROLE_PREDICATE, ROOT, PARSE_ABOVE);
	rules_make("the jug right by the door", ". T P P . A3", PARSE_NEAR, 2, ROLE_NONE, ROOT, 0);
	rules_make("the jug by the door, near me", ". T P . A2 P A5", PARSE_NEAR, 5, ROLE_PREDICATE, ROOT,
		PARSE_NEAR);
	rules_make("the jug by the lamp by the door", ". T P . A2 P . A5", PARSE_NEAR, 2, ROLE_PREDICATE,
		ROOT, PARSE_NEAR);

	rules_make("the vase in the back right corner", ". T . . . . P", PARSE_CORNER, 4, ROLE_PREDICATE,
		ROOT, PARSE_BEHIND);
	rules_make("the vase in the back right corner", ". T . . . . P", PARSE_CORNER, 5, ROLE_PREDICATE,
		ROOT, PARSE_RIGHT);
	rules_make("the vase in the blue corner", ". T . . . P", PARSE_CORNER, 4, ROLE_NONE, ROOT, 0);

	rules_make("the lamp nearest to us", ". T P . .", PARSE_NEAR, 4, ROLE_ANCHOR, 2, 0);
	rules_make("the lamp you gave to us", ". T . . . .", 0, 5, ROLE_NONE, ROOT, 0);
}

static struct parse parsed(const char *text)
{
	struct parse p;
	struct err e;
	const struct parser grammar = default_parser();

	CHECK(!parse_sentence(&p, &grammar, text, NULL, &e), "%s", e.message);
	return p;
}

static void counted(void)
{
	struct parse p = parsed("there are two coats, the second from the left");
	CHECK(p.phrases[0].ordinal == 2 && p.phrases[0].count == PARSE_ONE && p.phrases[0].group == 2,
		"one of two coats: ordinal %d count %d group %d", p.phrases[0].ordinal, p.phrases[0].count,
		p.phrases[0].group);
	parse_free(&p);
	p = parsed("the first two hooks from the left");
	CHECK(p.phrases[0].count == 2, "two hooks: %d", p.phrases[0].count);
	parse_free(&p);
	p = parsed("the two grey ones");
	CHECK(p.phrases[0].count == 2, "two ones: %d", p.phrases[0].count);
	parse_free(&p);
	p = parsed("the jug second nearest to the door");
	CHECK(p.phrases[0].ordinal == 2, "the second jug: %d", p.phrases[0].ordinal);
	parse_free(&p);
	p = parsed("taller than the lamp");
	CHECK(p.clauses[0].degree == PARSE_MORE && p.clauses[0].anchors.n == 1, "a lamp is compared with");
	parse_free(&p);
}

/* Words in these roles mean a second thing, one or all, that has a relation to the first. */
static void means_two(const char *text, const char *roles, int count, enum parse_relation r, const char *noun)
{
	struct tokens t;
	struct parse p;
	struct err e;

	tokens_take(&t, text, NULL, NULL, 0);
	const struct analysis a = ruled(text, roles, r);
	if (!CHECK(!parse_build(&p, &a, &t, 0, &e), "%s", e.message))
		return;
	CHECK(p.phrases[0].also.n == (noun != NULL), "'%s': %d things more", text, p.phrases[0].also.n);
	if (noun && p.phrases[0].also.n) {
		const struct parse_phrase *f = &p.phrases[p.phrases[0].also.item[0]];
		const struct parse_clause *c = &p.clauses[f->clauses.item[0]];
		const struct parse_phrase *by = &p.phrases[c->anchors.item[0]];
		CHECK(f->count == count && c->relation == r, "'%s': %d, %s", text, f->count,
			parse_relation_name(c->relation));
		CHECK(by != &p.phrases[0] && by->noun.n && !strcmp(p.words[by->noun.item[0]].lemma, noun),
			"'%s': by what", text);
	}
	parse_free(&p);
}

static void second_things(void)
{
	means_two("the sled and whatever is on it", ". T . L . P3 A5", PARSE_ALL, PARSE_ON, "sled");
	means_two("the sled and all the things behind it", ". T . . . L P5 A6", PARSE_ALL, PARSE_BEHIND,
		"sled");
	means_two("the sled and what it stands on", ". T . L A6 . P3", PARSE_ONE, PARSE_SUPPORTS, "sled");
	means_two("both sleds and everything under them", ". T . . P1 A4", PARSE_ALL, PARSE_BELOW, "sled");
	means_two("the sled and the thing in it", ". T . . L P4 A5", PARSE_ONE, PARSE_INSIDE, "sled");
	means_two("whatever is on the sled", "T . P0 . A2", 0, PARSE_ON, NULL);
	means_two("the sled and the red jug under it", ". T . . a5 L P5 A6", PARSE_ONE, PARSE_BELOW, "sled");
	means_two("the sled and also the two jugs to the left of it", ". T . . . . L . . P6 . A9", 2,
		PARSE_LEFT, "sled");
	means_two("the sled, and the jug that is nearest to it", ". T . . L . . P4 . A7", PARSE_ONE,
		PARSE_NEAR, "sled");
	means_two(
		"the sled and the jug it stands on", ". T . . L A7 . P4", PARSE_ONE, PARSE_SUPPORTS, "sled");
	means_two("the sled with a jug and a bell on it", ". T P . A2 . . A2 P1 A8", 0, PARSE_ON, NULL);
}

/* A rule that is left out does nothing, and a name that no rule has is told. */
static void left_out(void)
{
	struct list_name unknown;
	unsigned without = 0;
	struct tokens t;
	struct analysis a;

	CHECK(!rules_without("empty,isnt", &without, &unknown) &&
			without == (1U << RULE_empty | 1U << RULE_isnt),
		"%u", without);
	tokens_take(&t, "the empty vase", NULL, NULL, 0);
	a = made(&t, ". a T", 0);
	analysis_apply_rules(&a, &t, without);
	CHECK(a.word[1].role == ROLE_ATTRIBUTE, "an empty vase: role %d", a.word[1].role);
	CHECK(rules_without("empty,full", &without, &unknown) && list_name_is(&unknown, "full"),
		"no such rule");
	CHECK(!rules_without(NULL, &without, &unknown) && !without, "all rules");
}

int main(void)
{
	left_out();
	second_things();
	looks();
	who();
	places();
	counted();
	return unit_end();
}
