/* Words that point back (talk/talk.h). */
#include "talk/talk.h"
#include "unit.h"

#include <string.h>

static char *const names[] = {"red mug", "blue mug", "mug 3", "brown box"};
enum { OBJECTS = sizeof names / sizeof *names };

/* A question was answered by some of these things. */
static void answered(struct talk *talk, const char *question, const size_t *things, size_t count)
{
	struct question_asked asked;

	question_read(&asked, question, 0);
	talk_take(talk, &(struct talk_answer){names, OBJECTS, &asked, question, things, count, TALK_NONE, 0},
		0);
}

static void is(const struct talk *talk, const char *question, const char *expected, size_t within)
{
	char understood[QUESTION_TEXT];
	const struct meaning_set *of = talk_understand(talk, names, OBJECTS, question, understood);

	CHECK(!strcmp(understood, expected) && (of ? of->n : 0) == within, "'%s': '%s' of %zu", question,
		understood, of ? of->n : 0);
}

static void one_thing(void)
{
	struct talk talk = TALK_NEW;

	is(&talk, "how tall is it?", "how tall is it?", 0);
	answered(&talk, "how tall is the brown box?", (const size_t[]){3}, 1);
	is(&talk, "how wide is it?", "how wide is the brown box?", 0);
	is(&talk, "and the red mug?", "how tall is the red mug?", 0);
	answered(&talk, "where is the red mug?", (const size_t[]){0}, 1);
	is(&talk, "and the rest, how tall are they?", "and the mugs, how tall are they?", 2);
}

static void several(void)
{
	struct talk talk = TALK_NEW;

	answered(&talk, "how many mugs are on the box?", (const size_t[]){0, 1}, 2);
	is(&talk, "which of them is taller?", "which of the red mug and the blue mug is taller?", 0);
	is(&talk, "how many?", "how many of the mugs are there?", 2);
	is(&talk, "and how many aren't?", "how many mugs are there", 1);
	is(&talk, "where are the others?", "where are the mug?", 1);
	is(&talk, "are there any others?", "are there any mug?", 1);
	is(&talk, "which box has nothing on it?", "which box has nothing on it?", 0);
	is(&talk, "how many boxes have nothing on them?", "how many boxes have nothing on them?", 0);
}

static void words(void)
{
	char noun[TALK_TEXT];

	talk_name_words(names[2], 1, noun);
	CHECK(!strcmp(noun, "mug"), "'%s'", noun);
	CHECK(talk_points("how tall is it?") && !talk_points("how tall is the mug?"), "points");
}

int main(void)
{
	one_thing();
	several();
	words();
	return unit_end();
}
