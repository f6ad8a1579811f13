/* How many are meant, and what is corrected, where people talk (lang/parser.c, parse_build.c). */
#include "lang/parser.h"
#include "unit.h"

#include <string.h>

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
	numbers();
	corrections();
	return unit_end();
}
