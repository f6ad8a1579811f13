#include "ask/refusal.h"

#include "base/utf8.h"

#include <string.h>

void parse_words_bytes(struct parse_words *w, const char *from, size_t n)
{
	while (n && w->n + n + 1 > w->room)
		n--;
	while (n && utf8_check(from, n) < n)
		n--;
	memcpy(w->to + w->n, from, n);
	w->to[w->n += n] = 0;
}

void parse_words_add(struct parse_words *w, const char *text)
{
	parse_words_bytes(w, text, strlen(text));
}

void parse_words_phrase(struct parse_words *w, const struct parse *p, const char *text, int phrase)
{
	const struct parse_span *s = &p->phrases[phrase].span;

	if (p->phrases[phrase].viewer)
		parse_words_add(w, "you");
	else if (s->begin < s->end)
		parse_words_bytes(w, text + s->begin, (size_t)(s->end - s->begin));
	else
		parse_words_add(w, "one");
}

void parse_words_clause(
	struct parse_words *w, const struct parse *p, const char *text, const struct parse_clause *c)
{
	static const char *const degrees[] = {"", "more ", "most "};

	parse_words_add(w, c->negated ? "not " : "");
	if (c->relation != PARSE_OTHER) /* the word itself compares: "darkest" */
		parse_words_add(w, degrees[c->degree]);
	if (c->relation == PARSE_OTHER && c->span.begin < c->span.end)
		parse_words_bytes(w, text + c->span.begin, (size_t)(c->span.end - c->span.begin));
	else
		parse_words_add(w, parse_relation_name(c->relation));
	for (int k = 0; k < c->anchors.n; k++) {
		parse_words_add(w, k ? " and " : " (");
		parse_words_phrase(w, p, text, c->anchors.item[k]);
	}
	parse_words_add(w, c->anchors.n ? ")" : "");
}

void parse_words_tree(struct parse_words *w, const struct parse *p, const char *text, int phrase, int depth)
{
	const struct parse_phrase *f = &p->phrases[phrase];

	parse_words_phrase(w, p, text, phrase);
	for (int k = 0; k < f->clauses.n && depth < 4; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		parse_words_add(w, ", ");
		parse_words_clause(w, p, text, c);
		for (int j = 0; j < c->anchors.n; j++)
			if (p->phrases[c->anchors.item[j]].clauses.n) {
				parse_words_add(w, " [");
				parse_words_tree(w, p, text, c->anchors.item[j], depth + 1);
				parse_words_add(w, "]");
			}
	}
	if (!phrase && p->view != PARSE_VIEW_NONE && p->view_phrase > 0) {
		parse_words_add(w, p->view == PARSE_VIEW_FACING ? ", facing (" : ", seen from (");
		parse_words_phrase(w, p, text, p->view_phrase);
		parse_words_add(w, ")");
	}
	for (int k = 0; k < f->among.n && depth < 4; k++) {
		parse_words_add(w, k ? " or " : ", one of: ");
		parse_words_tree(w, p, text, f->among.item[k], depth + 1);
	}
	for (int k = 0; k < f->except.n && depth < 4; k++) {
		parse_words_add(w, ", but not ");
		parse_words_tree(w, p, text, f->except.item[k], depth + 1);
	}
	for (int k = 0; k < f->also.n && depth < 4; k++) {
		parse_words_add(w, "; and ");
		parse_words_tree(w, p, text, f->also.item[k], depth + 1);
	}
}

void parse_words_noun(struct parse_words *w, const struct parse *p, int phrase)
{
	const struct parse_list *noun = &p->phrases[phrase].noun;

	for (int k = 0; k < noun->n; k++) {
		parse_words_add(w, k ? " " : "");
		parse_words_add(w, p->words[noun->item[k]].text);
	}
}
