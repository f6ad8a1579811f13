/* Sentences with marks (lang/marked.h): what each mark makes of its word, and every way to get one wrong. */
#include "lang/marked.h"
#include "unit.h"

#include <string.h>

static struct marked m;
static struct tokens t;
static struct analysis a;
static struct err e;

static int take(const char *line)
{
	e = (struct err){0};
	if (marked_take(&m, line, &e))
		return -1;
	tokens_take(&t, m.text, NULL, NULL, 0);
	return marked_analyse(&m, &t, &a, &e);
}

static int word(const char *text)
{
	for (int i = 0; i < t.n; i++)
		if (tokens_is(&t, i, text))
			return i;
	return -2;
}

/* "role:relation@head" of a word */
static const char *is(const char *text)
{
	static const char *const roles[] = {"-", "T", "A", "S", "X", "V", "M", "n", "a", "P"};
	static char out[96];
	const struct analysis_word *w = &a.word[word(text)];
	const int is_predicate = w->role == ROLE_PREDICATE;

	snprintf(out, sizeof out, "%s%s%s%s@%s", roles[w->role], is_predicate ? ":" : "",
		is_predicate && w->negated ? "!" : "", is_predicate ? parse_relation_name(w->relation) : "",
		w->head == ROOT ? "" : t.word[w->head].text);
	return out;
}

static void is_marked(const char *text, const char *want)
{
	CHECK(!strcmp(is(text), want), "%s: %s", text, is(text));
}

static void test_marks(void)
{
	CHECK(take("the small/P1:smaller mug/T on/P2:!on the big/P3:larger@2 tea/n tray/A2.") == 0, "%s",
		e.message);
	CHECK(!strcmp(m.text, "the small mug on the big tea tray."), "%s", m.text);
	is_marked("small", "P:smaller@");
	is_marked("mug", "T@");
	is_marked("on", "P:!on@");
	is_marked("big", "P:larger@tray");
	is_marked("tea", "n@tray");
	is_marked("tray", "A@on");
	is_marked("the", "-@");
	CHECK(take("trash/n cans/T between/P1:between a red/a@1 box/A1 and the blue/a@1b chair/A1, and a lamp/S, not the old/a@X one/X") ==
			0,
		"%s", e.message);
	is_marked("trash", "n@");
	is_marked("red", "a@box");
	is_marked("blue", "a@chair");
	is_marked("chair", "A@between");
	is_marked("lamp", "S@");
	is_marked("old", "a@one");
	is_marked("one", "X@");
	/* a pronoun's noun, said before the predicate; one that stands for nothing */
	CHECK(take("The plate/A1 is behind/P2:behind@1 the jug/A2; what stands left/P1:left of it?") == 0,
		"%s", e.message);
	is_marked("plate", "A@left");
	is_marked("jug", "A@behind");
	is_marked("behind", "P:behind@plate");
	/* words that the tokeniser parts */
	CHECK(take("facing the door's/V blue-green/a@V side, the T-shirt/T or dish-cloth/S in the left-most/P1:left pile") ==
			0,
		"%s", e.message);
	is_marked("door", "V@");
	is_marked("'s", "-@");
	is_marked("blue", "a@door");
	is_marked("green", "a@door");
	is_marked("t-shirt", "T@");
	is_marked("dish", "n@cloth");
	is_marked("left", "P:left@");
	is_marked("most", "-@");
}

/* Blanks, ends of lines and other alphabets. */
static void test_text(void)
{
	CHECK(take("\t  dein  r\xc3\xb6tlicher/a   Becher/T !\r\n") == 0, "%s", e.message);
	CHECK(!strcmp(m.text, "dein r\xc3\xb6tlicher Becher !"), "%s", m.text);
	is_marked("becher", "T@");
	CHECK(take("(the mug/T)") == 0, "%s", e.message);
	CHECK(!strcmp(m.text, "(the mug)"), "%s", m.text);
}

static void fails(const char *line, const char *why)
{
	CHECK(take(line) == -1 && e.code == ERR_FORMAT && !strcmp(e.message, why), "%s: %s", line, e.message);
}

static void test_errors(void)
{
	static char line[MARKED_LENGTH + 200];

	fails("the mug", "no mark");
	fails("", "no mark");
	fails("the /T mug", "'/T' is no word with a mark");
	fails("mug/Q", "'/Q' is no mark");
	fails("mug/", "'/' is no mark");
	fails("mug/T1x", "'/T1x' is no mark");
	fails("mug/T cup/T2", "'/T2' is no mark");
	fails("mug/T red/a@T2", "'/a@T2' is no mark");
	fails("mug/T near/P1:nearby", "'/P1:nearby' is no mark");
	fails("mug/T near/P1", "'/P1' is no mark");
	fails("mug/T cup/T", "mark '/T' appears twice");
	fails("mug/T near/P1:near on/P1:on", "mark '/P1:on' appears twice");
	fails("mug/T cup/A1", "mark '/A1' has no '/P1'");
	fails("mug/T red/a@1", "'red' is said of a noun that has no mark");
	fails("mug/T near/P1:near@2 box/A1", "'near' is said of a noun that has no mark");
	fails("mug/T tea/n", "no noun after mark '/n' of 'tea'");
	fails("mug/T near/P1:near@2 box/A1 by/P2:near@1 cup/A2",
		"'near' hangs on itself, or on what has no mark");
	memset(line, 'x', sizeof line - 1);
	fails(line, "longer than 1024 bytes");
	line[0] = 0;
	for (int i = 0; i < MARKED_MOST + 1; i++)
		strcat(line, "x/a ");
	fails(line, "more than 128 marks");
}

int main(void)
{
	test_marks();
	test_text();
	test_errors();
	return unit_end();
}
