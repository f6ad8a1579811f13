/* What a thing looks like, in words: its colours, or what else sentences say of it. */
#include "cmd/ask/answering.h"

#include "base/mem.h"
#include "lang/colours.h"
#include "lang/finish.h"

#include <math.h>
#include <string.h>

/* A word for a colour that counts, as a part of a thing, against the commonest. */
static const double second_colour = 0.4;
/* Words for one colour (lang/colours.h). */
static const double same_colour = 0.3;
/* A colour that may as well be called by another word: "is it grey?" of a slate one. */
static const double much_alike = 0.75;

static const char *const basic_colours[] = {
	"black", "white", "grey", "red", "orange", "yellow", "green", "blue", "purple", "pink", "brown"};
enum { BASIC_COLOURS = sizeof basic_colours / sizeof *basic_colours };

/* How much speaks for each colour word: its name and sentences, or else the Gaussians for the basic words.
 * Returns the most. */
static double weigh_colours(const struct answer_told *t, size_t thing, double worth[COLOUR_WORDS])
{
	const struct vocabulary *v = t->answer->words;
	const char *name = t->asking->model.lifted.names[thing];
	double most = 0, is_said = 0;

	for (int c = 0; c < COLOUR_WORDS; c++) {
		worth[c] = strstr(name, colour_name(c)) ? 2 : 0;
		for (size_t i = 0; i < v->n; i++)
			worth[c] += v->items[i].object == thing && v->items[i].role == VOCABULARY_ATTRIBUTE &&
				    colour_word(v->items[i].lemma) == c;
		is_said += worth[c];
	}
	for (int k = 0; k < BASIC_COLOURS; k++) {
		const int c = colour_word(basic_colours[k]);
		if (is_said > 0)
			worth[c] *= 2;
		else
			worth[c] = t->answer->places->objects[thing].colours[c];
	}
	for (int c = 0; c < COLOUR_WORDS; c++)
		most = fmax(most, worth[c]);
	return most;
}

/* "black and grey": the colours that count, of words for one colour only the likeliest. */
static void say_colours(const struct answer_told *t, size_t thing, struct parse_words *to)
{
	double worth[COLOUR_WORDS];
	const double most = weigh_colours(t, thing, worth);

	for (int said = 0; said < COLOUR_WORDS; said++) {
		int best = 0;
		for (int c = 1; c < COLOUR_WORDS; c++)
			best = worth[c] > worth[best] ? c : best;
		if (!(worth[best] > second_colour * most))
			break;
		parse_words_add(to, said ? " and " : "");
		parse_words_add(to, colour_name(best));
		for (int c = 0; c < COLOUR_WORDS; c++)
			worth[c] *= c != best && colour_words_alike(best, c) < same_colour;
	}
}

/* The pattern that sentences say of a thing, or else its Gaussians show. */
static const char *find_pattern(const struct answer_told *t, size_t thing)
{
	static const char *const patterns[] = {
		[FINISH_STRIPES] = "striped", [FINISH_SPOTS] = "spotted", [FINISH_PLAIN] = "plain"};
	const struct vocabulary *v = t->answer->words;
	const struct surface *s = &t->answer->places->objects[thing].surface;
	int most = FINISH_STRIPES;

	for (size_t i = 0; i < v->n; i++) {
		const int is = finish_of(v->items[i].lemma);
		if (v->items[i].object == thing && is >= 0 && is <= FINISH_PLAIN)
			return patterns[is];
	}
	for (int k = FINISH_SPOTS; k <= FINISH_PLAIN; k++)
		most = surface_fits(s, k) > surface_fits(s, most) ? k : most;
	return patterns[most];
}

/* Whether a word is one of a list with spaces around each. */
static int words_have(const char *list, const char *word)
{
	char padded[TOKEN_LENGTH + 2];

	snprintf(padded, sizeof padded, " %s ", word);
	return strstr(list, padded) != NULL;
}

/* The material that a lemma tells of, -1: none. Those that nobody tells apart are one. */
static int material_of(const char *lemma)
{
	static const char *const alike[] = {
		" metal metallic steel iron tin aluminium aluminum copper brass bronze silver gold chrome ",
		" wood wooden timber oak pine plywood bamboo wicker rattan cork straw ",
		" plastic acrylic vinyl nylon silicone foam ", " rubber ", " glass crystal ",
		" ceramic porcelain china clay terracotta ", " stone marble concrete granite ",
		" leather suede ",
		(" cloth fabric textile cotton wool woollen woolen woolly linen silk denim velvet felt fleece fur furry "
		 "plush polyester canvas "),
		" paper cardboard card ", " wax "};
	int k = (int)(sizeof alike / sizeof *alike) - 1;

	while (k >= 0 && !words_have(alike[k], lemma))
		k--;
	return k;
}

static int is_coloured(const struct answer_told *t, size_t thing, int colour)
{
	char own[CALLING_TEXT] = "";
	struct parse_words words = {own, 0, sizeof own};
	int is = 0;

	say_colours(t, thing, &words);
	for (int c = 0; c < COLOUR_WORDS; c++)
		is |= strstr(own, colour_name(c)) && colour_words_alike(c, colour) > much_alike;
	return is;
}

static enum answer_look is_made(const struct answer_told *t, size_t thing, int material)
{
	const struct vocabulary *v = t->answer->words;
	enum answer_look is = LOOK_UNTOLD;

	for (size_t i = 0; i < v->n; i++) {
		const int said = v->items[i].object == thing && v->items[i].role == VOCABULARY_ATTRIBUTE
					 ? material_of(v->items[i].lemma)
					 : -1;
		is = said < 0 || is == LOOK_YES ? is : said == material ? LOOK_YES : LOOK_NO;
	}
	return is;
}

enum answer_look answer_look(const struct answer_told *t, size_t thing)
{
	static const char is[] = " that is", made[] = " that is made ";
	const size_t n = strlen(t->asked.text[0]);
	const int is_same = !strncmp(t->asked.text[0], t->asked.text[1], n);
	const char *said = t->asked.text[1] + (is_same ? n : 0), *last = is_same ? strrchr(said, ' ') : NULL;
	const int is_plain = last && last == said + strlen(is);
	const int colour = is_plain ? colour_word(last + 1) : -1;
	const int material =
		is_plain || (last && !strncmp(said, made, strlen(made))) ? material_of(last + 1) : -1;

	if (colour >= 0) /* a second colour is hardly looked for: "the yellow box that is black" */
		return is_coloured(t, thing, colour) ? LOOK_YES : LOOK_NO;
	return material < 0 ? LOOK_NONE : is_made(t, thing, material);
}

/* What else sentences say of a thing. */
static void say_looks(const struct answer_told *t, size_t thing, struct parse_words *to)
{
	const struct vocabulary *v = t->answer->words;
	const int is_of = strstr(t->question, "material") || strstr(t->question, "made ") ||
			  strstr(t->question, "built ");

	if (strstr(t->question, "pattern")) {
		parse_words_add(to, find_pattern(t, thing));
		return;
	}
	for (size_t i = 0; i < v->n; i++)
		if (v->items[i].object == thing && v->items[i].role == VOCABULARY_ATTRIBUTE &&
			colour_word(v->items[i].lemma) < 0 && !strstr(to->to, v->items[i].lemma) &&
			(!is_of || material_of(v->items[i].lemma) >= 0)) {
			parse_words_add(to, to->n ? ", " : "");
			parse_words_add(to, v->items[i].lemma);
		}
}

void answer_looks(const struct answer_told *t, int is_colour, char *to, size_t room)
{
	char own[CALLING_TEXT];
	struct parse_words words = {to, 0, room};

	*to = 0;
	for (size_t k = 0; k < t->answer->count; k++) {
		struct parse_words w = {own, *own = 0, sizeof own};
		(is_colour ? say_colours : say_looks)(t, t->answer->things[k], &w);
		if (*own && strstr(to, own))
			continue;
		parse_words_add(&words, *to ? ", " : "");
		parse_words_add(&words, *own ? own : "not known");
	}
}

static int is_with(const struct parse *p, int phrase)
{
	int is = 0;

	for (int k = 0; k < p->clause_count; k++)
		is |= p->clauses[k].relation == PARSE_WITH && parse_list_has(&p->clauses[k].anchors, phrase);
	return is;
}

/* The colours that sentences say a part of a thing has: "with black handles". */
static void say_part(const struct vocabulary *v, size_t thing, const char *part, struct parse_words *to)
{
	for (size_t r = 0; r < v->lifted->sentences; r++) {
		const struct parse *p = &v->parses[r];
		for (int k = 1; k < p->phrase_count && (size_t)v->lifted->object[r] == thing; k++) {
			const struct parse_list *noun = &p->phrases[k].noun, *say = &p->phrases[k].attributes;
			const int is_part = noun->n && is_with(p, k) &&
					    !strcmp(p->words[noun->item[noun->n - 1]].lemma, part);
			for (int i = 0; i < say->n && is_part; i++) {
				const int c = colour_word(p->words[say->item[i]].lemma);
				if (c < 0 || strstr(to->to, colour_name(c)))
					continue;
				parse_words_add(to, to->n ? " and " : "");
				parse_words_add(to, colour_name(c));
			}
		}
	}
}

/* Words for the thing itself, as far as its colour goes. */
static int is_aspect(const char *noun)
{
	return words_have(
		" side top front back bottom inside outside middle rest body surface whole pair set "
		"piece ",
		noun);
}

int answering_colour(struct answer_told *t, struct asking_answer *found, struct asking *a,
	const struct report *to, struct err *e)
{
	SCOPED_BY(asking_answer_free) struct asking_answer whole = {0};
	const struct question_asked *q = &t->asked;
	char part[TOKEN_LENGTH], own[CALLING_TEXT] = "";
	struct parse_words words = {own, 0, sizeof own};

	if (!*q->text[1])
		return asking_ask(a, q->text[0], 0, found, to, e);
	question_noun(q->text[0], part);
	if (asking_ask(a, q->text[1], 0, &whole, to, e))
		return -1;
	if (whole.count == 1 && !answering_is_unsure(&whole))
		say_part(whole.words, whole.things[0], part, &words);
	if (*own) {
		answering_say(t, "%s", own);
		*found = whole;
		whole = (struct asking_answer){0};
		return 0;
	}
	if (asking_ask(a, q->text[0], 0, found, to, e))
		return -1;
	if (whole.count == 1 && found->count == 1 && whole.things[0] == found->things[0] && *part &&
		strstr(q->text[0], " of ") && !is_aspect(part)) {
		found->count = 0;
		snprintf(found->reason, sizeof found->reason, "no sentence says what colour its %s is", part);
	}
	return 0;
}
