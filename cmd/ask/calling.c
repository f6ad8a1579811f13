#include "cmd/ask/answering.h"

#include "base/mem.h"
#include "places/arrangement.h"
#include "lang/colours.h"

#include <math.h>
#include <string.h>

enum { NEIGHBOURS = 4, WORD = 96 };
/* A description has to be right at least as often as not. */
static const double least = 0.5;
/* Of an object, the part that people would call by a colour, for the colour to be tried. */
static const double colour_share = 0.3;

struct trial {
	struct asking *asking;
	const struct report *report;
	const struct arrangement *places;
	size_t object;
	char noun[WORD], name[WORD]; /* the last word of the name that is no number, and all of them */
	struct calling best;	     /* of this kind */
};

/* The words of a name but for numbers, with blanks between; *last becomes where the last begins. */
static void take_words(const char *name, char *words, char *last)
{
	size_t n = 0;

	*last = *words = 0;
	while (*(name += strspn(name, " -_"))) {
		const size_t length = strcspn(name, " -_");
		const int is_number = strspn(name, "0123456789") >= length;
		if (!is_number && n + length + 2 < WORD) {
			n += (size_t)snprintf(words + n, WORD - n, "%s%.*s", n ? " " : "", (int)length, name);
			snprintf(last, WORD, "%.*s", (int)length, name);
		}
		name += length;
	}
}

/* Asks a description; the best that means the object alone stays. */
__attribute__((format(printf, 3, 4))) static int try(struct trial *t, struct err *e, const char *format, ...)
{
	SCOPED_BY(asking_answer_free) struct asking_answer a = {0};
	char text[CALLING_TEXT];
	va_list args;

	va_start(args, format);
	vsnprintf(text, sizeof text, format, args);
	va_end(args);
	if (asking_ask(t->asking, text, 0, &a, t->report, e))
		return -1;
	const double p = a.count == 1 && a.things[0] == t->object ? a.probability[t->object] : 0;
	if (p >= least && p > t->best.probability) {
		memcpy(t->best.text, text, sizeof text);
		t->best.probability = p;
	}
	return 0;
}

static int try_noun(struct trial *t, struct err *e)
{
	return try(t, e, "the %s", t->noun);
}

static int try_name(struct trial *t, struct err *e)
{
	return strcmp(t->name, t->noun) ? try(t, e, "the %s", t->name) : 0;
}

static int try_colours(struct trial *t, struct err *e)
{
	const double *share = t->places->objects[t->object].colours;
	int bad = 0;

	for (int c = 0; c < COLOUR_WORDS && !bad; c++)
		if (share[c] >= colour_share && !strstr(t->name, colour_name(c)))
			bad = try(t, e, "the %s %s", colour_name(c), t->noun);
	return bad;
}

static int try_superlatives(struct trial *t, struct err *e)
{
	static const char *const words[] = {"leftmost", "rightmost", "largest", "smallest", "tallest",
		"highest", "lowest", "nearest", "farthest"};
	int bad = 0;

	for (size_t i = 0; i < sizeof words / sizeof *words && !bad; i++)
		bad = try(t, e, "the %s %s", words[i], t->noun);
	return bad;
}

/* Whether no other object has this name, apart from its number. */
static int is_unique(const struct asking *a, size_t object)
{
	const struct lifted *l = &a->model.lifted;
	char own[WORD], other[WORD], last[WORD];
	int same = 0;

	take_words(l->names[object], own, last);
	for (size_t o = 0; o < l->objects; o++) {
		take_words(l->names[o], other, last);
		same += !strcmp(own, other);
	}
	return same == 1;
}

static double apart(const struct trial *t, size_t other)
{
	const double *x = t->places->objects[t->object].centre, *y = t->places->objects[other].centre;

	return hypot(hypot(x[0] - y[0], x[1] - y[1]), x[2] - y[2]);
}

/* The nearest objects with names of their own. Returns how many. */
static int find_neighbours(const struct trial *t, size_t nearest[NEIGHBOURS])
{
	int n = 0;

	for (size_t o = 0; o < t->places->n; o++) {
		if (o == t->object || !t->places->objects[o].is_there || !is_unique(t->asking, o))
			continue;
		int at = n < NEIGHBOURS ? n++ : NEIGHBOURS;
		for (; at && apart(t, o) < apart(t, nearest[at - 1]); at--)
			if (at < NEIGHBOURS)
				nearest[at] = nearest[at - 1];
		if (at < NEIGHBOURS)
			nearest[at] = o;
	}
	return n;
}

/* "what" beside each neighbour, on the side where it is. */
static int try_beside(struct trial *t, const char *what, struct err *e)
{
	size_t nearest[NEIGHBOURS];
	const int n = find_neighbours(t, nearest);
	char name[WORD], last[WORD];
	int bad = 0;

	for (int i = 0; i < n; i++) {
		const char *const near[] = {answering_side(t->places->objects[t->object].centre,
						    t->places->objects[nearest[i]].centre),
			"on", "next to"};
		take_words(t->asking->model.lifted.names[nearest[i]], name, last);
		for (size_t k = 0; k < sizeof near / sizeof *near && !bad; k++)
			bad = try(t, e, "the %s %s the %s", what, near[k], name);
	}
	return bad;
}

static int try_noun_beside(struct trial *t, struct err *e)
{
	return try_beside(t, t->noun, e);
}

static int try_name_beside(struct trial *t, struct err *e)
{
	return strcmp(t->name, t->noun) ? try_beside(t, t->name, e) : 0;
}

int calling_find(struct asking *a, size_t object, struct calling *to, double (*centres)[3],
	const struct report *report, struct err *e)
{
	static int (*const kinds[])(struct trial *, struct err *) = {
		try_noun, try_name, try_colours, try_superlatives, try_noun_beside, try_name_beside};
	SCOPED_BY(arrangement_free) struct arrangement places = {0};
	struct trial t = {a, report, &places, object, "", "", {"", 0}};
	int bad = 0;

	*to = (struct calling){0};
	if (arrangement_make(&places, &a->model.lifted, &a->scene.splats, &a->scene.cameras, e))
		return -1;
	arrangement_look(&places, &a->from);
	take_words(a->model.lifted.names[object], t.name, t.noun);
	for (size_t k = 0; k < sizeof kinds / sizeof *kinds && *t.noun && !bad && !*t.best.text; k++)
		bad = kinds[k](&t, e);
	for (size_t o = 0; centres && o < places.n; o++)
		memcpy(centres[o], places.objects[o].centre, sizeof *centres);
	*to = t.best;
	return bad ? -1 : 0;
}
