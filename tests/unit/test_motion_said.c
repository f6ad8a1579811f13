/* What sentences say of motion: whose it is, about what, and when (lang/motion_said.h). */
#include "tests/unit/default_parser.h"
#include "unit.h"

#include "lang/motion_rows.h"

#include <stdio.h>

/* "cup" of a phrase; "" where it has no noun. */
static const char *noun_of(const struct parse *p, int phrase)
{
	const struct parse_list *noun = &p->phrases[phrase].noun;

	return noun->n ? p->words[noun->item[noun->n - 1]].text : "";
}

/* "falls of cup; towards of ball about box" and the target's noun behind ": ". */
static void tell(struct parse *p, char *to, size_t room)
{
	struct motion_said m;
	size_t n = 0;

	motion_said_take(&m, p);
	*to = 0;
	for (int k = 0; k < m.n; k++) {
		const struct motion_event *v = &m.events[k];
		n += (size_t)snprintf(to + n, room - n, "%s%s%s of %s", k ? "; " : "",
			v->negated ? "not " : "", motion_kind_name(v->kind), noun_of(p, v->phrase));
		if (v->about >= 0)
			n += (size_t)snprintf(to + n, room - n, " about %s", noun_of(p, v->about));
	}
	snprintf(to + n, room - n, ": %s", noun_of(p, 0));
}

static void test_whose(void)
{
	static const char *const expected[][2] = {{"the red cup that falls", "falls of cup: cup"},
		{"the box behind the cup that falls", "falls of cup: box"},
		{"the moving cup", "moves of cup: cup"},
		{"the cup that does not move", "not moves of cup: cup"},
		{"the cup that is still", "still of cup: cup"},
		{"the cup that passes behind the box", "behind of cup about box: cup"},
		{"the cup that moves to the left", "moves of cup; left of cup: cup"},
		{"the cup that stops and then goes on", "pauses of cup: cup"},
		{"the fastest cup", "fastest of cup: cup"},
		{"the first cup to move", "moves of cup; first of cup: cup"},
		{"the cup that moves the farthest", "moves of cup; farthest of cup: cup"},
		{"the cup to the left of the box", ": cup"}, {"the cup farthest from the box", ": cup"},
		{"the cup standing on the box", ": cup"}, {"the toy set down right of the ball", ": toy"},
		{"the first cup from the left", ": cup"}};

	for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
		const struct parser parser = default_parser();
		struct parse p;
		struct err e;
		char got[512];
		if (parse_sentence(&p, &parser, expected[i][0], NULL, &e))
			exit(1);
		tell(&p, got, sizeof got);
		CHECK(!strcmp(got, expected[i][1]), "'%s': got '%s', expected '%s'", expected[i][0], got,
			expected[i][1]);
		parse_free(&p);
	}
}

static void test_when(void)
{
	static const struct {
		const char *text, *main, *other;
		enum motion_kind when;
	} expected[] = {{"the ball that moves while the cup falls", "the ball that moves ", "the cup falls",
				MOTION_WHILE},
		{"before the cup falls, the red ball", "the red ball", "the cup falls", MOTION_BEFORE},
		{"the ball after it is lifted", "the ball ", "it is lifted", MOTION_AFTER},
		{"does the cup fall?", "the cup fall?", "", MOTION_NONE},
		{"when does the cup fall?", "the cup fall?", "", MOTION_NONE},
		{"when does the cup stop?", "the cup stop?", "", MOTION_NONE},
		{"the cup that falls", "the cup that falls", "", MOTION_NONE},
		{"the ball before the box", "the ball before the box", "", MOTION_NONE}};

	for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
		const struct parser parser = default_parser();
		const char *text = expected[i].text;
		struct motion_cut c;
		struct parse p;
		struct err e;
		if (parse_sentence(&p, &parser, text, NULL, &e))
			exit(1);
		motion_said_cut(&c, &p, text);
		const char *main = text + p.words[c.begin].span.begin;
		CHECK(!strncmp(main, expected[i].main, strlen(expected[i].main)), "'%s': begins at '%s'",
			text, main);
		CHECK(c.when == expected[i].when, "'%s': %d", text, (int)c.when);
		const char *other = c.when == MOTION_NONE ? "" : text + p.words[c.other_begin].span.begin;
		CHECK(!strncmp(other, expected[i].other, strlen(expected[i].other)),
			"'%s': the other is '%s'", text, other);
		parse_free(&p);
	}
}

int main(void)
{
	test_whose();
	test_when();
	return unit_end();
}
