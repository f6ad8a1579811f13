/* What is mended in analyses (lang/analysis_mend.c) that were made wrong here by hand, and settled in parses
 * (lang/parse_settle.c). */
#include "lang/parser.h"
#include "mend_help.h"
#include "unit.h"

#include <stdio.h>

static void mends_all(void)
{
	const char *stool = "the stool behind the lamp and the vase";
	mends(stool, ". T P . A2 . . L", PARSE_BEHIND, 7, ROLE_ANCHOR, 2, 0);
	/* what nobody is at two of at once stays */
	mends("the stool on the rug and the vase", ". T P . A2 . . L", PARSE_ON, 7, ROLE_ALSO, ROOT, 0);

	mends("a lamp under the oak top of the desk", ". T P . a . . . A2", PARSE_BELOW, 4, ROLE_NONE, ROOT,
		0);
	mends("a lamp under the oak desk", ". T P . a A2", PARSE_BELOW, 4, ROLE_ATTRIBUTE, 5, 0);

	mends("a plate in the background", ". T . . P", PARSE_FRONT, 4, ROLE_PREDICATE, ROOT, PARSE_BEHIND);
	mends("a plate in the background", ". T . . .", 0, 4, ROLE_PREDICATE, ROOT, PARSE_BEHIND);
	mends("a plate by the cup in the foreground", ". T P . A2 . . P4", PARSE_BEHIND, 7, ROLE_PREDICATE, 4,
		PARSE_FRONT);
	mends("a plate with a red background", ". T P . a5 A2", PARSE_WITH, 5, ROLE_ANCHOR, 2, 0);

	const char *sofa = "the chair at the greatest distance from the sofa";
	mends(sofa, ". T . . . P . . A5", PARSE_NEAR, 4, ROLE_PREDICATE, ROOT, PARSE_FAR);
	mends(sofa, ". T . . . P . . A5", PARSE_NEAR, 8, ROLE_ANCHOR, 4, 0);
	mends("the chair the least way from the sofa", ". T . . P . . A4", PARSE_FAR, 3, ROLE_PREDICATE, ROOT,
		PARSE_NEAR);

	const char *way = "the chair the longest way from the grey sofa";
	mends(way, ". T . . . . . a .", 0, 3, ROLE_PREDICATE, ROOT, PARSE_FAR);
	mends(way, ". T . . . . . a .", 0, 8, ROLE_ANCHOR, 3, 0);
	mends(way, ". T . . . . . a .", 0, 7, ROLE_ATTRIBUTE, 8, 0);

	mends("the door that isn't brown", ". T . . . a", 0, 5, ROLE_EXCEPT, ROOT, 0);
	mends("the door that is brown", ". T . . a", 0, 4, ROLE_ATTRIBUTE, ROOT, 0);

	const char *chair = "the chair beside the grey one";
	mends(chair, ". T P . a .", PARSE_NEAR, 5, ROLE_ANCHOR, 2, 0);
	mends(chair, ". T P . a .", PARSE_NEAR, 4, ROLE_ATTRIBUTE, 5, 0);
	mends("the chair, the grey one", ". T . a .", 0, 3, ROLE_ATTRIBUTE, ROOT, 0);
}

/* What hangs on a part hangs on the thing; what comes before is not the anchor of what comes after. */
static void mends_attachment(void)
{
	struct tokens t;
	struct analysis a, grammar;

	tokens_take(&t, "the pot by the hinge of the gate left of the barn", NULL, NULL, 0);
	grammar_analyse(&grammar, &t);
	a = made(&t, ". T P . A2 . . A8 P4 . . A8", PARSE_NEAR);
	analysis_mend(&a, &grammar, &t);
	CHECK(a.word[7].role == ROLE_ANCHOR && a.word[7].head == 2 && a.word[4].role == ROLE_NONE,
		"the gate is anchor of %d", a.word[7].head);
	CHECK(a.word[8].head == 7 && a.word[11].head == 8, "the gate is left of the barn: %d",
		a.word[8].head);

	tokens_take(&t, "the pot near the gate, left of the barn", NULL, NULL, 0);
	grammar_analyse(&grammar, &t);
	a = made(&t, ". T P . A5 P . . A5", PARSE_NEAR);
	analysis_mend(&a, &grammar, &t);
	CHECK(a.word[4].head == 2 && a.word[8].head == 5, "near the gate: %d", a.word[4].head);

	tokens_take(&t, "the jug plus the bowl by the door", NULL, NULL, 0);
	grammar_analyse(&grammar, &t);
	a = made(&t, ". T P . A2 P . A5", PARSE_NEAR);
	analysis_mend(&a, &grammar, &t);
	CHECK(a.word[4].role == ROLE_ALSO, "the bowl too: role %d", a.word[4].role);
}

/* Words that look like places or further things and are none; two sides; what is stated to be there. */
static void mends_readings(void)
{
	mends("any jug other than the grey one", ". T . . . a5 L", 0, 6, ROLE_EXCEPT, ROOT, 0);
	mends("where I left my jug", ". . P . T", PARSE_LEFT, 2, ROLE_NONE, ROOT, 0);
	mends("the jug left of my coat", ". T P . . A2", PARSE_LEFT, 2, ROLE_PREDICATE, ROOT, PARSE_LEFT);
	mends("pass me over the jug", ". . P . T", PARSE_ABOVE, 2, ROLE_NONE, ROOT, 0);
	mends("pass me the jug over the sink", ". . . T P . A4", PARSE_ABOVE, 4, ROLE_PREDICATE, ROOT,
		PARSE_ABOVE);

	const char *sides = "it has a coat on its left and a hat on its right";
	mends(sides, ". . . A6 . . P . . A6 . . P", PARSE_RIGHT, 9, ROLE_ANCHOR, 12, 0);
	mends(sides, ". . . A6 . . P . . A6 . . P", PARSE_RIGHT, 3, ROLE_ANCHOR, 6, 0);

	const char *nor = "the jug neither on the shelf nor by the door";
	mends(nor, ". T . P . A3 . P5 . A7", PARSE_NEAR, 7, ROLE_PREDICATE, 5, PARSE_NEAR);
	mends("behind the coat there is a jug", "P . A0 . . . A0", PARSE_BEHIND, 6, ROLE_TARGET, ROOT, 0);
	mends("the hat behind the coat there is a jug", ". T P . A2 . . . A2", PARSE_BEHIND, 8, ROLE_ANCHOR,
		2, 0);
}

/* What a word is said of, which of two predicates an anchor is of, and what is meant where nothing seems to
 * be. */
static void mends_neighbours(void)
{
	mends("the lamp left of the grey one", ". T P . . a A2", PARSE_LEFT, 5, ROLE_ATTRIBUTE, 6, 0);
	mends("the lamp over by the sink", ". T P P . A2", PARSE_NEAR, 5, ROLE_ANCHOR, 3, 0);
	mends("the lamp over by the sink", ". T P P . A2", PARSE_NEAR, 2, ROLE_NONE, ROOT, 0);
	mends("the lamp on the sink by the door", ". T P . A2 P . A5", PARSE_NEAR, 7, ROLE_ANCHOR, 5, 0);
	mends("the nearest lamp to the sink", ". P T P . A3", PARSE_NEAR, 5, ROLE_ANCHOR, 1, 0);
	mends("the nearest lamp to the sink", ". P T P . A3", PARSE_NEAR, 3, ROLE_NONE, ROOT, 0);
	mends("not the jug, the other lamp", ". . E . . E", 0, 5, ROLE_TARGET, ROOT, 0);
	mends("the goat on the rug", ". a P . A2", PARSE_ON, 1, ROLE_TARGET, ROOT, 0);
	mends("the red on the rug", ". a P . A2", PARSE_ON, 1, ROLE_ATTRIBUTE, ROOT, 0);
	mends("a jug in the middle between the lamp and the sink", ". T . . P P . A4 . . A5", PARSE_BETWEEN,
		7, ROLE_ANCHOR, 5, 0);
	mends("the lamp right of the sink", ". T P . . A2", PARSE_LEFT, 2, ROLE_PREDICATE, ROOT, PARSE_RIGHT);
	mends("the lamp with the sink right of it", ". T . . A5 P . .", PARSE_LEFT, 5, ROLE_PREDICATE, ROOT,
		PARSE_LEFT);
	const char *lamps = "all lamps except the one nearest to the sink";
	mends(lamps, ". T . . . P . . A5", PARSE_NEAR, 4, ROLE_EXCEPT, ROOT, 0);
	mends(lamps, ". T . . . P . . A5", PARSE_NEAR, 5, ROLE_PREDICATE, 4, PARSE_NEAR);
	mends("the lamp nearest to the sink", ". T P . . A2", PARSE_NEAR, 2, ROLE_PREDICATE, ROOT,
		PARSE_NEAR);
	mends("not the jug nor the other lamp", ". . E . . . E", 0, 6, ROLE_EXCEPT, ROOT, 0);
	mends("brighter than the lamp", "P . . T", PARSE_LARGER, 0, ROLE_ATTRIBUTE, ROOT, 0);
	mends("taller than the lamp", "P . . T", PARSE_TALLER, 0, ROLE_PREDICATE, ROOT, PARSE_TALLER);
}

/* What is neither here nor there is neither: the second is denied of the same thing as the first. */
static void mends_nor(void)
{
	struct tokens t;
	struct analysis a, grammar;

	tokens_take(&t, "the jug neither on the shelf nor by the door", NULL, NULL, 0);
	grammar_analyse(&grammar, &t);
	a = made(&t, ". T . P . A3 . P5 . A7", PARSE_NEAR);
	a.word[3].negated = 1;
	analysis_mend(&a, &grammar, &t);
	CHECK(a.word[7].head == ROOT && a.word[7].negated, "by the door: of %d", a.word[7].head);
}

/* Whether a predicate is denied once it is mended. */
static void denies(const char *text, const char *roles, enum parse_relation relation, int word, int negated)
{
	const struct analysis a = mended(text, roles, relation);

	CHECK(a.word[word].role == ROLE_PREDICATE && a.word[word].relation == PARSE_NEAR &&
			a.word[word].negated == negated && !analysis_has_anchor(&a, word),
		"'%s': role %d, %s, %d", text, a.word[word].role, parse_relation_name(a.word[word].relation),
		a.word[word].negated);
}

/* Places that are said twice; what stands by itself; what "it" is. */
static void mends_places(void)
{
	const char *top = "the jug on the very top";
	mends(top, ". T P . . P", PARSE_ABOVE, 2, ROLE_NONE, ROOT, 0);
	mends(top, ". T P . . P", PARSE_ABOVE, 5, ROLE_PREDICATE, ROOT, PARSE_ABOVE);
	mends("the jug right by the door", ". T P P . A3", PARSE_NEAR, 2, ROLE_NONE, ROOT, 0);
	mends("the jug by the door, near me", ". T P . A2 P A5", PARSE_NEAR, 5, ROLE_PREDICATE, ROOT,
		PARSE_NEAR);
	mends("the jug by the lamp by the door", ". T P . A2 P . A5", PARSE_NEAR, 2, ROLE_PREDICATE, ROOT,
		PARSE_NEAR);

	const char *one = "the jug left of the rightmost grey one";
	mends(one, ". T P . . P a A5", PARSE_LEFT, 7, ROLE_ANCHOR, 2, 0);
	mends(one, ". T P . . P a A5", PARSE_LEFT, 5, ROLE_PREDICATE, 7, PARSE_RIGHT);
	mends("the jug rightmost of the grey ones", ". T P . . a A2", PARSE_RIGHT, 6, ROLE_ANCHOR, 2, 0);
	const char *under = "the jug that the box is under";
	mends(under, ". T . . A6 . P", PARSE_BELOW, 6, ROLE_PREDICATE, ROOT, PARSE_ABOVE);
	mends(under, ". T . . A6 . P", PARSE_ABOVE, 6, ROLE_PREDICATE, ROOT, PARSE_ABOVE);
	mends("the jug that is under the box", ". T . . P . A4", PARSE_BELOW, 4, ROLE_PREDICATE, ROOT,
		PARSE_BELOW);
	mends("the clock on the white wall", ". T P . a A2", PARSE_ON, 2, ROLE_PREDICATE, ROOT, PARSE_WALL);
	mends("the clock on the white wall", ". T P . a A2", PARSE_ON, 5, ROLE_NONE, ROOT, 0);
	mends("the clock on the white box", ". T P . a A2", PARSE_ON, 2, ROLE_PREDICATE, ROOT, PARSE_ON);
	mends("the clock on the wall by the door", ". T P . A2 P4 . A5", PARSE_ON, 2, ROLE_PREDICATE, ROOT,
		PARSE_ON);

	denies("the jug all by itself", ". T . . P", PARSE_NEAR, 4, 1);
	denies("the jug that is not by itself", ". T . . . . P", PARSE_NEAR, 6, 0);
	denies("the isolated jug", ". a T", PARSE_NEAR, 1, 1);
	denies("the jug away from everything else", ". T P . A2 .", PARSE_FAR, 2, 1);
	mends("the jug away from the door", ". T P . . A2", PARSE_FAR, 2, ROLE_PREDICATE, ROOT, PARSE_FAR);

	const char *lamp = "the box on the rug with a lamp beside it";
	mends(lamp, ". T P . . . . A2 P .", PARSE_NEAR, 7, ROLE_ANCHOR, 8, 0);
	const char *sink = "the jug near the sink, not over it";
	mends(sink, ". T P . A2 . P .", PARSE_ABOVE, 7, ROLE_ANCHOR, 6, 0);
	mends("the jug near the sink with a lid over it", ". T P . A2 . . A8 P .", PARSE_SUPPORTS, 9,
		ROLE_NONE, ROOT, 0);
	mends("the jug left of it", ". T P . .", PARSE_LEFT, 4, ROLE_NONE, ROOT, 0);
}

static struct parse parsed(const char *text)
{
	struct parse p;
	struct err e;
	const struct parser grammar = {0};

	CHECK(!parse_sentence(&p, &grammar, text, NULL, &e), "%s", e.message);
	return p;
}

static int is_noun(const struct parse *p, const char *lemma)
{
	const struct parse_list *noun = &p->phrases[0].noun;

	return noun->n == 1 && !strcmp(p->words[noun->item[0]].lemma, lemma);
}

/* One of a group: its noun, how many are compared, and that nothing is left to compare with. */
static void groups(const char *text, const char *noun, int group)
{
	struct parse p = parsed(text);
	const struct parse_phrase *f = &p.phrases[0];

	CHECK(is_noun(&p, noun) && f->group == group && f->count == PARSE_ONE, "'%s': group %d, count %d",
		text, f->group, f->count);
	CHECK(p.clause_count == 1 && p.clauses[0].degree != PARSE_PLAIN && !p.clauses[0].anchors.n,
		"'%s': %d clauses", text, p.clause_count);
	parse_free(&p);
}

static void settles(void)
{
	groups("the taller of the three vases", "vase", 3);
	groups("wider than all the other shelves", "shelf", 0);

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
	p = parsed("of all the coats, the longest");
	CHECK(p.phrases[0].count == PARSE_ONE, "one coat: %d", p.phrases[0].count);
	parse_free(&p);
	p = parsed("the jug second nearest to the door");
	CHECK(p.phrases[0].ordinal == 2, "the second jug: %d", p.phrases[0].ordinal);
	parse_free(&p);
	p = parsed("both the jar and the lamp");
	CHECK(p.phrases[0].count == PARSE_ONE && p.phrases[0].also.n == 1, "a jar and a lamp: %d",
		p.phrases[0].count);
	parse_free(&p);
	p = parsed("the tallest lamp but two");
	CHECK(p.phrases[0].ordinal == 3, "the third: %d", p.phrases[0].ordinal);
	parse_free(&p);
	p = parsed("the jug near the grey sink, left of it");
	const struct parse_phrase *it = &p.phrases[p.phrase_count - 1];
	CHECK(p.phrase_count == 3 && it->noun.n == 1 && it->attributes.n == 1 &&
			!strcmp(p.words[it->noun.item[0]].text, "sink"),
		"it is the grey sink: %d phrases", p.phrase_count);
	parse_free(&p);
	p = parsed("the jug farthest from everything");
	CHECK(p.clause_count == 1 && p.clauses[0].relation == PARSE_NEAR && p.clauses[0].negated &&
			p.clauses[0].degree == PARSE_PLAIN,
		"near nothing: %d clauses", p.clause_count);
	parse_free(&p);
	p = parsed("taller than the lamp");
	CHECK(p.clauses[0].degree == PARSE_MORE && p.clauses[0].anchors.n == 1, "a lamp is compared with");
	parse_free(&p);
}

/* Each thing of a list is meant; commas between adjectives, and lists of anchors, are no such list. */
static void mends_lists(void)
{
	const char *three = "the coat, the grey rug and the jug";
	mends(three, ". T . a a . . L", 0, 1, ROLE_TARGET, ROOT, 0);
	mends(three, ". T . a a . . L", 0, 3, ROLE_ATTRIBUTE, 4, 0);
	mends(three, ". T . a a . . L", 0, 4, ROLE_ALSO, ROOT, 0);
	mends(three, ". T . a a . . L", 0, 7, ROLE_ALSO, ROOT, 0);
	const char *bare = "my coat, rug, and jug";
	mends(bare, ". T L . L", 0, 2, ROLE_ALSO, ROOT, 0);
	mends(bare, ". L T . L", 0, 1, ROLE_TARGET, ROOT, 0);
	mends(bare, ". L T . L", 0, 2, ROLE_ALSO, ROOT, 0);
	mends("the long, grey coat and the rug", ". a a T . . L", 0, 1, ROLE_ATTRIBUTE, ROOT, 0);
	mends("the coat by the door, the rug and the jug", ". T P . A2 . A2 . . A2", PARSE_NEAR, 6,
		ROLE_ANCHOR, 2, 0);
}

/* The sentence means a second thing, one or all, that has a relation to the first. */
static void carries(const char *text, int count, enum parse_relation r, const char *noun)
{
	const struct parser parser = {0};
	struct parse p = {0};
	struct err e;

	if (!CHECK(!parse_sentence(&p, &parser, text, NULL, &e), "%s", e.message))
		return;
	CHECK(p.phrases[0].also.n == (noun != NULL), "'%s': %d things more", text, p.phrases[0].also.n);
	if (noun && p.phrases[0].also.n) {
		const struct parse_phrase *f = &p.phrases[p.phrases[0].also.item[0]];
		const struct parse_clause *c = &p.clauses[f->clauses.item[0]];
		const struct parse_phrase *a = &p.phrases[c->anchors.item[0]];
		CHECK(f->count == count && c->relation == r, "'%s': %d, %s", text, f->count,
			parse_relation_name(c->relation));
		CHECK(a != &p.phrases[0] && a->noun.n && !strcmp(p.words[a->noun.item[0]].lemma, noun),
			"'%s': by what", text);
	}
	parse_free(&p);
}

static void carried_things(void)
{
	carries("the sled and whatever is on it", PARSE_ALL, PARSE_ON, "sled");
	carries("the sled and all the things behind it", PARSE_ALL, PARSE_BEHIND, "sled");
	carries("the sled and what it stands on", PARSE_ONE, PARSE_SUPPORTS, "sled");
	carries("both sleds and everything under them", PARSE_ALL, PARSE_BELOW, "sled");
	carries("the sled and the thing in it", PARSE_ONE, PARSE_INSIDE, "sled");
	carries("whatever is on the sled", 0, PARSE_ON, NULL);
}

/* One thing is meant, by an attribute. */
static void compared_with_all(void)
{
	static const char *const all[] = {"rounder than anything else on the shelf",
		"the sled that is rounder than any other sled", "rounder than all the others"};
	const struct parser parser = {0};
	struct parse p = {0};
	struct err e;

	for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
		CHECK(!parse_sentence(&p, &parser, all[i], NULL, &e), "%s", e.message);
		const struct parse_phrase *f = &p.phrases[0];
		CHECK(f->count == PARSE_ONE && !f->except.n && f->attributes.n == 1 &&
				!strcmp(p.words[f->attributes.item[0]].text, "rounder"),
			"'%s'", all[i]);
		parse_free(&p);
	}
}

int main(void)
{
	carried_things();
	compared_with_all();
	mends_all();
	mends_attachment();
	mends_readings();
	mends_nor();
	mends_places();
	mends_neighbours();
	mends_lists();
	settles();
	return unit_end();
}
