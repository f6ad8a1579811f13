/* Texts, names and refs hold letters, digits, apostrophes, stops, hyphens and spaces: JSON needs no escapes
 * for them. */
#include "cmd/synth/synth_unseen.h"

#include "base/file.h"

#include <stdlib.h>
#include <string.h>

/* The names of enum parse_relation, in its order. What stands on or carries its anchor is above or below it,
 * with contact. */
static const char *const relation_names[PARSE_RELATIONS] = {"left", "right", "front", "behind", "above",
	"below", "above", "inside", "near", "far", "between", "middle", "larger", "smaller", "taller",
	"shorter", "longer", "wider", "corner", "wall", "floor", "facing", "across", "below", "with",
	"other"};

static void put_strings(FILE *to, const char *key, const char *const *strings, int n)
{
	fprintf(to, ",\"%s\":[", key);
	for (int i = 0; i < n; i++)
		fprintf(to, "%s\"%s\"", i ? "," : "", strings[i]);
	fputc(']', to);
}

/* Other attributes, then those of the colour: "dark blue" is the colour blue with the word dark. */
static void put_attributes(FILE *to, const struct synth_unseen_phrase *p)
{
	const char *space = p->colour ? strrchr(p->colour, ' ') : NULL, *comma = "";
	const char *basic = space ? space + 1 : p->colour;

	if (!p->word_count && !p->colour)
		return;
	fputs(",\"words\":[", to);
	for (int i = 0; i < p->word_count; i++, comma = ",")
		fprintf(to, "%s\"%s\"", comma, p->words[i]);
	if (space) {
		fprintf(to, "%s\"%.*s\"", comma, (int)(space - p->colour), p->colour);
		comma = ",";
	}
	if (basic)
		fprintf(to, "%s\"%s\"", comma, basic);
	fputc(']', to);
	if (basic)
		fprintf(to, ",\"colour\":\"%s\"", basic);
}

static void put_count(FILE *to, const struct synth_unseen_phrase *p)
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

static void put_phrase(FILE *to, const struct synth_unseen *x, int phrase);

static void put_phrases(FILE *to, const struct synth_unseen *x, const char *key, const int *phrases, int n)
{
	fprintf(to, ",\"%s\":[", key);
	for (int i = 0; i < n; i++) {
		fputs(i ? "," : "", to);
		put_phrase(to, x, phrases[i]);
	}
	fputc(']', to);
}

static void put_clause(FILE *to, const struct synth_unseen *x, const struct synth_unseen_clause *c)
{
	static const char *const degrees[] = {"plain", "more", "most"};

	fprintf(to, "{\"relation\":\"%s\",\"negated\":%s", relation_names[c->relation],
		c->negated ? "true" : "false");
	if (c->relation == PARSE_ON || c->relation == PARSE_SUPPORTS)
		fputs(",\"contact\":true", to);
	if (c->degree != PARSE_PLAIN)
		fprintf(to, ",\"degree\":\"%s\"", degrees[c->degree]);
	put_phrases(to, x, "anchors", c->anchors, c->anchor_count);
	if (c->word_count)
		put_strings(to, "words", c->words, c->word_count);
	fputc('}', to);
}

/* What hangs on a phrase. The target's stands beside "target", another's within it. */
static void put_rest(FILE *to, const struct synth_unseen *x, const struct synth_unseen_phrase *p)
{
	fputs(",\"clauses\":[", to);
	if (p->size)
		fprintf(to, "{\"relation\":\"%s\",\"negated\":false,\"anchors\":[],\"words\":[\"%s\"]}",
			p->sense.sizes >> SYNTH_BIG & 1 ? "larger" : "smaller", p->size);
	for (int i = 0; i < p->clause_count; i++) {
		fputs(i || p->size ? "," : "", to);
		put_clause(to, x, &x->clauses[p->clauses[i]]);
	}
	fputc(']', to);
	if (p->of_several)
		fputs(",\"group\":\"several\"", to);
	if (p->group)
		fprintf(to, ",\"group\":%d", p->group);
	if (p->ordinal)
		fprintf(to, ",\"ordinal\":{\"k\":%d,\"from\":\"%s\"}", p->ordinal, relation_names[p->from]);
	if (p->except_count)
		put_phrases(to, x, "except", p->except, p->except_count);
	if (p->also_count)
		put_phrases(to, x, "also", p->also, p->also_count);
}

/* "One" goes by the target's noun, but for "nothing", which goes by none. */
static void put_phrase(FILE *to, const struct synth_unseen *x, int phrase)
{
	const struct synth_unseen_phrase *p = &x->phrases[phrase];

	fprintf(to, "{\"noun\":\"%s\"", *p->noun || p->is_anything ? p->noun : x->phrases[0].noun);
	put_attributes(to, p);
	put_count(to, p);
	if (p->viewer)
		fputs(",\"viewer\":true", to);
	put_rest(to, x, p);
	fputc('}', to);
}

static void put_parse(FILE *to, const struct synth_unseen *x)
{
	const struct synth_unseen_phrase *p = &x->phrases[0];

	fprintf(to, "{\"ref\":\"%s\",\"text\":\"%s\",\"target\":{\"noun\":\"%s\"", x->ref, x->text, p->noun);
	put_attributes(to, p);
	fputc('}', to);
	put_count(to, p);
	put_rest(to, x, p);
	fputs("}\n", to);
}

static void put_sentence(FILE *to, const struct synth_unseen *x, const struct synth_object *objects,
	const struct cameras *cameras)
{
	const char *names[SYNTH_MAX_OBJECTS];
	int n = 0;

	for (int i = 0; i < SYNTH_MAX_OBJECTS; i++)
		if (x->objects >> i & 1)
			names[n++] = objects[i].name;
	fprintf(to, "{\"ref\":\"%s\"", x->ref);
	if (n == 1)
		fprintf(to, ",\"object\":\"%s\"", names[0]);
	put_strings(to, "objects", names, n);
	fprintf(to, ",\"text\":\"%s\",\"split\":\"test\",\"kind\":\"%s\"", x->text,
		synth_unseen_kind_name(x->kind));
	if (x->view >= 0)
		fprintf(to, ",\"view\":\"%s\"", cameras->views[x->view].name);
	fputs("}\n", to);
}

static int open_in(struct file_out *out, const char *dir, const char *name, struct err *e)
{
	char *path = file_join(dir, name, "", e);
	int bad = !path || file_out_open(out, path, e) ? -1 : 0;

	free(path);
	return bad;
}

int synth_unseen_files(const char *dir, const struct synth_unseen_list *list,
	const struct synth_object *objects, const struct cameras *cameras, struct err *e)
{
	struct file_out sentences = {0}, parses = {0};

	if (open_in(&sentences, dir, "unseen.jsonl", e))
		return -1;
	for (int i = 0; i < list->n; i++)
		put_sentence(sentences.stream, &list->items[i], objects, cameras);
	if (file_out_commit(&sentences, e) || open_in(&parses, dir, "parses.unseen.jsonl", e))
		return -1;
	for (int i = 0; i < list->n; i++)
		put_parse(parses.stream, &list->items[i]);
	return file_out_commit(&parses, e);
}
