/* Commands that say where a thing shall go: "put the cup on the tray" does not say that it is there. */
#include "lang/analysis.h"
#include "lang/closed.h"

/* Whether a verb is a command, and tells not what somebody did: "put", "please put", "could you now put". */
static int is_command(const struct tokens *t, int verb)
{
	int i = verb;

	while (i > 0 && !t->word[i].before &&
		(tokens_class(t, i - 1) == CLOSED_REQUEST || tokens_class(t, i - 1) == CLOSED_ADVERB ||
			tokens_class(t, i - 1) == CLOSED_CONJUNCTION))
		i--;
	return !i || t->word[i].before || tokens_is(t, i - 1, "to") ||
	       (tokens_is(t, i - 1, "you") && tokens_class(t, i - 2) == CLOSED_AUXILIARY);
}

/* The command of whose object the target is the noun, or -1. */
static int command_of(const struct tokens *t, int noun)
{
	int i = noun - 1;

	while (i > 0 && !t->word[i + 1].before && tokens_class(t, i) != CLOSED_DETERMINER)
		i--;
	return i > 0 && tokens_class(t, i) == CLOSED_DETERMINER && !t->word[i].before && is_command(t, i - 1)
		       ? i - 1
		       : -1;
}

/* Whether a word hangs on another, at any depth. */
static int hangs_on(const struct analysis *a, int i, int on)
{
	for (int depth = 0; i >= 0 && depth < a->n; i = a->word[i].head, depth++)
		if (i == on)
			return 1;
	return 0;
}

/* Whether a place after the object is where it shall go: always after "put", and after "move" where it says
 * so: "move the cup next to the jar" tells which cup. */
static int says_where_to(const struct tokens *t, int verb, int place)
{
	static const char *const put[] = {"put", "place", "set", "drop", "lay", "throw", "stick", "pop",
		"stuff", "tuck", "dump", "shove", "toss", "stow", "hang", NULL};
	static const char *const move[] = {
		"move", "slide", "push", "shift", "drag", "transfer", "carry", NULL};
	static const char *const to[] = {"to", "into", "onto", NULL};
	const int before = tokens_class(t, place - 1) == CLOSED_DETERMINER ? place - 2 : place - 1;

	return tokens_is_any(t, verb, put) ||
	       (tokens_is_any(t, verb, move) &&
		       (tokens_is_any(t, place, to) || tokens_is_any(t, before, to)));
}

void analysis_command(struct analysis *a, const struct tokens *t)
{
	struct analysis before;
	int noun = 0, goal = -1;

	while (noun < t->n && a->word[noun].role != ROLE_TARGET)
		noun++;
	const int verb = command_of(t, noun);
	if (noun == t->n || verb < 0)
		return;
	for (int i = noun + 1; i < t->n; i++) {
		const struct analysis_word *w = &a->word[i];
		if (w->role == ROLE_PREDICATE && (w->head == ROOT || w->head == noun) &&
			(w->relation < PARSE_LARGER || w->relation == PARSE_CORNER ||
				w->relation == PARSE_FLOOR) &&
			says_where_to(t, verb, i))
			goal = i;
	}
	before = *a;
	for (int i = 0; i < t->n && goal >= 0; i++)
		if (hangs_on(&before, i, goal))
			analysis_give_up(&a->word[i]);
}
