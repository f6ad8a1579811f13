/* Texts, names and refs hold letters, digits and plain signs: no escapes in JSON. */
#include "cmd/synth/benchmark.h"

#include <string.h>

/* Words with spaces between. */
static void put_strings(FILE *to, const char *comma, const char *words)
{
	for (size_t n; words && (n = strcspn(words, " ")); words += n + (words[n] == ' '), comma = ",")
		fprintf(to, "%s\"%.*s\"", comma, (int)n, words);
}

/* Other attributes, then those of the colour: "dark blue" is the colour blue with the word dark. */
static void put_attributes(FILE *to, const struct synth_phrase *p)
{
	const char *finish = p->words[SYNTH_FINISH_WORD], *colour = p->words[SYNTH_COLOUR_WORD];
	const char *space = colour ? strrchr(colour, ' ') : NULL;

	if (!finish && !colour)
		return;
	fputs(",\"words\":[", to);
	put_strings(to, "", finish);
	put_strings(to, finish ? "," : "", colour);
	fputc(']', to);
	if (colour)
		fprintf(to, ",\"colour\":\"%s\"", space ? space + 1 : colour);
}

static void put_count(FILE *to, const struct synth_phrase *p)
{
	if (p->count == PARSE_ALL)
		fputs(",\"count\":\"all\"", to);
	else if (p->count == PARSE_SEVERAL)
		fputs(",\"count\":\"several\"", to);
	else if (p->count == PARSE_ONE)
		fputs(",\"count\":\"one\"", to);
	else
		fprintf(to, ",\"count\":%d", p->count);
}

static void put_phrase(FILE *to, const struct synth_sentence *x, int phrase);

static void put_phrases(FILE *to, const struct synth_sentence *x, const char *key, const int *phrases, int n)
{
	fprintf(to, ",\"%s\":[", key);
	for (int i = 0; i < n; i++) {
		fputs(i ? "," : "", to);
		put_phrase(to, x, phrases[i]);
	}
	fputc(']', to);
}

/* What stands on or carries its anchor is above or below it, with contact. */
static void put_clause(FILE *to, const struct synth_sentence *x, const struct synth_clause *c)
{
	static const char *const degrees[] = {"plain", "more", "most"};
	enum parse_relation r = c->is.relation;

	fprintf(to, "{\"relation\":\"%s\",\"negated\":%s",
		parse_relation_name(r == PARSE_ON	  ? PARSE_ABOVE
				    : r == PARSE_SUPPORTS ? PARSE_BELOW
							  : r),
		c->negated ? "true" : "false");
	if (r == PARSE_ON || r == PARSE_SUPPORTS)
		fputs(",\"contact\":true", to);
	if (c->is.degree != PARSE_PLAIN)
		fprintf(to, ",\"degree\":\"%s\"", degrees[c->is.degree]);
	put_phrases(to, x, "anchors", c->anchors, c->anchor_count);
	if (r == PARSE_OTHER) {
		fputs(",\"words\":[", to);
		put_strings(to, "", c->said->more);
		fputc(']', to);
	}
	fputc('}', to);
}

/* What hangs on a phrase. The target's stands beside "target", another's within it. */
static void put_rest(FILE *to, const struct synth_sentence *x, const struct synth_phrase *p)
{
	const char *size = p->words[SYNTH_SIZE_WORD];

	fputs(",\"clauses\":[", to);
	if (size)
		fprintf(to, "{\"relation\":\"%s\",\"negated\":false,\"anchors\":[],\"words\":[\"%s\"]}",
			p->sense.surely[SYNTH_SIZE] >> SYNTH_BIG & 1 ? "larger" : "smaller", size);
	for (int i = 0; i < p->clause_count; i++) {
		fputs(i || size ? "," : "", to);
		put_clause(to, x, &x->clauses[p->clauses[i]]);
	}
	fputc(']', to);
	if (p->of_several)
		fputs(",\"group\":\"several\"", to);
	if (p->group)
		fprintf(to, ",\"group\":%d", p->group);
	if (p->ordinal)
		fprintf(to, ",\"ordinal\":{\"k\":%d,\"from\":\"%s\"}", p->ordinal,
			parse_relation_name(p->from));
	if (p->except_count)
		put_phrases(to, x, "except", p->except, p->except_count);
	if (p->also_count)
		put_phrases(to, x, "also", p->also, p->also_count);
}

/* "One" goes by the target's noun, but for "nothing", which goes by none. */
static void put_phrase(FILE *to, const struct synth_sentence *x, int phrase)
{
	const struct synth_phrase *p = &x->phrases[phrase];

	fprintf(to, "{\"noun\":\"%s\"",
		*p->words[SYNTH_NOUN] || p->is_anything ? p->words[SYNTH_NOUN]
							: x->phrases[0].words[SYNTH_NOUN]);
	put_attributes(to, p);
	put_count(to, p);
	if (p->viewer)
		fputs(",\"viewer\":true", to);
	put_rest(to, x, p);
	fputc('}', to);
}

static void put_parse(FILE *to, const struct synth_sentence *x)
{
	const struct synth_phrase *p = &x->phrases[0];

	fprintf(to, "{\"ref\":\"%s\",\"text\":\"%s\",\"target\":{\"noun\":\"%s\"", x->ref, x->text,
		p->words[SYNTH_NOUN]);
	put_attributes(to, p);
	fputc('}', to);
	put_count(to, p);
	put_rest(to, x, p);
	fputs("}\n", to);
}

void synth_unseen_put(FILE *out, const void *folder)
{
	const struct synth_folder *f = folder;

	for (size_t i = 0; i < f->unseen->n; i++) {
		const struct synth_sentence *x = &f->unseen->items[i];
		synth_put_sentence(out, f, x->ref, x->objects, x->text, synth_unseen_kind_name(x->kind));
		if (x->view >= 0)
			fprintf(out, ",\"view\":\"%s\"", f->scene->cameras.views[x->view].name);
		fputs("}\n", out);
	}
}

void synth_unseen_put_parses(FILE *out, const void *folder)
{
	const struct synth_folder *f = folder;

	for (size_t i = 0; i < f->unseen->n; i++)
		put_parse(out, &f->unseen->items[i]);
}
