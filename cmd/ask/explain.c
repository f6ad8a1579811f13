/* A candidate's parts are those of the target that were judged, each with what it gave. */
#include "cmd/ask/explain.h"

#include "base/largest.h"

#include <math.h>
#include <string.h>

/* The words of a part of the sentence. */
static void add_part(struct parse_words *w, const struct explained *x, const struct meaning_part *part)
{
	const char *text = x->text;
	const struct parse *p = x->parse;

	switch (part->kind) {
	case MEANING_NOUN:
		if (p->phrases[part->phrase].noun.n)
			parse_words_noun(w, p, part->phrase);
		else /* of "the other one": what was spoken of before */
			parse_words_add(w, p->words[part->index].text);
		break;
	case MEANING_ATTRIBUTE:
	case MEANING_COLOUR:
	case MEANING_SURFACE:
		parse_words_add(w, p->words[part->index].text);
		break;
	case MEANING_CLAUSE:
	case MEANING_SIZE:
		parse_words_clause(w, p, text, &p->clauses[part->index]);
		break;
	case MEANING_EXCEPT:
		parse_words_phrase(w, p, text, part->index);
		break;
	case MEANING_AMONG:
		for (int k = 0; k < p->phrases[part->phrase].among.n; k++) {
			parse_words_add(w, k ? " or " : "");
			parse_words_phrase(w, p, text, p->phrases[part->phrase].among.item[k]);
		}
		break;
	default:
		break;
	}
}

/* The first anchor of a phrase, or of one of its anchors, that is not here; -1: none. */
static int absent_anchor(const struct explained *x, int phrase, int depth)
{
	const struct meaning *m = x->meaning;
	const struct parse *p = x->parse;
	const struct parse_phrase *f = &p->phrases[phrase];
	const size_t n = m->arrangement->n;

	for (int k = 0; k < f->clauses.n && depth < 4; k++) {
		const struct parse_clause *c = &p->clauses[f->clauses.item[k]];
		for (int j = 0; j < c->anchors.n; j++) {
			const int a = c->anchors.item[j];
			const double *there = m->there + (size_t)a * n;
			if (p->phrases[a].viewer || p->phrases[a].scene || c->relation == PARSE_OTHER ||
				c->relation == PARSE_WITH)
				continue;
			if (there[best_of(there, n)] < 0.5)
				return a;
			const int deeper = absent_anchor(x, a, depth + 1);
			if (deeper >= 0)
				return deeper;
		}
	}
	return -1;
}

/* The part of the target that speaks most against an object. */
static const struct meaning_part *worst_part(const struct meaning *m, size_t o)
{
	const struct meaning_part *worst = NULL;

	for (size_t k = 0; k < m->part_count; k++)
		if (!m->parts[k].phrase && (!worst || m->parts[k].value[o] < worst->value[o]))
			worst = &m->parts[k];
	return worst;
}

/* A part as the sentence says it: a clause with its anchors, where they follow it. */
static void add_said(struct parse_words *w, const struct explained *x, const struct meaning_part *part)
{
	const char *text = x->text;
	const struct parse *p = x->parse;
	const int is_clause = part->kind == MEANING_CLAUSE || part->kind == MEANING_SIZE;
	const struct parse_clause *c = is_clause ? &p->clauses[part->index] : NULL;
	int end = c ? c->span.end : 0;

	for (int k = 0; c && k < c->anchors.n; k++)
		if (p->phrases[c->anchors.item[k]].span.end > end)
			end = p->phrases[c->anchors.item[k]].span.end;
	if (c && c->span.begin < c->span.end)
		parse_words_bytes(w, text + c->span.begin, (size_t)(end - c->span.begin));
	else
		add_part(w, x, part);
}

void explain_refusal(const struct explained *x, char reason[EXPLAIN_REASON])
{
	const struct meaning *m = x->meaning;
	const char *text = x->text;
	const struct parse *p = x->parse;
	const int anchor = absent_anchor(x, 0, 0);
	const size_t best = best_of(m->fit, m->arrangement->n);
	const struct meaning_part *worst = worst_part(m, best);
	struct parse_words w = {reason, 0, EXPLAIN_REASON};

	*reason = 0;
	if (p->phrases[0].noun.n && m->known[0] < 0.5) {
		parse_words_add(&w, "nothing here is known as '");
		parse_words_noun(&w, p, 0);
		parse_words_add(&w, "'");
	} else if (anchor >= 0) {
		parse_words_add(&w, "there is no '");
		parse_words_phrase(&w, p, text, anchor);
		parse_words_add(&w, "' here to go by");
	} else if (worst && worst->value[best] < 0.5 && worst->kind != MEANING_ORDINAL) {
		parse_words_add(&w, m->vocabulary->lifted->names[best]);
		parse_words_add(&w, " comes nearest, but '");
		add_said(&w, x, worst);
		parse_words_add(&w, worst->kind == MEANING_EXCEPT ? "' leaves it out" : "' does not fit it");
	} else if (meaning_is_empty(m, 0)) {
		parse_words_add(&w, "it does not say which thing is meant");
	} else {
		parse_words_add(&w, m->vocabulary->lifted->names[best]);
		parse_words_add(&w, " comes nearest, but not near enough");
	}
}

static int add_number(cJSON *to, const char *key, double x)
{
	return cJSON_AddNumberToObject(to, key, round(x * 1e4) / 1e4) != NULL;
}

static int add_words_of(cJSON *to, const struct explained *x, const struct meaning_part *part)
{
	static const char *const kinds[MEANING_KINDS] = {[MEANING_NOUN] = "noun",
		[MEANING_ATTRIBUTE] = "attribute",
		[MEANING_COLOUR] = "colour",
		[MEANING_SURFACE] = "surface",
		[MEANING_CLAUSE] = "clause",
		[MEANING_SIZE] = "size",
		[MEANING_EXCEPT] = "except",
		[MEANING_AMONG] = "among",
		[MEANING_ORDINAL] = "ordinal"};
	char buffer[EXPLAIN_REASON] = "";
	struct parse_words w = {buffer, 0, sizeof buffer};

	add_part(&w, x, part);
	return cJSON_AddStringToObject(to, "part", kinds[part->kind]) &&
	       (!*buffer || cJSON_AddStringToObject(to, "words", buffer));
}

static int add_parts(cJSON *list, const struct explained *x, size_t o)
{
	const struct meaning *m = x->meaning;
	for (size_t k = 0; k < m->part_count; k++) {
		cJSON *one = m->parts[k].phrase ? NULL : cJSON_CreateObject();
		if (m->parts[k].phrase)
			continue;
		if (!cJSON_AddItemToArray(list, one) || !add_words_of(one, x, &m->parts[k]) ||
			!add_number(one, "value", m->parts[k].value[o]))
			return 0;
	}
	return 1;
}

static int add_candidates(cJSON *list, const struct explained *x)
{
	const struct meaning *m = x->meaning;
	const size_t n = m->arrangement->n;
	size_t shown[EXPLAIN_MOST], count = 0;

	while (count < EXPLAIN_MOST && count < n) {
		size_t next = n;
		for (size_t o = 0; o < n; o++) {
			size_t k = 0;
			while (k < count && shown[k] != o)
				k++;
			if (k == count && (next == n || m->fit[o] > m->fit[next]))
				next = o;
		}
		cJSON *one = cJSON_CreateObject();
		if (!cJSON_AddItemToArray(list, one) ||
			!cJSON_AddStringToObject(one, "name", m->vocabulary->lifted->names[next]) ||
			!add_number(one, "fit", m->fit[next]) ||
			!add_parts(cJSON_AddArrayToObject(one, "parts"), x, next))
			return 0;
		shown[count++] = next;
	}
	return 1;
}

/* Every phrase but the target and who looks: which object fits it best. */
static int add_anchors(cJSON *list, const struct explained *x)
{
	const struct meaning *m = x->meaning;
	const char *text = x->text;
	const struct parse *p = x->parse;
	const size_t n = m->arrangement->n;

	for (int a = 1; a < p->phrase_count; a++) {
		char buffer[EXPLAIN_REASON] = "";
		struct parse_words w = {buffer, 0, sizeof buffer};
		if (!m->done[a] || p->phrases[a].viewer || p->phrases[a].scene)
			continue;
		const size_t best = best_of(m->fit + (size_t)a * (n + 1), n);
		cJSON *one = cJSON_CreateObject();
		parse_words_phrase(&w, p, text, a);
		if (!cJSON_AddItemToArray(list, one) || !cJSON_AddStringToObject(one, "words", buffer) ||
			!cJSON_AddStringToObject(one, "name", m->vocabulary->lifted->names[best]) ||
			!add_number(one, "there", m->there[(size_t)a * n + best]))
			return 0;
	}
	return 1;
}

static int add_unexplained(cJSON *list, const struct parse *p)
{
	int fine = list != NULL;

	for (int k = 0; k < p->unexplained.n && fine; k++)
		fine = cJSON_AddItemToArray(list, cJSON_CreateString(p->words[p->unexplained.item[k]].text));
	return fine;
}

cJSON *explain_meaning(const struct explained *x)
{
	const char *text = x->text;
	const struct parse *p = x->parse;
	char buffer[4 * EXPLAIN_REASON] = "";
	struct parse_words w = {buffer, 0, sizeof buffer};
	cJSON *all = cJSON_CreateObject();

	parse_words_tree(&w, p, text, 0, 0);
	if (cJSON_AddStringToObject(all, "parse", buffer) && add_number(all, "confidence", p->confidence) &&
		add_unexplained(cJSON_AddArrayToObject(all, "unexplained"), p) &&
		add_candidates(cJSON_AddArrayToObject(all, "candidates"), x) &&
		add_anchors(cJSON_AddArrayToObject(all, "anchors"), x))
		return all;
	cJSON_Delete(all);
	return NULL;
}

static const char *string_of(const cJSON *object, const char *key)
{
	const char *value = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, key));

	return value ? value : "";
}

static double number_of(const cJSON *object, const char *key)
{
	return cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(object, key));
}

static void put_parts(const cJSON *parts, FILE *out)
{
	const cJSON *part;

	cJSON_ArrayForEach(part, parts)
	{
		const char *words = string_of(part, "words");
		fprintf(out, "%s %s%s%s %.2f", part == parts->child ? ":" : ";", string_of(part, "part"),
			*words ? " " : "", words, number_of(part, "value"));
	}
	fputc('\n', out);
}

void explain_put(const cJSON *explained, FILE *out)
{
	const cJSON *one, *list = cJSON_GetObjectItemCaseSensitive(explained, "unexplained");

	fprintf(out, "  parse (%.2f): %s\n", number_of(explained, "confidence"),
		string_of(explained, "parse"));
	cJSON_ArrayForEach(one, list) fprintf(out, "%s %s%s", one == list->child ? "  not understood:" : ",",
		cJSON_GetStringValue(one), one->next ? "" : "\n");
	cJSON_ArrayForEach(one, cJSON_GetObjectItemCaseSensitive(explained, "anchors"))
		fprintf(out, "  '%s' is %s (%.2f)\n", string_of(one, "words"), string_of(one, "name"),
			number_of(one, "there"));
	cJSON_ArrayForEach(one, cJSON_GetObjectItemCaseSensitive(explained, "candidates"))
	{
		fprintf(out, "  fit %.3f %s", number_of(one, "fit"), string_of(one, "name"));
		put_parts(cJSON_GetObjectItemCaseSensitive(one, "parts"), out);
	}
}
