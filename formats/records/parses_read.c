/* Reads parses.jsonl: those of text-parse, and those that a person wrote or corrected. */
#include "formats/records/parses.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/records/jsonl.h"
#include "lang/tokens.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 128 }; /* clauses within clauses */

struct reader {
	const struct jsonl *j;
	struct parse *p;
	const char *text;
	size_t words, phrases, clauses; /* capacities */
	int depth;
	struct err *e;
};

static const cJSON *member(const cJSON *o, const char *key)
{
	const cJSON *item = cJSON_GetObjectItemCaseSensitive(o, key);

	return item && !cJSON_IsNull(item) ? item : NULL;
}

static int bad(struct reader *r, const char *key, const char *what)
{
	return jsonl_err(r->j, r->e, "key '%s' is not %s", key, what);
}

static int add_word(struct reader *r, const char *text, size_t length, struct parse_span span)
{
	struct parse *p = r->p;
	char word[TOKEN_LENGTH], lemma[TOKEN_LENGTH];
	struct parse_word *w;

	if (mem_grow((void **)&p->words, &r->words, (size_t)p->word_count + 1, sizeof *p->words, "words",
		    r->e))
		return -1;
	snprintf(word, sizeof word, "%.*s", (int)length, text);
	token_lemma(word, lemma);
	w = &p->words[p->word_count++];
	*w = (struct parse_word){
		.span = span, .text = mem_strdup(word, r->e), .lemma = mem_strdup(lemma, r->e)};
	return w->text && w->lemma ? p->word_count - 1 : -1;
}

static int add_text(struct reader *r)
{
	static _Thread_local struct tokens t;

	tokens_take(&t, r->text, NULL, NULL, 0);
	for (int i = 0; i < t.n; i++)
		if (add_word(r, t.word[i].text, strlen(t.word[i].text), t.word[i].span) < 0)
			return -1;
	return 0;
}

/* The word of the text within `span`, or anywhere; a new one where the text has none. */
static int find_word(struct reader *r, const char *text, size_t length, struct parse_span span)
{
	int found = -1;

	for (int i = 0; i < r->p->word_count; i++) {
		const struct parse_word *w = &r->p->words[i];
		if (strlen(w->text) != length || strncmp(w->text, text, length) != 0)
			continue;
		if (w->span.begin >= span.begin && w->span.end <= span.end)
			return i;
		if (found < 0)
			found = i;
	}
	return found >= 0 ? found : add_word(r, text, length, (struct parse_span){0});
}

static int take_words(struct reader *r, const char *words, struct parse_span span, struct parse_list *list)
{
	while (*words) {
		size_t length = strcspn(words, " ");
		if (length) {
			int word = find_word(r, words, length, span);
			if (word < 0 || parse_list_add(list, word, r->e))
				return -1;
		}
		words += length + (words[length] == ' ');
	}
	return 0;
}

/* Characters to bytes. */
static int read_span(struct reader *r, const cJSON *o, struct parse_span *span)
{
	const cJSON *item = member(o, "span");
	int ends[2], at = 0, n = 0, *to[2] = {&span->begin, &span->end};

	*span = (struct parse_span){0};
	if (!item)
		return 0;
	if (!cJSON_IsArray(item) || cJSON_GetArraySize(item) != 2)
		return bad(r, "span", "[begin,end]");
	for (int k = 0; k < 2; k++) {
		double v = cJSON_GetNumberValue(cJSON_GetArrayItem(item, k));
		if (!(v >= 0 && v <= 1e6) || v != floor(v))
			return bad(r, "span", "two character offsets of the text");
		ends[k] = (int)v;
	}
	if (ends[0] > ends[1])
		return bad(r, "span", "two rising character offsets");
	for (int k = 0; k < 2; k++) {
		while (n < ends[k] && r->text[at]) {
			at++;
			while (((unsigned char)r->text[at] & 0xC0) == 0x80)
				at++;
			n++;
		}
		if (n < ends[k])
			return bad(r, "span", "within the text");
		*to[k] = at;
	}
	return 0;
}

static int read_number(struct reader *r, const cJSON *o, const char *key, int *n)
{
	const cJSON *item = member(o, key);

	if (!item)
		return 0;
	if (cJSON_IsString(item)) {
		static const char *const names[] = {"one", "several", "all"};
		static const int values[] = {PARSE_ONE, PARSE_SEVERAL, PARSE_ALL};
		for (int k = 0; k < 3; k++)
			if (!strcmp(item->valuestring, names[k])) {
				*n = values[k];
				return 0;
			}
	}
	if (!cJSON_IsNumber(item) || item->valuedouble < 1 || item->valuedouble > 1e6 ||
		item->valuedouble != floor(item->valuedouble))
		return bad(r, key, "'one', 'several', 'all' or a whole number from 1");
	*n = (int)item->valuedouble;
	return 0;
}

static int read_ordinal(struct reader *r, const cJSON *o, struct parse_phrase *f)
{
	const cJSON *item = member(o, "ordinal"), *from = member(item, "from");
	double k = cJSON_GetNumberValue(member(item, "k"));

	if (!item)
		return 0;
	if (!cJSON_IsObject(item) || !(k != 0 && fabs(k) <= 1e6 && k == floor(k)))
		return bad(r, "ordinal", "an object with a whole number 'k' that is not 0");
	f->ordinal = (int)k;
	f->from = PARSE_OTHER;
	if (from) {
		int relation = cJSON_IsString(from) ? parse_relation_find(from->valuestring) : -1;
		if (relation < 0 || relation > PARSE_BELOW)
			return bad(r, "from", "'left', 'right', 'front', 'behind', 'above' or 'below'");
		f->from = (enum parse_relation)relation;
	}
	return 0;
}

static int read_list(
	struct reader *r, const cJSON *o, const char *key, struct parse_span span, struct parse_list *list)
{
	const cJSON *item = member(o, key), *word;

	if (item && !cJSON_IsArray(item))
		return bad(r, key, "a list of words");
	cJSON_ArrayForEach(word, item)
	{
		if (!cJSON_IsString(word))
			return bad(r, key, "a list of words");
		if (take_words(r, word->valuestring, span, list))
			return -1;
	}
	return 0;
}

static int read_phrase(struct reader *r, const cJSON *of, const cJSON *sets);

static int read_phrases(struct reader *r, const cJSON *o, const char *key, struct parse_list *list)
{
	const cJSON *item = member(o, key), *phrase;

	if (item && !cJSON_IsArray(item))
		return bad(r, key, "a list of phrases");
	cJSON_ArrayForEach(phrase, item)
	{
		int which = cJSON_IsObject(phrase) ? read_phrase(r, phrase, phrase)
						   : bad(r, key, "a list of phrases");
		if (which < 0 || parse_list_add(list, which, r->e))
			return -1;
	}
	return 0;
}

static int read_relation(struct reader *r, const cJSON *o, struct parse_clause *c)
{
	static const char *const degrees[] = {"", "more", "most"};
	const cJSON *name = member(o, "relation"), *degree = member(o, "degree");
	int relation = cJSON_IsString(name) ? parse_relation_find(name->valuestring) : -1;

	if (relation < 0)
		return bad(r, "relation", "the name of a relation");
	if (cJSON_IsTrue(member(o, "contact")))
		relation = relation == PARSE_ABOVE   ? PARSE_ON
			   : relation == PARSE_BELOW ? PARSE_SUPPORTS
						     : relation;
	c->relation = (enum parse_relation)relation;
	c->negated = cJSON_IsTrue(member(o, "negated"));
	for (int k = PARSE_MORE; degree && k <= PARSE_MOST; k++)
		if (cJSON_IsString(degree) && !strcmp(degree->valuestring, degrees[k]))
			c->degree = (enum parse_degree)k;
	return degree && c->degree == PARSE_PLAIN ? bad(r, "degree", "'more' or 'most'") : 0;
}

static int read_view(struct reader *r, const cJSON *o)
{
	const cJSON *view = member(o, "view");
	struct parse_list list = {0};
	int failed;

	if (!cJSON_IsString(view) ||
		(strcmp(view->valuestring, "from") != 0 && strcmp(view->valuestring, "facing") != 0))
		return bad(r, "view", "'from' or 'facing'");
	r->p->view = strcmp(view->valuestring, "from") ? PARSE_VIEW_FACING : PARSE_VIEW_FROM;
	failed = read_phrases(r, o, "anchors", &list);
	if (!failed)
		r->p->view_phrase = list.n ? list.item[0] : -1;
	free(list.item);
	return failed;
}

static int read_clause(struct reader *r, const cJSON *o, int figure)
{
	const cJSON *name = member(o, "relation");
	struct parse_clause c = {0};
	int at;

	if (!cJSON_IsObject(o))
		return bad(r, "clauses", "a list of objects");
	if (cJSON_IsString(name) && !strcmp(name->valuestring, "viewpoint") && !figure)
		return read_view(r, o);
	if (++r->depth > DEEPEST)
		return jsonl_err(r->j, r->e, "key 'clauses' is more than %d deep", DEEPEST);
	if (read_relation(r, o, &c) || read_span(r, o, &c.span) ||
		mem_grow((void **)&r->p->clauses, &r->clauses, (size_t)r->p->clause_count + 1, sizeof c,
			"clauses", r->e))
		return -1;
	at = r->p->clause_count++;
	r->p->clauses[at] = c;
	if (parse_list_add(&r->p->phrases[figure].clauses, at, r->e))
		return -1;
	/* the array may move while anchors are read */
	int failed = read_list(r, o, "words", c.span, &c.words) || read_phrases(r, o, "anchors", &c.anchors);
	r->p->clauses[at] = c;
	r->depth--;
	return failed ? -1 : 0;
}

/* A phrase; what the target has at the record itself is in `sets`. Returns its index. */
static int read_phrase(struct reader *r, const cJSON *of, const cJSON *sets)
{
	const cJSON *noun = member(of, "noun"), *clauses = member(sets, "clauses"), *c;
	struct parse_phrase f = {.count = PARSE_ONE, .from = PARSE_OTHER};
	int at = r->p->phrase_count, failed;

	if (noun && !cJSON_IsString(noun))
		return bad(r, "noun", "a string");
	if (clauses && !cJSON_IsArray(clauses))
		return bad(r, "clauses", "a list of objects");
	if (read_span(r, of, &f.span) || read_number(r, sets, "count", &f.count) ||
		read_number(r, sets, "group", &f.group) || read_ordinal(r, sets, &f) ||
		mem_grow((void **)&r->p->phrases, &r->phrases, (size_t)at + 1, sizeof f, "phrases", r->e))
		return -1;
	f.viewer = cJSON_IsTrue(member(of, "viewer"));
	f.scene = cJSON_IsTrue(member(of, "scene"));
	r->p->phrases[at] = f;
	r->p->phrase_count++;
	failed = (noun && take_words(r, noun->valuestring, f.span, &r->p->phrases[at].noun)) ||
		 read_list(r, of, "words", f.span, &r->p->phrases[at].attributes);
	cJSON_ArrayForEach(c, clauses) if (!failed) failed = read_clause(r, c, at);
	static const char *const keys[] = {"among", "except", "also"};
	for (int k = 0; k < 3 && !failed; k++) {
		/* the array may move while phrases are read */
		struct parse_list list = {0};
		failed = read_phrases(r, sets, keys[k], &list);
		struct parse_phrase *to = &r->p->phrases[at];
		*(k == 0 ? &to->among : k == 1 ? &to->except : &to->also) = list;
	}
	return failed ? -1 : at;
}

static int read_record(const struct jsonl *j, const cJSON *o, struct parse_record *record, struct err *e)
{
	struct reader r = {.j = j, .p = &record->parse, .e = e};
	const cJSON *target = member(o, "target");
	const char *text = NULL;

	r.p->view_phrase = -1;
	if (jsonl_name(j, o, "ref", NAME_DATA, 1, &record->ref, e) ||
		jsonl_string(j, o, "text", 0, &text, e) < 0 ||
		jsonl_number(j, o, "confidence", &r.p->confidence, e))
		return -1;
	record->text = mem_strdup(text ? text : "", e);
	if (!record->text)
		return -1;
	if (isnan(r.p->confidence))
		r.p->confidence = 1;
	r.text = record->text;
	if (!cJSON_IsObject(target))
		return bad(&r, "target", "an object");
	if (add_text(&r) || read_phrase(&r, target, o) < 0)
		return -1;
	return read_list(&r, o, "unexplained", (struct parse_span){0}, &r.p->unexplained);
}

static int by_ref(const void *a, const void *b)
{
	const struct parse_record *const *x = a, *const *y = b;

	return strcmp((*x)->ref, (*y)->ref);
}

static int check_unique(const struct parse_set *s, const char *path, struct err *e)
{
	const struct parse_record **sorted = mem_alloc(s->n, sizeof *sorted, path, e);
	int failed = !sorted;

	for (size_t i = 0; sorted && i < s->n; i++)
		sorted[i] = &s->records[i];
	if (sorted && s->n)
		qsort(sorted, s->n, sizeof *sorted, by_ref);
	for (size_t i = 1; sorted && i < s->n && !failed; i++)
		if (!strcmp(sorted[i - 1]->ref, sorted[i]->ref))
			failed = err_set(e, ERR_FORMAT, "%s: ref '%s' appears twice", path, sorted[i]->ref);
	free(sorted);
	return failed ? -1 : 0;
}

int parses_read(struct parse_set *s, const char *path, struct err *e)
{
	struct jsonl j;
	size_t capacity = 0;
	cJSON *o;
	int got;

	*s = (struct parse_set){0};
	if (jsonl_open(&j, path, e))
		return -1;
	while ((got = jsonl_next(&j, &o, e)) > 0) {
		struct parse_record r = {0};
		int failed = read_record(&j, o, &r, e) ||
			     mem_grow((void **)&s->records, &capacity, s->n + 1, sizeof r, j.path, e);
		cJSON_Delete(o);
		if (failed) {
			free(r.ref);
			free(r.text);
			parse_free(&r.parse);
			got = -1;
			break;
		}
		s->records[s->n++] = r;
	}
	if (!got)
		got = check_unique(s, file_name(path), e);
	jsonl_close(&j);
	if (got)
		parses_free(s);
	return got;
}

void parses_free(struct parse_set *s)
{
	for (size_t i = 0; i < s->n; i++) {
		free(s->records[i].ref);
		free(s->records[i].text);
		parse_free(&s->records[i].parse);
	}
	free(s->records);
	*s = (struct parse_set){0};
}

const struct parse_record *parses_find(const struct parse_set *s, const char *ref)
{
	for (size_t i = 0; i < s->n; i++)
		if (!strcmp(s->records[i].ref, ref))
			return &s->records[i];
	return NULL;
}
