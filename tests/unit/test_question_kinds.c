/* Kinds of questions (lang/question_kinds.h). */
#include "lang/question_kinds.h"
#include "unit.h"

#include <string.h>

static void is(const char *text, enum question_kind kind, const char *first, const char *second)
{
	struct question_asked q = {0};

	CHECK(question_read(&q, text, 0) && q.kind == kind && !strcmp(q.text[0], first) &&
			!strcmp(q.text[1], second),
		"'%s': %s, '%s', '%s'", text, question_name(q.kind), q.text[0], q.text[1]);
}

/* A number, a choice and a fact that are asked for in other words. */
static void forms(void)
{
	is("Mugs: total?", QUESTION_NUMBER, "how many Mugs", "");
	is("spoon count, please", QUESTION_NUMBER, "how many spoon", "");
	is("what is the number of red mugs?", QUESTION_NUMBER, "red mugs", "");
	is("Mugs on a tray. What number do you see?", QUESTION_NUMBER, "how many Mugs on a tray", "");
	is("the mug with a number on it", QUESTION_WHICH, "the mug with a number on it", "");
	is("mug, jug, tray: how many of them are red?", QUESTION_NUMBER,
		"the mug, the jug and the tray that are red", "");
	is("the total", QUESTION_WHICH, "the total", "");
	is("what's smaller, the mug or its lid?", QUESTION_COMPARE, "the mug", "the lid");
	is("of the mugs, which ones aren't red?", QUESTION_SET, "the mugs that are not red", "");
	is("which of the mugs isn't red?", QUESTION_SET, "the mugs that are not red", "");
	is("among the mugs, which are on the tray?", QUESTION_SET, "the mugs that are on the tray", "");
	is("mug vs jug: who is taller?", QUESTION_COMPARE, "the mug", "the jug");
	is("Sort the mug, the jug and the tray by height: which one is second?", QUESTION_WHICH,
		"the second tallest of the mug, the jug and the tray", "");
	is("Rank mug, jug, tray, fork and box by size: which comes in the middle?", QUESTION_WHICH,
		"the third largest of the mug, the jug, the tray, the fork and the box", "");
	is("smallest in width: mug, jug, tray", QUESTION_WHICH,
		"the narrowest of the mug, the jug and the tray", "");
	is("say who is nearer to the tray: mug or jug", QUESTION_COMPARE, "mug", "jug");
	is("bring the mug, the jug and the tray", QUESTION_WHICH, "bring the mug, the jug and the tray", "");
	is("there's no mug, is there?", QUESTION_THERE, "there is mug", "");
	is("you've got a mug, haven't you?", QUESTION_THERE, "is there a mug", "");
	is("mug left of the tray, correct?", QUESTION_WHETHER, "mug", "mug that is left of the tray");
	is("the mug stands on the tray, doesn't it?", QUESTION_WHETHER, "the mug",
		"the mug that is on the tray");
	is("The mug has a handle, right?", QUESTION_WHETHER, "The mug", "The mug with a handle");
	is("you see a mug, right?", QUESTION_THERE, "is there a mug", "");
	is("the mug left of the tray", QUESTION_WHICH, "the mug left of the tray", "");
	is("The mug is red?", QUESTION_WHETHER, "The mug", "The mug that is red");
	is("the mug is red", QUESTION_WHICH, "the mug is red", "");
	is("Not one of the mugs is red: true or false?", QUESTION_THERE, "the mugs that are red", "");
	is("is the mug made of glass?", QUESTION_WHETHER, "the mug", "the mug that is made of glass");
	is("is the mug made of glass or metal?", QUESTION_EITHER, "the mug", "the mug that is glass");
	is("isn't the mug red?", QUESTION_WHETHER, "the mug", "the mug that is red");
	is("how many of the mugs aren't red?", QUESTION_NUMBER, "the mugs that are not red", "");
	is("might something lie there?", QUESTION_THERE, "might something lie there?", "");
	is("mum, did you spot a spoon?", QUESTION_THERE, "mum, did you spot a spoon?", "");
	is("could you kindly show me the spoon?", QUESTION_WHICH, "could you kindly show me the spoon?", "");
}

/* Of two groups one thing, or all of one. */
static void groups(void)
{
	struct question_asked q = {0};

	CHECK(question_read(&q, "which of the mugs and jugs is the tallest?", 0) &&
			q.kind == QUESTION_COMPARE && q.most == 1,
		"%d", q.most);
	CHECK(question_read(&q, "which are the tallest, the mugs or the jugs?", 0) &&
			q.kind == QUESTION_COMPARE && !q.most,
		"%d", q.most);
}

/* What splats and sentences cannot tell. */
static void untold(void)
{
	is("who bought the mug?", QUESTION_UNTOLD, "the mug", "");
	is("Who is by the mug?", QUESTION_SET, "Who is by the mug?", "");
	is("how much does the mug weigh?", QUESTION_UNTOLD, "the mug", "");
	is("what's the price of the red mug?", QUESTION_UNTOLD, "the red mug", "");
	is("is the mug switched on?", QUESTION_UNTOLD, "the mug", "");
	is("is the mug on the tray?", QUESTION_WHETHER, "the mug", "the mug that is on the tray");
}

static void kinds(void)
{
	is("the red mug", QUESTION_WHICH, "the red mug", "");
	is("", QUESTION_WHICH, "", "");
	is("the thing that you said is there", QUESTION_WHICH, "the thing that you said is there", "");
	is("What's here?", QUESTION_LIST, "What's here?", "");
	is("could you tell me how many mugs there are", QUESTION_NUMBER,
		"could you tell me how many mugs there are", "");
	is("please tell me what colour the mug is", QUESTION_COLOUR, "the mug", "");
	is("hi, what color is the big mug?", QUESTION_COLOUR, "the big mug", "");
	is("how high is my mug", QUESTION_HEIGHT, "my mug", "");
	is("what's left of the mug?", QUESTION_SET, "what's left of the mug?", "");
	is("is the mug larger than the red one?", QUESTION_MORE, "the mug", "the red mug");
	is("is the mug black or white?", QUESTION_EITHER, "the mug", "the mug that is black");
	is("is the mug left or right of the jug?", QUESTION_EITHER, "the mug",
		"the mug that is left of the jug");
	is("is the mug the only red thing?", QUESTION_WHETHER, "the mug", "the red thing");
	is("is the mug the largest thing?", QUESTION_WHETHER, "the mug", "the largest thing");
	is("is there nothing on the tray?", QUESTION_THERE, "everything that is on the tray", "");
	is("are there fewer than four mugs?", QUESTION_THERE, "all mugs", "");
	is("is the mug closer to the jug or to the tray?", QUESTION_COMPARE, "the jug", "the tray");
	is("do the mugs have the same colour?", QUESTION_SAME, "the mugs", "");
	is("is it true that the mug is red?", QUESTION_WHETHER, "the mug", "the mug that is red");
	is("the mug is on the tray, isn't it?", QUESTION_WHETHER, "the mug", "the mug that is on the tray");
	is("the mug is on the tray, give me that", QUESTION_WHICH, "the mug is on the tray, give me that",
		"");
	is("how tall would you say the mug is?", QUESTION_HEIGHT, "the mug", "");
	is("how many mugs have I got, going by this", QUESTION_NUMBER, "all mugs", "");
	is("is the mug on the tray?", QUESTION_WHETHER, "the mug", "the mug that is on the tray");
	is("is the mug red?", QUESTION_WHETHER, "the mug", "the mug that is red");
	is("is there a mug?", QUESTION_THERE, "is there a mug?", "");
	is("I am thirsty, is there a mug?", QUESTION_THERE, "I am thirsty, is there a mug?", "");
	is("how many of the mugs have a lid?", QUESTION_NUMBER, "the mugs that have a lid", "");
	is("are there more than two mugs?", QUESTION_THERE, "all mugs", "");
	is("the mugs, how many of them are there?", QUESTION_NUMBER, "all the mugs", "");
	is("of the mugs, how many are red?", QUESTION_NUMBER, "the mugs that are red", "");
	is("what colour is the lid of the jug?", QUESTION_COLOUR, "the lid of the jug", "the jug");
	is("what colour are the jug's handles?", QUESTION_COLOUR, "the handles of the jug", "the jug");
	is("between the mug and the jug which is taller?", QUESTION_COMPARE, "the mug", "the jug");
	is("which takes up more room, the mug or the jug?", QUESTION_COMPARE, "the mug", "the jug");
	is("would you say the mug is taller than the jug?", QUESTION_MORE, "the mug", "the jug");
	is("tallest out of the mug, the jug and the tray?", QUESTION_WHICH,
		"the tallest of the mug, the jug and the tray", "");
	is("how far is one mug from the other?", QUESTION_DISTANCE, "all mug", "");
	is("what else is red except the mugs?", QUESTION_SET, "everything that is red except the mugs", "");
	is("is there a mug larger than the jug?", QUESTION_THERE, "a mug that is larger than the jug", "");
	is("are there more mugs than jugs?", QUESTION_TALLY, "all mugs", "all jugs");
	is("do you see fewer mugs than jugs", QUESTION_TALLY, "all jugs", "all mugs");
	is("is it true that there are as many mugs as red jugs?", QUESTION_EVEN, "all mugs", "all red jugs");
	is("is the number of mugs the same as that of jugs?", QUESTION_EVEN, "all mugs", "all jugs");
	is("what are there more of, mugs or jugs?", QUESTION_MAJORITY, "all mugs", "all jugs");
	is("how many more mugs are there than jugs?", QUESTION_SURPLUS, "all mugs", "all jugs");
	is("how many mugs have nothing on top?", QUESTION_NUMBER, "mugs that have nothing on top", "");
	is("which of the mugs are red?", QUESTION_SET, "the mugs that are red", "");
	is("how much taller than the jug is the mug?", QUESTION_COMPARE, "the mug", "the jug");
	is("which is taller: the mug or the jug?", QUESTION_COMPARE, "the mug", "the jug");
}

/* Each way to take a question apart once, in the order of the first part's length. */
static void ways(void)
{
	static const char text[] = "how far is the mug from the tray from the jug";
	static const char *const parts[][2] = {
		{"the mug", "the tray from the jug"}, {"the mug from the tray", "the jug"}};
	struct question_asked q = {0};

	for (int way = 0; way < 2; way++)
		CHECK(question_read(&q, text, way) && q.kind == QUESTION_DISTANCE &&
				!strcmp(q.text[0], parts[way][0]) && !strcmp(q.text[1], parts[way][1]),
			"%d: '%s', '%s'", way, q.text[0], q.text[1]);
	CHECK(!question_read(&q, text, 2), "a third way: '%s', '%s'", q.text[0], q.text[1]);
}

/* The word that asks has a relation, and no text is too long. */
static void words(void)
{
	char long_text[3 * QUESTION_TEXT];
	struct question_asked q = {0};

	CHECK(question_read(&q, "which one is smaller, a or b", 0) && q.relation == PARSE_SMALLER, "%d",
		q.relation);
	CHECK(question_read(&q, "which is nearer to the jug: a or b", 0) && !strcmp(q.text[2], "the jug"),
		"'%s'", q.text[2]);
	CHECK(question_read(&q, "which is nearer to us: a or b", 0) && !*q.text[2], "'%s'", q.text[2]);
	CHECK(question_read(&q, "are there enough mugs for every jug", 0) && !q.least, "%d", q.least);
	CHECK(question_read(&q, "are there fewer mugs or jugs", 0) && q.least == -1, "%d", q.least);
	CHECK(question_read(&q, "the mug", 0) && q.relation == -1, "%d", q.relation);
	memset(long_text, 'x', sizeof long_text);
	memcpy(long_text, "how tall is ", 12);
	long_text[sizeof long_text - 1] = 0;
	CHECK(question_read(&q, long_text, 0) && strlen(q.text[0]) < QUESTION_TEXT, "%zu", strlen(q.text[0]));
}

int main(void)
{
	kinds();
	forms();
	groups();
	untold();
	ways();
	words();
	return unit_end();
}
