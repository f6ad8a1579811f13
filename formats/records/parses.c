#include "formats/records/parses.h"

#include "base/mem.h"
#include "formats/records/jsonl.h"
#include "lang/colours.h"

struct writer {
	const struct parse *p;
	const char *text;
};

static const char *const pairs_of_end[] = {"left", "right", "front", "behind", "above", "below"};

/* Characters before a byte of the text. */
static int characters(const char *text, int byte)
{
	int n = 0;

	for (int i = 0; i < byte; i++)
		n += ((unsigned char)text[i] & 0xC0) != 0x80;
	return n;
}

static void add_span(const struct writer *w, cJSON *o, struct parse_span s)
{
	if (s.begin == s.end)
		return;
	int ends[2] = {characters(w->text, s.begin), characters(w->text, s.end)};
	cJSON_AddItemToObject(o, "span", cJSON_CreateIntArray(ends, 2));
}

static void add_noun(const struct writer *w, cJSON *o, const struct parse_list *noun)
{
	size_t length = 1;
	struct err e;

	for (int i = 0; i < noun->n; i++)
		length += strlen(w->p->words[noun->item[i]].text) + 1;
	SCOPED char *text = mem_zalloc(length, 1, "parses", &e);
	if (!text)
		return;
	for (int i = 0, at = 0; i < noun->n; i++)
		at += snprintf(text + at, length - (size_t)at, "%s%s", i ? " " : "",
			w->p->words[noun->item[i]].text);
	cJSON_AddStringToObject(o, "noun", text);
}

static void add_words(const struct writer *w, cJSON *o, const char *key, const struct parse_list *list)
{
	cJSON *array;

	if (!list->n)
		return;
	array = cJSON_AddArrayToObject(o, key);
	for (int i = 0; i < list->n; i++)
		cJSON_AddItemToArray(array, cJSON_CreateString(w->p->words[list->item[i]].text));
}

static void add_number(cJSON *o, const char *key, int n)
{
	if (n == PARSE_ALL)
		cJSON_AddStringToObject(o, key, "all");
	else if (n == PARSE_SEVERAL)
		cJSON_AddStringToObject(o, key, "several");
	else if (n == PARSE_ONE)
		cJSON_AddStringToObject(o, key, "one");
	else
		cJSON_AddNumberToObject(o, key, n);
}

static cJSON *phrase(const struct writer *w, int which);

static void add_phrases(const struct writer *w, cJSON *o, const char *key, const struct parse_list *list)
{
	cJSON *array;

	if (!list->n)
		return;
	array = cJSON_AddArrayToObject(o, key);
	for (int i = 0; i < list->n; i++)
		cJSON_AddItemToArray(array, phrase(w, list->item[i]));
}

/* Contact is a key of its own, so that "on" is one kind of "above" and "supports" one of "below". */
static void add_relation(cJSON *o, enum parse_relation r)
{
	enum parse_relation plain = r == PARSE_ON ? PARSE_ABOVE : r == PARSE_SUPPORTS ? PARSE_BELOW : r;

	cJSON_AddStringToObject(o, "relation", parse_relation_name(plain));
	if (plain != r)
		cJSON_AddTrueToObject(o, "contact");
}

/* "between the two beds" has two anchors, though one phrase names them. */
static void add_anchors(const struct writer *w, cJSON *o, const struct parse_clause *c)
{
	struct parse_list twice = {2, (int[]){0, 0}};

	if (c->relation != PARSE_BETWEEN || c->anchors.n != 1 ||
		w->p->phrases[c->anchors.item[0]].count == PARSE_ONE) {
		add_phrases(w, o, "anchors", &c->anchors);
		return;
	}
	twice.item[0] = twice.item[1] = c->anchors.item[0];
	add_phrases(w, o, "anchors", &twice);
}

static cJSON *clause(const struct writer *w, const struct parse_clause *c)
{
	cJSON *o = cJSON_CreateObject();

	add_relation(o, c->relation);
	if (c->degree != PARSE_PLAIN)
		cJSON_AddStringToObject(o, "degree", c->degree == PARSE_MORE ? "more" : "most");
	if (c->negated)
		cJSON_AddTrueToObject(o, "negated");
	add_words(w, o, "words", &c->words);
	add_anchors(w, o, c);
	add_span(w, o, c->span);
	return o;
}

/* Where one looks from is a clause too, of no relation between things: it has an anchor. */
static cJSON *view(const struct writer *w)
{
	cJSON *o = cJSON_CreateObject(), *anchors;

	cJSON_AddStringToObject(o, "relation", "viewpoint");
	cJSON_AddStringToObject(o, "view", w->p->view == PARSE_VIEW_FROM ? "from" : "facing");
	anchors = cJSON_AddArrayToObject(o, "anchors");
	cJSON_AddItemToArray(anchors, phrase(w, w->p->view_phrase));
	return o;
}

static void add_clauses(const struct writer *w, cJSON *o, int which)
{
	const struct parse_list *list = &w->p->phrases[which].clauses;
	int has_view = !which && w->p->view != PARSE_VIEW_NONE && w->p->view_phrase >= 0;
	cJSON *array;

	if (!list->n && !has_view)
		return;
	array = cJSON_AddArrayToObject(o, "clauses");
	for (int i = 0; i < list->n; i++)
		cJSON_AddItemToArray(array, clause(w, &w->p->clauses[list->item[i]]));
	if (has_view)
		cJSON_AddItemToArray(array, view(w));
}

static void add_ordinal(cJSON *o, const struct parse_phrase *f)
{
	cJSON *ordinal;

	if (!f->ordinal)
		return;
	ordinal = cJSON_AddObjectToObject(o, "ordinal");
	cJSON_AddNumberToObject(ordinal, "k", f->ordinal);
	if (f->from <= PARSE_BELOW)
		cJSON_AddStringToObject(ordinal, "from", pairs_of_end[f->from]);
}

/* What stands in the target's object, and at an anchor beside its clauses. */
static void add_description(const struct writer *w, cJSON *o, const struct parse_phrase *f)
{
	add_noun(w, o, &f->noun);
	add_words(w, o, "words", &f->attributes);
	for (int i = 0; i < f->attributes.n; i++)
		if (colour_word(w->p->words[f->attributes.item[i]].lemma) >= 0) {
			cJSON_AddStringToObject(o, "colour", w->p->words[f->attributes.item[i]].lemma);
			break;
		}
	if (f->viewer)
		cJSON_AddTrueToObject(o, "viewer");
	if (f->scene)
		cJSON_AddTrueToObject(o, "scene");
	add_span(w, o, f->span);
}

static void add_sets(const struct writer *w, cJSON *o, const struct parse_phrase *f)
{
	add_number(o, "count", f->count);
	if (f->group)
		add_number(o, "group", f->group);
	add_ordinal(o, f);
	add_phrases(w, o, "among", &f->among);
	add_phrases(w, o, "except", &f->except);
	add_phrases(w, o, "also", &f->also);
}

static cJSON *phrase(const struct writer *w, int which)
{
	const struct parse_phrase *f = &w->p->phrases[which];
	cJSON *o = cJSON_CreateObject();

	add_description(w, o, f);
	add_sets(w, o, f);
	add_clauses(w, o, which);
	return o;
}

int parses_put(FILE *out, const char *ref, const char *text, const struct parse *p, struct err *e)
{
	struct writer w = {p, text};
	cJSON *o = cJSON_CreateObject(), *target;
	char *line;

	cJSON_AddStringToObject(o, "ref", ref);
	cJSON_AddStringToObject(o, "text", text);
	target = cJSON_AddObjectToObject(o, "target");
	add_description(&w, target, &p->phrases[0]);
	add_sets(&w, o, &p->phrases[0]);
	add_clauses(&w, o, 0);
	add_words(&w, o, "unexplained", &p->unexplained);
	cJSON_AddNumberToObject(o, "confidence", (int)(p->confidence * 1000 + 0.5) / 1000.0);
	line = cJSON_PrintUnformatted(o);
	cJSON_Delete(o);
	if (!line)
		return err_set(e, ERR_SYSTEM, "parse: out of memory");
	fprintf(out, "%s\n", line);
	cJSON_free(line);
	return 0;
}

static void release(void *record)
{
	free(((struct parse_relations *)record)->ref);
}

void parses_free(struct parses *p)
{
	for (size_t i = 0; i < p->n; i++)
		release(&p->items[i]);
	free(p->items);
	*p = (struct parses){0};
}

/* The relations of a value and of all in it; what add_relation writes, read back. */
static unsigned relations_in(const cJSON *value)
{
	const cJSON *name = cJSON_GetObjectItemCaseSensitive(value, "relation"), *item;
	const int contact = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(value, "contact"));
	int r = cJSON_IsString(name) ? parse_relation_find(name->valuestring) : -1;
	unsigned set = 0;

	if (contact)
		r = r == PARSE_ABOVE ? PARSE_ON : r == PARSE_BELOW ? PARSE_SUPPORTS : r;
	if (r >= 0)
		set = 1U << r;
	cJSON_ArrayForEach(item, value) set |= relations_in(item);
	return set;
}

static int read_one(const struct jsonl *j, const cJSON *object, void *record, struct err *e)
{
	struct parse_relations *p = record;

	if (jsonl_name(j, object, "ref", NAME_DATA, 1, &p->ref, e))
		return -1;
	if (!cJSON_IsObject(cJSON_GetObjectItemCaseSensitive(object, "target")))
		return jsonl_err(j, e, "key 'target' is missing: text-parse writes such records");
	p->set = relations_in(object);
	return 0;
}

int parses_read(struct parses *p, const char *path, struct err *e)
{
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	SCOPED long *lines = NULL;
	const size_t size = sizeof *p->items, ref = offsetof(struct parse_relations, ref);

	*p = (struct parses){0};
	return -(jsonl_open(&j, path, e) ||
		 jsonl_records(&j, size, read_one, release, (void **)&p->items, &p->n, &lines, e) ||
		 jsonl_check_refs(&j, p->items, size, ref, p->n, lines, e));
}
