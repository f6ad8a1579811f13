#include "cmd/ask/saying_parts.h"

#include "base/mem.h"
#include "lang/kinds.h"
#include "lang/naming.h"

#include <stdio.h>

enum { TEXT = 256 };

/* A noun is a synonym where it is as likely to name the thing. */
static const double synonym = 0.55;

void saying_parts_free(struct saying_parts *p)
{
	for (size_t i = 0; p->lists && i < p->objects * SAYING_KINDS; i++)
		free(p->lists[i].items);
	free(p->lists);
	*p = (struct saying_parts){0};
}

static int add_part(
	struct saying_parts *s, size_t object, enum saying_part kind, const char *text, struct err *e)
{
	struct saying_list *p = &s->lists[object * SAYING_KINDS + kind];

	if (!*text || strlen(text) >= SAYING_PART)
		return 0;
	for (size_t i = 0; i < p->n; i++)
		if (!strcmp(p->items[i], text))
			return 0;
	if (mem_grow((void **)&p->items, &p->capacity, p->n + 1, sizeof *p->items, "sentences", e))
		return -1;
	memcpy(p->items[p->n++], text, strlen(text) + 1);
	return 0;
}

/* Words, or their lemmas, with blanks between. */
static void join(const struct parse *p, const struct parse_list *words, int is_lemmas, char out[TEXT])
{
	size_t n = 0;

	*out = 0;
	for (int i = 0; i < words->n && n < TEXT; i++) {
		const struct parse_word *w = &p->words[words->item[i]];
		n += (size_t)snprintf(
			out + n, TEXT - n, "%s%s", i ? " " : "", is_lemmas ? w->lemma : w->text);
	}
}

/* Everyday nouns (lang/kinds.h). */
struct nouns {
	size_t n, capacity;
	struct noun {
		char text[KINDS_LENGTH];
		struct naming naming; /* its lemma is text */
	} * items;
};

static void nouns_free(struct nouns *n)
{
	free(n->items);
}

static int nouns_read(struct nouns *to, struct err *e)
{
	struct noun one;

	for (long at = 0; kinds_next(&at, one.text);) {
		if (mem_grow((void **)&to->items, &to->capacity, to->n + 1, sizeof one, "nouns", e))
			return -1;
		to->items[to->n++] = one;
	}
	for (size_t i = 0; i < to->n; i++)
		naming_of_word(&to->items[i].naming, to->items[i].text);
	return 0;
}

/* What a thing of this noun may be called too. */
static int add_synonyms(
	struct saying_parts *s, size_t object, const char *lemma, const struct nouns *nouns, struct err *e)
{
	struct naming thing;

	naming_of_thing(&thing, lemma);
	for (size_t i = 0; i < nouns->n; i++) {
		const struct noun *n = &nouns->items[i];
		if (strcmp(n->text, lemma) != 0 && strcmp(n->text, "entity") != 0 &&
			naming_fits(&n->naming, &thing, 0) > synonym &&
			add_part(s, object, SAYING_SYNONYM, n->text, e))
			return -1;
	}
	return 0;
}

/* "with a yellow scarf", as it stands in the text: nothing where more is said of what it has. */
static void cut_having(const struct parse *p, const struct parse_clause *c, const char *text, char out[TEXT])
{
	int end = 0;

	*out = 0;
	for (int i = 0; i < c->anchors.n; i++) {
		const struct parse_phrase *a = &p->phrases[c->anchors.item[i]];
		if (a->clauses.n)
			return;
		end = a->span.end > end ? a->span.end : end;
	}
	if (end > c->span.begin && end - c->span.begin < TEXT)
		snprintf(out, TEXT, "%.*s", end - c->span.begin, text + c->span.begin);
}

/* What a training sentence calls its thing, and says of it alone. */
static int take_parts(struct saying_parts *s, const struct lifted *l, size_t r, const struct parse *p,
	const struct nouns *nouns, struct err *e)
{
	const struct parse_phrase *target = p->phrases;
	const size_t object = (size_t)l->object[r];
	char text[TEXT];

	join(p, &target->noun, 0, text);
	int bad = add_part(s, object, SAYING_NOUN, text, e);
	join(p, &target->noun, 1, text);
	bad = bad || (*text && add_synonyms(s, object, text, nouns, e));
	for (int i = 0; i < target->attributes.n && !bad; i++)
		bad = add_part(s, object, SAYING_LOOK, p->words[target->attributes.item[i]].text, e);
	for (int i = 0; i < target->clauses.n && !bad; i++) {
		const struct parse_clause *c = &p->clauses[target->clauses.item[i]];
		if (c->negated || c->degree != PARSE_PLAIN)
			continue;
		if (c->relation >= PARSE_LARGER && c->relation <= PARSE_WIDER && !c->anchors.n) {
			join(p, &c->words, 0, text);
			bad = add_part(s, object, SAYING_LOOK, text, e);
		} else if (c->relation == PARSE_WITH && c->anchors.n) {
			cut_having(p, c, l->texts[r], text);
			bad = add_part(s, object, SAYING_HAVING, text, e);
		}
	}
	return bad;
}

int saying_parts_read(struct saying_parts *s, const struct asking *a, struct err *e)
{
	const struct lifted *l = &a->model.lifted;
	SCOPED_BY(nouns_free) struct nouns nouns = {0};

	*s = (struct saying_parts){.objects = l->objects};
	s->lists = mem_zalloc(l->objects, SAYING_KINDS * sizeof *s->lists, "sentences", e);
	int bad = !s->lists || nouns_read(&nouns, e);
	for (size_t r = 0; r < l->sentences && !bad; r++)
		bad = take_parts(s, l, r, chooser_parse(a->chooser, r), &nouns, e);
	return bad;
}

const char *saying_parts_draw(
	const struct saying_parts *s, size_t object, enum saying_part kind, struct rng *r)
{
	const struct saying_list *p = &s->lists[object * SAYING_KINDS + kind];

	return p->n ? p->items[rng_below(r, (uint32_t)p->n)] : NULL;
}

int saying_parts_have(const struct saying_parts *s, size_t object, enum saying_part kind, const char *text)
{
	const struct saying_list *p = &s->lists[object * SAYING_KINDS + kind];

	for (size_t i = 0; i < p->n; i++)
		if (!strcmp(p->items[i], text))
			return 1;
	return kind == SAYING_NOUN && saying_parts_have(s, object, SAYING_SYNONYM, text);
}
