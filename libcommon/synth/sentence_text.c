/* Puts the phrases and clauses of a sentence into words. */
#include "synth/sentence.h"

#include <string.h>

/* A text in the making. */
struct writer {
	const struct synth_sentence *s;
	const char *inner;
	struct rng *rng;
	char *text;
	size_t used;
	int next; /* the target's clause for %R and %Z */
	int is_bad;
	int is_it; /* the first clause's first anchor was named before: it is "it" now */
};

static void put(struct writer *w, const char *text)
{
	size_t n = strlen(text);

	if (w->used + n >= SYNTH_TEXT) {
		w->is_bad = 1;
		return;
	}
	memcpy(w->text + w->used, text, n + 1);
	w->used += n;
}

static void put_clauses(struct writer *w, const struct synth_phrase *p);

/* "small striped red mug" */
static void put_words(struct writer *w, const struct synth_phrase *p, int is_plural)
{
	int said = p->clause_count + (*p->words[SYNTH_NOUN] != 0);

	for (int k = 0; k < SYNTH_NOUN; k++)
		if (p->words[k]) {
			put(w, p->words[k]);
			put(w, " ");
			said++;
		}
	if (*p->words[SYNTH_NOUN])
		put(w, is_plural ? p->plural : p->words[SYNTH_NOUN]);
	else
		put(w, is_plural ? "ones" : "one");
	w->is_bad |= !said;
}

/* The words with their clauses: "the plate that's behind the red ball". */
static void put_phrase(struct writer *w, const struct synth_phrase *p, int is_plural)
{
	put_words(w, p, is_plural);
	if (p->clause_count) {
		put(w, " ");
		put_clauses(w, p);
	}
}

/* "the red ball", "the two balls" */
static void put_anchor(struct writer *w, int phrase)
{
	const struct synth_phrase *p = &w->s->phrases[phrase];

	put(w, p->count == 2 ? "the two " : "the ");
	put_phrase(w, p, p->count != PARSE_ONE);
}

static void put_wording(struct writer *w, const struct synth_clause *c, int is_first)
{
	for (const char *t = c->said->text; *t && !w->is_bad; t++) {
		char letter[2] = {*t, 0};
		if (*t != '%')
			put(w, letter);
		else if (*++t == 'A' && is_first && w->is_it)
			put(w, "it");
		else
			put_anchor(w, c->anchors[*t == 'A' ? 0 : c->anchor_count - 1]);
	}
}

/* After the noun: "left of it", "that's left of it", "which has it on its right". */
static void put_after(struct writer *w, const struct synth_clause *c, int is_first, int is_nested)
{
	static const char *const copulas[] = {"", "", "that's ", "that is ", "which is "};
	/* Within another phrase the bare form could belong to either noun. */
	uint32_t from = is_nested ? 2 : 0;

	if (c->said->form == 'p' && !(c->is.degree == PARSE_MOST && !c->anchor_count))
		put(w, copulas[from + rng_below(w->rng, 5 - from)]);
	if (c->said->form == 'h')
		put(w, rng_below(w->rng, 2) ? "that " : "which ");
	put_wording(w, c, is_first);
}

static void put_clause(struct writer *w, const struct synth_phrase *p, int k)
{
	const struct synth_clause *c = &w->s->clauses[p->clauses[k]];
	int is_nested = p != &w->s->phrases[0];

	if (k < p->clause_count && c->said && c->is.relation != PARSE_OTHER && c->said->form != 'c')
		put_after(w, c, !is_nested && !k, is_nested);
	else
		w->is_bad = 1;
}

static void put_clauses(struct writer *w, const struct synth_phrase *p)
{
	for (int k = 0; k < p->clause_count; k++) {
		put(w, k ? " and " : "");
		put_clause(w, p, k);
	}
}

/* The target's first clause, whose form must be one of these. */
static void put_first(struct writer *w, const char *forms)
{
	const struct synth_phrase *p = &w->s->phrases[0];
	const struct synth_clause *c = &w->s->clauses[p->clauses[0]];

	/* Nobody looks "nearest to the cup". */
	if (p->clause_count != 1 || !strchr(forms, c->said->form) ||
		(!forms[1] && c->is.degree == PARSE_MOST)) {
		w->is_bad = 1;
		return;
	}
	if (forms[1] && c->said->form == 'p')
		put(w, "is ");
	put_wording(w, c, 1);
}

/* The first clause's first anchor; from now on it is "it". */
static void put_named(struct writer *w, const struct synth_phrase *p)
{
	const struct synth_clause *c = &w->s->clauses[p->clauses[0]];

	w->is_bad |= !p->clause_count || !c->anchor_count || !strchr("pc", c->said->form) ||
		     w->s->phrases[c->anchors[0]].viewer;
	if (!w->is_bad)
		put_anchor(w, c->anchors[0]);
	w->is_it = 1;
}

static void put_slot(struct writer *w, char slot)
{
	static const char words[] = "SFMCNG";
	static const char *const numbers[] = {"two", "three", "four", "five", "six"};
	static const char *const ordinals[][2] = {{"second", "2nd"}, {"third", "3rd"}, {"fourth", "4th"}};
	const struct synth_phrase *p = &w->s->phrases[0];
	const char *word = strchr(words, slot);
	int k;

	if (word) {
		put(w, p->words[slot == 'G' ? SYNTH_NOUN : word - words]);
		w->is_bad |= slot == 'N' && !*p->words[SYNTH_NOUN];
		return;
	}
	switch (slot) {
	case 'Q':
		put(w, p->plural);
		break;
	case 'T':
	case 'P':
		put_words(w, p, slot == 'P');
		break;
	case 'R':
		put_clause(w, p, w->next++);
		break;
	case 'W':
		w->is_bad |= !p->clause_count && w->used > 4 && !strcmp(w->text + w->used - 4, "one ");
		put_clauses(w, p);
		break;
	case 'V':
	case 'L':
		put_first(w, slot == 'V' ? "ph" : "p");
		break;
	case 'A':
		put_named(w, p);
		break;
	case 'X':
	case 'Y':
		k = slot - 'X';
		put_phrase(w, &w->s->phrases[p->except_count ? p->except[k] : p->also[k]], 0);
		break;
	case 'K':
		put(w, numbers[(p->group ? p->group : p->count) - 2]);
		break;
	case 'O':
		put(w, ordinals[p->ordinal - 2][rng_below(w->rng, 5) == 0]);
		break;
	case 'E':
		put(w, p->from == PARSE_BEHIND ? "back" : parse_relation_name(p->from));
		break;
	case 'Z':
		put(w, w->s->clauses[p->clauses[w->next++]].said->text);
		break;
	case 'U':
		put(w, w->s->clauses[p->clauses[0]].said->text);
		break;
	default: /* I */
		put(w, w->inner);
	}
}

/* No spaces before stops or at the end, or twice; "an" before a vowel. */
static void tidy(char *text)
{
	char from[SYNTH_TEXT], *to = text;

	memcpy(from, text, strlen(text) + 1);
	for (const char *p = from; *p; p++) {
		if (*p == ' ' && (!p[1] || strchr(" ,?.", p[1])))
			continue;
		*to++ = *p;
		if ((p == from || p[-1] == ' ') && !strncmp(p, "a ", 2) && p[2] && strchr("aeiou", p[2]))
			*to++ = 'n';
	}
	*to = 0;
}

int synth_write(struct synth_sentence *s, const char *frame, const char *inner, struct rng *r)
{
	char text[SYNTH_TEXT] = "";
	struct writer w = {.s = s, .inner = inner, .rng = r, .text = text};

	for (const char *p = frame; *p && !w.is_bad; p++) {
		char letter[2] = {*p, 0};
		if (*p == '%')
			put_slot(&w, *++p);
		else
			put(&w, letter);
	}
	/* "an" may make it one longer for each word. */
	if (w.is_bad || w.used > SYNTH_TEXT - 24)
		return -1;
	tidy(text);
	memcpy(s->text, text, sizeof text);
	return 0;
}
