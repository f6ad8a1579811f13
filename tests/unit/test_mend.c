/* What is mended in analyses (lang/analysis_mend.c, analysis_places.c) that were made wrong here by hand, and
 * settled in parses (lang/parse_settle.c). */
#include "lang/parser.h"
#include "mend_help.h"
#include "unit.h"

#include <stdio.h>

/* How something looks, and how it does not. */
static void mends_looks(void)
{
	mends("the door that isn't brown", ". T . . . a", 0, 5, ROLE_EXCEPT, ROOT, 0);
	mends("the door that is brown", ". T . . a", 0, 4, ROLE_ATTRIBUTE, ROOT, 0);
	const char *can = "the can that isn't orange or red";
	mends(can, ". T . . . . . .", 0, 5, ROLE_EXCEPT, ROOT, 0);
	mends(can, ". T . . . . . a", 0, 7, ROLE_EXCEPT, ROOT, 0);
	mends("not very orange, the can", ". . . . T", 0, 2, ROLE_EXCEPT, ROOT, 0);
	/* what is said of a noun stays */
	mends("the can, not the orange box", ". T . . a5 E", 0, 4, ROLE_ATTRIBUTE, 5, 0);
	mends("the can that is not by an orange box", ". T . . . P . a8 A5", PARSE_NEAR, 7, ROLE_ATTRIBUTE, 8,
		0);
	mends("put the jug on the tray", ". . T P . A3", PARSE_ON, 3, ROLE_NONE, ROOT, 0);
	mends("could you put the jug on the red tray", ". . . . T P . a7 A5", PARSE_ON, 7, ROLE_NONE, ROOT,
		0);
	mends("she put the jug on the tray", ". . . T P . A4", PARSE_ON, 4, ROLE_PREDICATE, ROOT, PARSE_ON);
	mends("put the jug on the tray into it", ". . T P . A3 P .", PARSE_ON, 3, ROLE_PREDICATE, ROOT,
		PARSE_ON);
	mends("put a box around the jug on the tray", ". . . . . T P . A6", PARSE_ON, 6, ROLE_PREDICATE, ROOT,
		PARSE_ON);
	mends("move the jug to the left of the tray", ". . T . . P . . A5", PARSE_LEFT, 5, ROLE_NONE, ROOT,
		0);
	mends("move the jug left of the tray", ". . T P . . A3", PARSE_LEFT, 3, ROLE_PREDICATE, ROOT,
		PARSE_LEFT);
	mends("bring the jug on the tray", ". . T P . A3", PARSE_ON, 3, ROLE_PREDICATE, ROOT, PARSE_ON);
	mends("the cup left of both the jar and the tin", ". T P . . . A2 . . L", PARSE_LEFT, 9, ROLE_ANCHOR,
		2, 0);
	mends("the cup left of the jar and the tin", ". T P . . A2 . . L", PARSE_LEFT, 8, ROLE_ALSO, ROOT, 0);
	mends("the darkest can", ". P T", PARSE_SMALLER, 1, ROLE_PREDICATE, ROOT, PARSE_OTHER);
	mends("the smallest can", ". P T", PARSE_SMALLER, 1, ROLE_PREDICATE, ROOT, PARSE_SMALLER);
	mends("the most colourful can", ". . a T", 0, 2, ROLE_PREDICATE, ROOT, PARSE_OTHER);
	mends("shinier than the pot", "a . . .", 0, 3, ROLE_ANCHOR, 0, 0);
	mends("the orange can", ". a T", 0, 1, ROLE_ATTRIBUTE, ROOT, 0);

	mends("the lamp left of the grey one", ". T P . . a A2", PARSE_LEFT, 5, ROLE_ATTRIBUTE, 6, 0);
	mends("the ash-coloured vase", ". T . .", 0, 3, ROLE_TARGET, ROOT, 0);
	mends("the ash-coloured vase", ". T . .", 0, 1, ROLE_ATTRIBUTE, ROOT, 0);

	mends("a jug, pale green at the bottom", ". T a a . . P", PARSE_BELOW, 6, ROLE_NONE, ROOT, 0);
	mends("the jug at the bottom", ". T . . P", PARSE_BELOW, 4, ROLE_PREDICATE, ROOT, PARSE_BELOW);
	mends("a green jug at the bottom of it", ". a T . . P . A5", PARSE_BELOW, 5, ROLE_PREDICATE, ROOT,
		PARSE_BELOW);

	const char *other = "not the orange jug, the other one";
	mends(other, ". . a T . . .", 0, 3, ROLE_EXCEPT, ROOT, 0);
	mends(other, ". . a T . . .", 0, 2, ROLE_ATTRIBUTE, 3, 0);
	mends(other, ". . a T . . .", 0, 6, ROLE_TARGET, ROOT, 0);
	mends("not the orange jug, the other jug", ". . a T . . .", 0, 3, ROLE_TARGET, ROOT, 0);
	mends("the orange jug, the other one", ". a T . . .", 0, 2, ROLE_TARGET, ROOT, 0);

	const struct analysis a = mended("the empty vase", ". a T", 0);
	CHECK(a.word[1].role == ROLE_PREDICATE && a.word[1].relation == PARSE_SUPPORTS && a.word[1].negated,
		"an empty vase: role %d", a.word[1].role);
}

static void mends_places(void)
{
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

	mends("the lamp over by the sink", ". T P P . A2", PARSE_NEAR, 5, ROLE_ANCHOR, 3, 0);
	mends("the lamp over by the sink", ". T P P . A2", PARSE_NEAR, 2, ROLE_NONE, ROOT, 0);
	mends("the lamp on the sink by the door", ". T P . A2 P . A5", PARSE_NEAR, 7, ROLE_ANCHOR, 5, 0);

	const char *top = "the jug on the very top";
	mends(top, ". T P . . P", PARSE_ABOVE, 2, ROLE_NONE, ROOT, 0);
	mends(top, ". T P . . P", PARSE_ABOVE, 5, ROLE_PREDICATE, ROOT, PARSE_ABOVE);
	mends("the jug right by the door", ". T P P . A3", PARSE_NEAR, 2, ROLE_NONE, ROOT, 0);
	mends("the jug by the door, near me", ". T P . A2 P A5", PARSE_NEAR, 5, ROLE_PREDICATE, ROOT,
		PARSE_NEAR);
	mends("the jug by the lamp by the door", ". T P . A2 P . A5", PARSE_NEAR, 2, ROLE_PREDICATE, ROOT,
		PARSE_NEAR);

	mends("the vase in the back right corner", ". T . . . . P", PARSE_CORNER, 4, ROLE_PREDICATE, ROOT,
		PARSE_BEHIND);
	mends("the vase in the back right corner", ". T . . . . P", PARSE_CORNER, 5, ROLE_PREDICATE, ROOT,
		PARSE_RIGHT);
	mends("the vase in the blue corner", ". T . . . P", PARSE_CORNER, 4, ROLE_NONE, ROOT, 0);

	mends("which lamp has a vase just behind it", ". T . . A6 . P .", PARSE_BEHIND, 6, ROLE_PREDICATE,
		ROOT, PARSE_FRONT);
	mends("the lamp just behind it", ". T . P .", PARSE_BEHIND, 3, ROLE_PREDICATE, ROOT, PARSE_BEHIND);

	mends("the lamp nearest to us", ". T P . .", PARSE_NEAR, 4, ROLE_ANCHOR, 2, 0);
	mends("the lamp you gave to us", ". T . . . .", 0, 5, ROLE_NONE, ROOT, 0);
}

/* Whether a predicate that was read as denied still is. */
static int stays_denied(const char *text, const char *roles, int word)
{
	struct tokens t;
	struct analysis a, grammar;

	tokens_take(&t, text, NULL, NULL, 0);
	grammar_analyse(&grammar, &t);
	a = made(&t, roles, PARSE_ON);
	a.word[word].negated = 1;
	analysis_mend(&a, &grammar, &t);
	return a.word[word].role == ROLE_PREDICATE && a.word[word].negated;
}

/* Who leaves out "the one on the box" does not deny that it is on it. */
static void mends_negations(void)
{
	CHECK(!stays_denied("the lids, not the one on the box", ". T . . E P4 . A5", 5), "on the box");
	CHECK(!stays_denied("the lids, not the upper one", ". T . . P5 E", 4), "the upper one");
	CHECK(stays_denied("the lids, not the one that is not on the box", ". T . . E . . . P4 . A8", 8),
		"not on the box");
	CHECK(stays_denied("the lids not on the box", ". T . P . A3", 3), "lids that are not on the box");
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
	carries("the sled and the red jug under it", PARSE_ONE, PARSE_BELOW, "sled");
	carries("the sled and also the two jugs to the left of it", 2, PARSE_LEFT, "sled");
	carries("the sled, and the jug that is nearest to it", PARSE_ONE, PARSE_NEAR, "sled");
	carries("the sled and the jug it stands on", PARSE_ONE, PARSE_SUPPORTS, "sled");
	carries("the sled with a jug and a bell on it", 0, PARSE_ON, NULL);
}

/* How many phrases are left out of the target, and of what it is on, by an analysis that says the target. */
static void left_out(const char *text, int of_target, int of_anchor)
{
	struct tokens t;
	struct parse p = {0};
	struct err e;

	tokens_take(&t, text, NULL, NULL, 0);
	const struct analysis a = made(&t, "T P A1 . . . a7 E", PARSE_ON);
	if (!CHECK(!parse_build(&p, &a, &t, &e) && p.clauses[0].anchors.n == 1, "'%s' is built", text))
		return;
	const struct parse_phrase *anchor = &p.phrases[p.clauses[0].anchors.item[0]];
	CHECK(p.phrases[0].except.n == of_target && anchor->except.n == of_anchor, "'%s': %d and %d", text,
		p.phrases[0].except.n, anchor->except.n);
	if (of_anchor && anchor->except.n)
		CHECK(p.phrases[anchor->except.item[0]].noun.n == 1 &&
				p.phrases[anchor->except.item[0]].noun.item[0] == 2,
			"'%s': the red one is a tray", text);
	parse_free(&p);
}

/* What is left out is left out of what it is said of. */
static void left_out_of(void)
{
	left_out("thing on tray that is not red one", 0, 1);
	left_out("jug on tray that is not red one", 1, 0);
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

/* Whoever wears the scarf is meant, where the scarf is what nothing has an anchor for. */
static void who(void)
{
	static const char said[] = "who is wearing the yellow scarf";

	mends(said, ". . P . a T", PARSE_WITH, 0, ROLE_TARGET, ROOT, 0);
	mends(said, ". . P . a T", PARSE_WITH, 2, ROLE_PREDICATE, ROOT, PARSE_WITH);
	mends(said, ". . P . a T", PARSE_WITH, 4, ROLE_ATTRIBUTE, 5, 0);
	mends(said, ". . P . a T", PARSE_WITH, 5, ROLE_ANCHOR, 2, 0);
	mends("who has a scarf on", ". . . T P", PARSE_SUPPORTS, 3, ROLE_ANCHOR, 4, 0);
	mends("the man who has a scarf", ". T . P1 . A3", PARSE_WITH, 1, ROLE_TARGET, ROOT, 0);
	mends("who is near the yellow scarf", ". . P . a T", PARSE_NEAR, 5, ROLE_TARGET, ROOT, 0);
}

int main(void)
{
	who();
	carried_things();
	left_out_of();
	compared_with_all();
	mends_looks();
	mends_places();
	mends_negations();
	settles();
	return unit_end();
}
