#include "lang/examples_private.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* The share of sentences that have talk around them. */
#define TALK 0.25

static const char *target_noun(struct making *m)
{
	return m->nouns->item[m->noun];
}

static void target_clauses(struct making *m)
{
	int n = making_chance(m, 0.12) ? 0 : making_chance(m, 0.25) ? 2 : 1;

	for (int k = 0; k < n; k++) {
		if (k)
			making_put_any(m, "and|,|,|and_is|");
		making_clause(m, ROOT, FORM_PLACED | FORM_HAVING | FORM_TURNED, 0);
	}
}

/* "the one", "the left one": the target where its noun is left out. */
static void target_one(struct making *m)
{
	int list[8], count = 0, last;

	making_put_any(m, "the|the|the|that|this");
	if (making_chance(m, 0.25))
		making_put_before(m, list, &count);
	if (making_chance(m, 0.2)) {
		last = making_put_any(m, making_pick(m, &example_attributes));
		making_mark(m, last, last + 1, ROLE_ATTRIBUTE, ROOT);
	}
	last = making_put_any(m, "one|one|one|thing|object");
	if (!m->has_noun)
		m->word[last].role = ROLE_TARGET;
}

static void adjective(struct making *m)
{
	int list[8], count = 0;

	making_put_before(m, list, &count);
	m->word[list[0]].head = ROOT;
}

/* "the red one", that is meant. */
static void one_of_look(struct making *m, enum word_role role)
{
	int first, last;

	making_put_any(m, "the|the|that|a");
	first = m->n;
	making_put_any(m, making_pick(m, &example_attributes));
	last = making_put_any(m, "one|one|one|thing|ones");
	making_mark(m, last, last + 1, role, ROOT);
	making_mark(m, first, last, ROLE_ATTRIBUTE, role == ROLE_TARGET ? ROOT : last);
	if (making_chance(m, 0.25))
		making_clause(m, role == ROLE_TARGET ? ROOT : last, FORM_PLACED | FORM_HAVING, 0);
}

static const struct example_clause *pick_clause(struct making *m, const struct example_clauses *of)
{
	return &of->item[rng_below(m->r, (uint32_t)of->n)];
}

/* "near it", "between them": of what was spoken of. */
static void points_back(struct making *m, const struct example_clauses *of)
{
	const struct example_clause *c = pick_clause(m, of);
	int at = m->n;

	making_expand(m, c, ROOT, 0, 0);
	while (at < m->n && m->word[at].role != ROLE_PREDICATE)
		at++;
	for (int k = 0; k < m->spoken && at < m->n; k++)
		m->word[m->spoken_of[k]].head = at;
}

/* 1 where the symbol was one. */
static int symbol(struct making *m, const char *p, size_t length, int before_sure)
{
	if (length == 2 && p[0] == 'C' && p[1] == '2') {
		making_clause(m, ROOT, FORM_PLACED, 1);
		return 1;
	}
	if (length != 1)
		return 0;
	switch (*p) {
	case 'T':
	case 'N':
		making_noun_phrase(m, ROLE_TARGET, ROOT, target_noun(m), *p == 'T' && making_chance(m, 0.06),
			before_sure);
		m->has_noun = 1;
		if (*p == 'T')
			target_clauses(m);
		return 1;
	case 'L':
		making_noun_phrase(m, ROLE_TARGET, ROOT, target_noun(m), 1, 1);
		m->has_noun = 1;
		return 1;
	case 'n':
		if (making_chance(m, 0.7))
			making_noun_phrase(m, ROLE_TARGET, ROOT, target_noun(m), 0, 1);
		else
			making_put(m, "one", 3);
		return 1;
	case 'U':
		target_one(m);
		if (making_chance(m, 0.8))
			target_clauses(m);
		return 1;
	case 'C':
		making_clause(m, ROOT, FORM_PLACED, 0);
		return 1;
	case 'H':
		making_clause(m, ROOT, FORM_HAS, 0);
		return 1;
	case 'A':
		adjective(m);
		return 1;
	case 'Q':
		one_of_look(m, ROLE_TARGET);
		return 1;
	case 'O':
		one_of_look(m, ROLE_ALSO);
		return 1;
	case 'q': {
		int first = m->n;
		making_put_any(m, making_pick(m, &example_attributes));
		making_mark(m, first, m->n, ROLE_ATTRIBUTE, ROOT);
		return 1;
	}
	case 'F':
		making_function(m, ROOT);
		return 1;
	case 'V':
		making_anchor(m, ROLE_VIEW, 1);
		return 1;
	case 'B': {
		const int at = making_anchor(m, ROLE_ANCHOR, making_chance(m, 0.4));
		if (m->spoken < 2)
			m->spoken_of[m->spoken++] = at;
		return 1;
	}
	case 'D':
		points_back(m, &m->w->back);
		return 1;
	case 'P':
		points_back(m, &m->w->back_to_two);
		return 1;
	case 'R':
		points_back(m, &m->w->travelled);
		return 1;
	case 'G':
		making_expand(m, pick_clause(m, &m->w->inverted), ROOT, 0, 0);
		return 1;
	case 'W':
		making_clause(m, ROOT, FORM_WITH, 0);
		return 1;
	case 'X':
		making_anchor(m, ROLE_EXCEPT, 1);
		return 1;
	case 'S':
		making_anchor(m, ROLE_ALSO, 1);
		return 1;
	default:
		return 0;
	}
}

/* Words that stand for the target where a sentence has no noun of it. */
static int stands_for_target(const char *word)
{
	static const char *const words[] = {"thing", "things", "everything", "object", "objects", "item",
		"items", "stuff", "something", "anything", "whatever", NULL};

	for (int i = 0; words[i]; i++)
		if (!strcmp(word, words[i]))
			return 1;
	return 0;
}

static void sentence(struct making *m, const char *text)
{
	for (const char *p = text; *p;) {
		size_t length = strcspn(p, " ");
		if (!symbol(m, p, length, making_follows_article(m))) {
			int first = m->n;
			making_put_choice(m, p, length);
			for (int i = first; i < m->n; i++)
				if (!m->has_noun && stands_for_target(m->word[i].text))
					m->word[i].role = ROLE_TARGET;
		}
		p += length;
		p += *p == ' ';
	}
}

/* A sentence with its target. */
static void whole(struct making *m, const char *text)
{
	/* the target's noun may stand after "the one", which is the target only where none does */
	m->has_noun = strpbrk(text, "NL") != NULL || strchr(text, 'n') == text;
	sentence(m, text);
}

/* Words that mean nothing of what is there. */
static void chatter(struct making *m, const struct example_list *list)
{
	m->has_noun = 1;
	sentence(m, making_pick(m, list));
}

/* What a story is about is nothing that is meant. */
static void story_thing(struct making *m)
{
	int first = m->n;

	making_noun_phrase(m, ROLE_ANCHOR, ROOT, making_pick(m, m->nouns), making_chance(m, 0.3), 0);
	making_mark(m, first, m->n, ROLE_NONE, ROOT);
}

static void tell(struct making *m, const struct example_list *list)
{
	const char *text = making_pick(m, list);

	for (const char *p = text; *p;) {
		size_t length = strcspn(p, " ");
		int first = m->n;
		making_put_choice(m, p, length);
		if (m->n == first + 1 && !strcmp(m->word[first].text, "0")) {
			m->n = first;
			story_thing(m);
		}
		p += length;
		p += *p == ' ';
	}
}

/* "my sister painted a cup once . now , bring me" */
static void story(struct making *m)
{
	const struct example_talk *t = m->w->talk;

	for (int k = making_chance(m, 0.3) ? 2 : 1; k; k--) {
		tell(m, &t->subjects);
		tell(m, &t->deeds);
		tell(m, &t->tails);
		if (k > 1)
			making_put_any(m, ",|and|.|and_then|because");
	}
	tell(m, &t->links);
	tell(m, &t->requests);
}

static void talk(struct making *m)
{
	const int has_before = making_chance(m, 0.8);

	if (has_before && making_chance(m, 0.3))
		story(m);
	else if (has_before)
		chatter(m, &m->w->talk->before);
	whole(m, making_pick(m, &m->w->talk->core));
	if (!has_before || making_chance(m, 0.3))
		chatter(m, &m->w->talk->after);
}

/* A slip of the fingers. */
static void misspell(struct making *m, char *w)
{
	size_t n = strlen(w), i;
	char c;

	if (n < 4 || !isalpha((unsigned char)w[0]))
		return;
	i = 1 + rng_below(m->r, (uint32_t)n - 2);
	if (making_chance(m, 0.5)) {
		c = w[i];
		w[i] = w[i + 1] ? w[i + 1] : w[i];
		w[i + 1] = w[i + 1] ? c : 0;
	} else {
		memmove(w + i, w + i + 1, n - i);
	}
}

static void write_text(struct making *m, struct example *x)
{
	int at = 0, capital = making_chance(m, 0.6), stops = making_chance(m, 0.75),
	    slips = making_chance(m, 0.08);

	for (int i = 0; i < m->n; i++) {
		struct made *w = &m->word[i];
		int is_pause = !strcmp(w->text, ",") || !strcmp(w->text, ".") || !strcmp(w->text, "?");
		if (slips && making_chance(m, 0.2))
			misspell(m, w->text);
		if (is_pause && !stops)
			w->text[0] = 0;
		if (!w->text[0]) {
			w->begin = -1;
			continue;
		}
		if (at + MADE_LENGTH + 2 > EXAMPLE_LENGTH)
			break;
		if (at && !is_pause && w->text[0] != '\'' && strcmp(w->text, "n't") != 0)
			x->text[at++] = ' ';
		w->begin = at;
		at += sprintf(x->text + at, "%s", w->text);
	}
	x->text[at] = 0;
	if (capital)
		x->text[0] = (char)toupper((unsigned char)x->text[0]);
}

static void analyse(const struct making *m, struct example *x, const char *pieces)
{
	int at[MADE_MOST], next = 0;

	tokens_take(&x->tokens, x->text, pieces, NULL, 0);
	x->analysis = (struct analysis){.n = x->tokens.n};
	for (int i = 0; i < m->n; i++) {
		while (next < x->tokens.n && x->tokens.word[next].span.begin < m->word[i].begin)
			next++;
		at[i] = next < x->tokens.n && x->tokens.word[next].span.begin == m->word[i].begin ? next : -1;
	}
	for (int i = 0; i < x->tokens.n; i++)
		x->analysis.word[i].head = ROOT;
	for (int i = 0; i < m->n; i++) {
		const struct made *w = &m->word[i];
		if (at[i] < 0 || w->role == ROLE_NONE)
			continue;
		x->analysis.word[at[i]].role = w->role;
		x->analysis.word[at[i]].head = w->head == ROOT ? ROOT : at[w->head];
		x->analysis.word[at[i]].relation = w->relation;
		x->analysis.word[at[i]].negated = w->negated;
	}
	analysis_repair(&x->analysis);
}

void example_make(struct example *x, enum examples_set set, const char *pieces, struct rng *r)
{
	struct making m = {.w = set == EXAMPLES_TEST ? &example_wordings_test : &example_wordings_train,
		.nouns = &example_nouns[set],
		.r = r};

	m.noun = (int)rng_below(r, (uint32_t)m.nouns->n);
	if (m.w->talk && making_chance(&m, TALK))
		talk(&m);
	else
		whole(&m, making_pick(&m, m.w->sentences));
	write_text(&m, x);
	analyse(&m, x, pieces);
}
