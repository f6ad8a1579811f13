#include "lang/phrases.h"

#include <string.h>

/* Elements with spaces between; | parts the words that may stand for one another, ? ends an element that may
 * be absent. */
static const struct phrase {
	enum lang_relation relation;
	enum lang_form form;
	const char *text;
} phrases[] = {
	{LANG_LEFT, LANG_AFTER, "to|on|at? the|its? left hand? side? of|from"},
	{LANG_LEFT, LANG_AFTER, "over to the left of|from"},
	{LANG_LEFT, LANG_AGAIN, "on|to|at its immediate? left hand? side?"},
	{LANG_LEFTMOST, LANG_PLACE, "at|on|to the far|very left"},
	{LANG_LEFT_SIDE, LANG_PLACE,
		"in|at|on|near|towards|toward|to|by the? far|upper|lower|front|back|rear|near? left hand? "
		"half|edge|end|corner|part|side|border? of?"},
	{LANG_LEFTMOST, LANG_PLACE, "farthest|furthest to the left"},
	{LANG_LEFTMOST, LANG_ADJECTIVE, "leftmost"},
	{LANG_LEFTMOST, LANG_ADJECTIVE, "left most"},
	{LANG_LEFTMOST, LANG_ADJECTIVE, "at|in the leftmost place|position"},
	{LANG_LEFTMOST, LANG_OUTERMOST, "farthest|furthest"},
	{LANG_LEFTMOST, LANG_SIDE_WORD, "far? left hand?"},

	{LANG_RIGHT, LANG_AFTER, "to|on|at? the|its? right hand? side? of|from"},
	{LANG_RIGHT, LANG_AFTER, "over to the right of|from"},
	{LANG_RIGHT, LANG_AGAIN, "on|to|at its immediate? right hand? side?"},
	{LANG_RIGHTMOST, LANG_PLACE, "at|on|to the far|very right"},
	{LANG_RIGHT_SIDE, LANG_PLACE,
		"in|at|on|near|towards|toward|to|by the? far|upper|lower|front|back|rear|near? right hand? "
		"half|edge|end|corner|part|side|border? of?"},
	{LANG_RIGHTMOST, LANG_PLACE, "farthest|furthest to the right"},
	{LANG_RIGHTMOST, LANG_ADJECTIVE, "rightmost"},
	{LANG_RIGHTMOST, LANG_ADJECTIVE, "right most"},
	{LANG_RIGHTMOST, LANG_ADJECTIVE, "at|in the rightmost place|position"},
	{LANG_RIGHTMOST, LANG_OUTERMOST, "farthest|furthest"},
	{LANG_RIGHTMOST, LANG_SIDE_WORD, "far? right hand?"},

	{LANG_FRONT, LANG_AFTER, "in front of"},
	{LANG_FRONT, LANG_AFTER, "before"},
	{LANG_FRONT, LANG_AFTER, "on the near side of"},
	{LANG_FRONT, LANG_AFTER, "on our side of"},
	{LANG_FRONT, LANG_AFTER, "nearer|closer to us than"},
	{LANG_FRONT, LANG_AFTER, "in the foreground of"},
	{LANG_FRONT_SIDE, LANG_PLACE,
		"in|at|on|near|towards|toward|to|by the? front|near|nearer|foremost "
		"half|edge|end|part|side|border? of?"},
	{LANG_FRONT_SIDE, LANG_PLACE, "in the foreground"},

	{LANG_BEHIND, LANG_AFTER, "behind"},
	{LANG_BEHIND, LANG_AFTER, "beyond|past"},
	{LANG_BEHIND, LANG_AFTER, "in back of"},
	{LANG_BEHIND, LANG_AFTER, "to|at the rear|back of"},
	{LANG_BEHIND, LANG_AFTER, "on the far|other|opposite side of"},
	{LANG_BACK_SIDE, LANG_PLACE,
		"in|at|on|near|towards|toward|to|by the? back|far|rear|farther half|edge|end|part|side|border? of?"},
	{LANG_BACK_SIDE, LANG_PLACE, "in the background"},
	{LANG_MIDDLE_SIDE, LANG_PLACE, "in|at|near|on|towards the very? middle|centre|center|heart of?"},
	{LANG_MIDDLE_SIDE, LANG_PLACE, "in|at|near|on|towards the central part|area|place of?"},

	{LANG_NEAR, LANG_AFTER, "next to"},
	{LANG_NEAR, LANG_AFTER, "beside|near|nearby|by|alongside|against|touching"},
	{LANG_NEAR, LANG_AFTER, "right|close by"},
	{LANG_NEAR, LANG_AFTER, "close|near|adjacent to"},
	{LANG_NEAR, LANG_AFTER, "at the side|foot|feet|base of"},
	{LANG_NEAR, LANG_AFTER, "leaning on|against"},
	{LANG_NEAREST, LANG_AFTER, "nearest|closest to?"},
	{LANG_NEAREST, LANG_AFTER, "at? the least|shortest|smallest distance from|to"},
	{LANG_FARTHEST, LANG_AFTER, "farthest|furthest away? from"},
	{LANG_FARTHEST, LANG_AFTER, "most distant|remote from"},
	{LANG_FARTHEST, LANG_AFTER, "at? the greatest|largest|longest distance from"},

	{LANG_BETWEEN, LANG_PAIR, "in|sandwiched? between"},
	{LANG_BETWEEN, LANG_PAIR, "flanked by"},
	{LANG_BETWEEN, LANG_PAIR, "in the gap|space between"},
	{LANG_BETWEEN, LANG_PAIR_BEFORE, "on|to either|both side|sides"},

	{LANG_ON, LANG_AFTER, "resting? on|upon|atop|onto|inside|within|in"},
	{LANG_ON, LANG_AFTER, "resting? on to|top of?"},
	{LANG_ON, LANG_AFTER, "on the top of"},
	{LANG_UNDER, LANG_AFTER, "under|underneath|below|beneath"},
	{LANG_UNDER, LANG_AFTER, "at the bottom of"},
	{LANG_ABOVE, LANG_AFTER, "above|over"},

	{LANG_NEAREST_US, LANG_ADJECTIVE, "nearest|closest|foremost|frontmost"},
	{LANG_FARTHEST_US, LANG_ADJECTIVE, "farthest|furthest|hindmost|rearmost|backmost"},
	{LANG_MIDDLE_ONE, LANG_ADJECTIVE, "middle|central"},
	{LANG_LARGEST, LANG_ADJECTIVE, "largest|biggest|bulkiest"},
	{LANG_SMALLEST, LANG_ADJECTIVE, "smallest|littlest|tiniest"},
	{LANG_TALLEST, LANG_ADJECTIVE, "tallest"},
	{LANG_HIGHEST, LANG_ADJECTIVE, "highest|topmost|uppermost up?"},
	{LANG_LOWEST, LANG_ADJECTIVE, "lowest|bottommost"},
};

const char lang_determiners[] = "the a an its his her their our your my this that one";
const char lang_viewers[] = "us me you camera viewer observer here we i";
const char lang_surfaces[] =
	"table desk tabletop picture image scene room photo view frame counter floor surface worktop";
const char lang_enders[] =
	", . ; that which whose with where standing lying placed located positioned resting "
	"leaning";
const char lang_links[] = "and or farthest furthest directly just";

static const char adverbs[] =
	"directly just right immediately slightly bit far over close up down straight partly";
static const char verbs[] =
	"lying lies standing stand stands placed located resting rests positioned set put sitting sits situated found "
	"seen hanging leaning kept is are be see which that surrounded among things";
static const char functions[] =
	"to of in at on by from with and or , . - ; : whose who where for as it them some any other both out";
static const char generic[] = "thing things object objects item items one ones something piece stuff element "
			      "article what";
static const char numbers[] = "two three four five six 2 3 4 5 6";

int lang_is_one_of(const char *word, const char *list)
{
	size_t length = strlen(word);

	for (const char *p = list; length && *p; p += *p == ' ') {
		size_t n = strcspn(p, " ");
		if (n == length && !memcmp(p, word, n))
			return 1;
		p += n;
	}
	return 0;
}

int lang_says_something(const char *word)
{
	const char *const lists[] = {
		lang_determiners, lang_viewers, adverbs, verbs, functions, generic, numbers};

	for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
		if (lang_is_one_of(word, lists[i]))
			return 0;
	return 1;
}

/* Whether a word is one of those that an element, `length` long, names. */
static int fits(const char *word, const char *element, size_t length)
{
	size_t n = strlen(word);

	for (size_t at = 0; at < length;) {
		size_t end = at;
		while (end < length && element[end] != '|')
			end++;
		if (end - at == n && !memcmp(element + at, word, n))
			return 1;
		at = end + 1;
	}
	return 0;
}

/* How many words from `at` on the phrase takes at most, or -1. */
static int longest(const char *phrase, const struct lang_sentence *s, int at)
{
	size_t length = strcspn(phrase, " ");
	int best = -1;

	if (!length)
		return 0;
	const int may_be_absent = phrase[length - 1] == '?';
	const char *rest = phrase + length + (phrase[length] == ' ');
	if (at < s->word_count && fits(s->words[at].text, phrase, length - (size_t)may_be_absent)) {
		int more = longest(rest, s, at + 1);
		best = more < 0 ? -1 : more + 1;
	}
	if (may_be_absent) {
		int without = longest(rest, s, at);
		best = without > best ? without : best;
	}
	return best;
}

static int is_at(const struct lang_sentence *s, int at, const char *list)
{
	return at >= 0 && at < s->word_count && lang_is_one_of(s->words[at].text, list);
}

/* What the words around a phrase must be, so that it means what it says. */
static int is_meant(const struct phrase *p, const struct lang_sentence *s, int at, int end)
{
	const char *last = s->words[end - 1].text;
	const int one_word = end - at == 1;

	switch (p->form) {
	case LANG_SIDE_WORD: /* "the left one" */
		return is_at(s, at - 1, lang_determiners) && end < s->word_count &&
		       (is_at(s, end, "one") || !is_at(s, end, functions));
	case LANG_OUTERMOST:
		return is_at(s, end, "to") && is_at(s, end + 1, "the") &&
		       is_at(s, end + 2, p->relation == LANG_LEFTMOST ? "left" : "right") &&
		       is_at(s, end + 3, "of from");
	case LANG_ADJECTIVE: /* "nearest to the mug" is no adjective */
		return !is_at(s, end, "to from away");
	case LANG_PLACE: /* of something is another phrase */
		return lang_is_one_of(last, "of") || !is_at(s, end, "of");
	case LANG_AFTER: /* "the nearest mug" is one; "made by hand", "in white" are nothing of the kind */
		if (one_word && lang_is_one_of(last, "nearest closest"))
			return !is_at(s, at - 1, lang_determiners);
		return !(one_word && lang_is_one_of(last, "in by")) || is_at(s, end, lang_determiners);
	default:
		return 1;
	}
}

int lang_match(const struct lang_sentence *s, int at, struct lang_match *m)
{
	*m = (struct lang_match){0};
	for (size_t i = 0; i < sizeof phrases / sizeof *phrases; i++) {
		int n = longest(phrases[i].text, s, at);
		if (n > m->length && is_meant(&phrases[i], s, at, at + n))
			*m = (struct lang_match){phrases[i].relation, phrases[i].form, n};
	}
	return m->length > 0;
}
