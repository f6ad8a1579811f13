/* How many are meant where people talk (lang/parse_counts.c). */
#include "tests/unit/default_parser.h"
#include "lang/parser.h"
#include "unit.h"

#include <string.h>

static struct parse parsed(const char *text)
{
	const struct parser parser = default_parser();
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
	counts("the first lamp", PARSE_ONE, 0, 1);
}

int main(void)
{
	numbers();
	return unit_end();
}
