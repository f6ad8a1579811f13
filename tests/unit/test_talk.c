/* What is made of how people talk: lang/analysis_talk.c, analysis_sentences.c, corners of analysis_places.c,
 * and what lang/parser.c and lang/parse_build.c take from several sentences. */
#include "lang/parser.h"
#include "lang/wordnet.h"
#include "mend_help.h"
#include "unit.h"

#include <string.h>

static void denies(const char *text, const char *roles, enum parse_relation relation, int word)
{
	const struct analysis a = mended(text, roles, relation);

	CHECK(a.word[word].role == ROLE_PREDICATE && a.word[word].negated, "'%s'", text);
}

static void places(void)
{
	mends("the stool beside the lamp, on the left", ". T P . A2 . . P4", PARSE_LEFT, 7, ROLE_PREDICATE,
		ROOT, PARSE_LEFT);
	/* without a pause it is the lamp's */
	mends("the stool beside the lamp on the left", ". T P . A2 . . P4", PARSE_LEFT, 7, ROLE_PREDICATE, 4,
		PARSE_LEFT);
	mends("the vase in the back right corner", ". T . . . . P", PARSE_CORNER, 4, ROLE_PREDICATE, ROOT,
		PARSE_BEHIND);
	mends("the vase in the back right corner", ". T . . . . P", PARSE_CORNER, 5, ROLE_PREDICATE, ROOT,
		PARSE_RIGHT);
	mends("the vase in the blue corner", ". T . . . P", PARSE_CORNER, 4, ROLE_NONE, ROOT, 0);
	mends("which lamp has a vase just behind it", ". T . . A6 . P .", PARSE_BEHIND, 6, ROLE_PREDICATE,
		ROOT, PARSE_FRONT);
	mends("the lamp just behind it", ". T . P .", PARSE_BEHIND, 3, ROLE_PREDICATE, ROOT, PARSE_BEHIND);
}

static void words(void)
{
	mends("the stool of any colour but orange", ". T . . a . a", 0, 6, ROLE_EXCEPT, ROOT, 0);
	mends("the stools that sit on rugs", ". T . P P A4", PARSE_OTHER, 3, ROLE_NONE, ROOT, 0);
	mends("what can they lift it with", ". T . . . .", 0, 1, ROLE_NONE, ROOT, 0);
	mends("the empty vase", ". a T", 0, 1, ROLE_PREDICATE, ROOT, PARSE_SUPPORTS);
	mends("the ash-coloured vase", ". T . .", 0, 3, ROLE_TARGET, ROOT, 0);
	mends("the ash-coloured vase", ". T . .", 0, 1, ROLE_ATTRIBUTE, ROOT, 0);
	mends("the vase with stripes, farthest left", ". T . A5 . P", PARSE_LEFT, 3, ROLE_ANCHOR, 2, 0);
	mends("the vase with stripes, farthest left", ". T . A5 . P", PARSE_LEFT, 2, ROLE_PREDICATE, ROOT,
		PARSE_WITH);
}

static void owners(void)
{
	mends("the rug over the lamp's shade", ". T P . A2 . A2", PARSE_ABOVE, 6, ROLE_NONE, ROOT, 0);
	mends("the rug over the lamp's shade", ". T P . A2 . A2", PARSE_ABOVE, 4, ROLE_ANCHOR, 2, 0);
	if (!wordnet_is_there())
		return;
	mends("the wizard's hat", ". T . .", 0, 3, ROLE_TARGET, ROOT, 0);
	/* what is no noun is what it is */
	mends("the lamp's bright", ". T . .", 0, 1, ROLE_TARGET, ROOT, 0);
	mends("the lamp's red", ". T . .", 0, 1, ROLE_TARGET, ROOT, 0);
}

static void negations(void)
{
	mends("the vase, neither red nor green", ". T . . . E", 0, 3, ROLE_EXCEPT, ROOT, 0);
	mends("the vase, either red or green", ". T . . . E", 0, 3, ROLE_NONE, ROOT, 0);
	denies("the empty vase", ". a T", 0, 1);
	denies("the stool that isn't over to the left of the lamp", ". T . . . . . . P . . A8", PARSE_LEFT,
		8);
	denies("the stool with no lamp on it", ". T . . A5 P .", PARSE_SUPPORTS, 5);
	const char *can = "the can that isn't orange or red";
	mends(can, ". T . . . . . .", 0, 5, ROLE_EXCEPT, ROOT, 0);
	mends(can, ". T . . . . . a", 0, 7, ROLE_EXCEPT, ROOT, 0);
	mends("not very orange, the can", ". . . . T", 0, 2, ROLE_EXCEPT, ROOT, 0);
	/* what is said of a noun stays */
	mends("the can, not the orange box", ". T . . a5 E", 0, 4, ROLE_ATTRIBUTE, 5, 0);
	mends("the can that is not by an orange box", ". T . . . P . a8 A5", PARSE_NEAR, 7, ROLE_ATTRIBUTE, 8,
		0);
	mends("the orange can", ". a T", 0, 1, ROLE_ATTRIBUTE, ROOT, 0);
	const struct analysis a = mended("the stool with a lamp on it", ". T . . A5 P .", PARSE_SUPPORTS);
	CHECK(!a.word[5].negated, "a lamp is on it");
}

static void sentences(void)
{
	const char *rug = "there is a rug. give me what lies on it", *roles = ". . . T . . . . P .";
	mends(rug, roles, PARSE_ON, 3, ROLE_ANCHOR, 8, 0);
	mends(rug, roles, PARSE_ON, 6, ROLE_TARGET, ROOT, 0);
	mends("see the lamp? which vase is nearest to it", ". . T . T . P . .", PARSE_NEAR, 2, ROLE_ANCHOR, 6,
		0);
	mends("see the lamp? what lies on it", ". . T . . P .", PARSE_SUPPORTS, 5, ROLE_PREDICATE, ROOT,
		PARSE_ON);
	mends("see the lamp? what it lies on", ". . T . . . P", PARSE_SUPPORTS, 6, ROLE_PREDICATE, ROOT,
		PARSE_SUPPORTS);
	mends("see the lamp? the vase right of it", ". . . . T P . .", PARSE_LEFT, 5, ROLE_PREDICATE, ROOT,
		PARSE_RIGHT);
	/* the same kind of thing, spoken of twice */
	mends("see the vase? which vase is nearest to it", ". . T . T . P . .", PARSE_NEAR, 2, ROLE_TARGET,
		ROOT, 0);
	mends("see the lamp, which vase is nearest to it", ". . T . T . P . .", PARSE_NEAR, 2, ROLE_TARGET,
		ROOT, 0);
}

static struct parse parsed(const char *text)
{
	const struct parser parser = {0};
	struct parse p = {0};
	struct err e;

	CHECK(!parse_sentence(&p, &parser, text, NULL, &e), "%s", e.message);
	return p;
}

/* The target's count, group and ordinal, by grammar alone. */
static void counts(const char *text, int count, int group, int ordinal)
{
	struct parse p = parsed(text);
	const struct parse_phrase *f = &p.phrases[0];

	CHECK(f->count == count && f->group == group && f->ordinal == ordinal, "'%s': %d of %d, %d", text,
		f->count, f->group, f->ordinal);
	parse_free(&p);
}

static void numbers(void)
{
	counts("red things", PARSE_SEVERAL, 0, 0);
	counts("the red thing", PARSE_ONE, 0, 0);
	counts("whatever is behind the lamp", PARSE_ALL, 0, 0);
	counts("two lamps on the rug. i want the smaller.", PARSE_ONE, 2, 0);
	counts("two lamps on the rug, please", 2, 0, 0);
	counts("both rugs and the lamp", 2, 0, 0);
	counts("first find the lamp", PARSE_ONE, 0, 0);
	counts("the first lamp", PARSE_ONE, 0, 1);
}

static void corrections(void)
{
	static const char *const all[] = {"the red lamp, no wait, the blue vase",
		"the red lamp - sorry, the blue vase", "the red lamp. scratch that, the blue vase"};

	for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
		struct parse p = parsed(all[i]);
		const struct parse_phrase *f = &p.phrases[0];
		CHECK(f->noun.n == 1 && !strcmp(p.words[f->noun.item[0]].text, "vase") && !f->also.n, "'%s'",
			all[i]);
		CHECK(f->span.begin > 12, "'%s': the span is of the text as it was said", all[i]);
		parse_free(&p);
	}
	struct parse p = parsed("sorry, the red lamp");
	CHECK(p.phrases[0].noun.n == 1, "an excuse that corrects nothing");
	parse_free(&p);
}

int main(void)
{
	places();
	words();
	owners();
	negations();
	sentences();
	numbers();
	corrections();
	return unit_end();
}
