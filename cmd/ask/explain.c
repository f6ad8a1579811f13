/* A candidate's parts are those of the target that were judged, each with what it gave. */
#include "cmd/ask/explain.h"

#include "base/jsontext.h"
#include "base/largest.h"
#include "lang/motion_said.h"

#include <math.h>
#include <stdlib.h>

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
	case MEANING_MOTION:
		parse_words_add(w, motion_kind_name((enum motion_kind)part->index));
		break;
	case MEANING_EXCEPT:
		parse_words_phrase(w, p, text, part->index);
		break;
	case MEANING_AMONG:
		if (!p->phrases[part->phrase].among.n)
			parse_words_add(w, "of those");
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

static double rounded(double x)
{
	return round(x * 1e4) / 1e4;
}

/* The words of a part, and what kind it is. */
static const char *part_words(
	char words[EXPLAIN_REASON], const struct explained *x, const struct meaning_part *part)
{
	static const char *const kinds[MEANING_KINDS] = {[MEANING_NOUN] = "noun",
		[MEANING_ATTRIBUTE] = "attribute",
		[MEANING_COLOUR] = "colour",
		[MEANING_SURFACE] = "surface",
		[MEANING_CLAUSE] = "clause",
		[MEANING_SIZE] = "size",
		[MEANING_EXCEPT] = "except",
		[MEANING_AMONG] = "among",
		[MEANING_ORDINAL] = "ordinal",
		[MEANING_MOTION] = "motion"};
	struct parse_words w = {words, 0, EXPLAIN_REASON};

	*words = 0;
	add_part(&w, x, part);
	return kinds[part->kind];
}

/* The objects that fit best: shown gets so many. */
static size_t find_candidates(const struct meaning *m, size_t shown[EXPLAIN_MOST])
{
	const size_t n = m->arrangement->n;
	size_t count = 0;

	for (; count < EXPLAIN_MOST && count < n; count++) {
		size_t next = n;
		for (size_t o = 0; o < n; o++) {
			size_t k = 0;
			while (k < count && shown[k] != o)
				k++;
			if (k == count && (next == n || m->fit[o] > m->fit[next]))
				next = o;
		}
		shown[count] = next;
	}
	return count;
}

/* The next phrase that is neither the target nor who looks, its words, and the object that fits it best. Its
 * number, or -1. */
static int next_anchor(const struct explained *x, int phrase, char words[EXPLAIN_REASON], size_t *best)
{
	const struct meaning *m = x->meaning;
	const struct parse *p = x->parse;
	struct parse_words w = {words, 0, EXPLAIN_REASON};

	for (phrase++; phrase < p->phrase_count; phrase++) {
		if (!m->done[phrase] || p->phrases[phrase].viewer || p->phrases[phrase].scene)
			continue;
		*best = best_of(m->fit + (size_t)phrase * (m->arrangement->n + 1), m->arrangement->n);
		*words = 0;
		parse_words_phrase(&w, p, x->text, phrase);
		return phrase;
	}
	return -1;
}

static void put_json(FILE *out, const struct explained *x, const char *parse)
{
	const struct meaning *m = x->meaning;
	char *const *names = m->vocabulary->lifted->names;
	const struct parse_list *unexplained = &x->parse->unexplained;
	struct jsontext to = {.out = out};
	char words[EXPLAIN_REASON];
	size_t shown[EXPLAIN_MOST], best;
	const size_t count = find_candidates(m, shown);

	jsontext_open(&to, NULL, '{');
	jsontext_string(&to, "parse", parse);
	jsontext_rounded(&to, "confidence", x->parse->confidence);
	jsontext_open(&to, "unexplained", '[');
	for (int k = 0; k < unexplained->n; k++)
		jsontext_string(&to, NULL, x->parse->words[unexplained->item[k]].text);
	jsontext_close(&to, ']');
	jsontext_open(&to, "candidates", '[');
	for (size_t i = 0; i < count; i++) {
		jsontext_open(&to, NULL, '{');
		jsontext_string(&to, "name", names[shown[i]]);
		jsontext_rounded(&to, "fit", m->fit[shown[i]]);
		jsontext_open(&to, "parts", '[');
		for (size_t k = 0; k < m->part_count; k++) {
			if (m->parts[k].phrase)
				continue;
			jsontext_open(&to, NULL, '{');
			jsontext_string(&to, "part", part_words(words, x, &m->parts[k]));
			if (*words)
				jsontext_string(&to, "words", words);
			jsontext_rounded(&to, "value", m->parts[k].value[shown[i]]);
			jsontext_close(&to, '}');
		}
		jsontext_close(&to, ']');
		jsontext_close(&to, '}');
	}
	jsontext_close(&to, ']');
	jsontext_open(&to, "anchors", '[');
	for (int a = 0; (a = next_anchor(x, a, words, &best)) > 0;) {
		jsontext_open(&to, NULL, '{');
		jsontext_string(&to, "words", words);
		jsontext_string(&to, "name", names[best]);
		jsontext_rounded(&to, "there", m->there[(size_t)a * m->arrangement->n + best]);
		jsontext_close(&to, '}');
	}
	jsontext_close(&to, ']');
	jsontext_close(&to, '}');
}

static void put_lines(FILE *out, const struct explained *x, const char *parse)
{
	const struct meaning *m = x->meaning;
	char *const *names = m->vocabulary->lifted->names;
	const struct parse_list *unexplained = &x->parse->unexplained;
	char words[EXPLAIN_REASON];
	size_t shown[EXPLAIN_MOST], best;
	const size_t count = find_candidates(m, shown);

	fprintf(out, "  parse (%.2f): %s\n", rounded(x->parse->confidence), parse);
	for (int k = 0; k < unexplained->n; k++)
		fprintf(out, "%s %s%s",
			k ? "," : "  not understood:", x->parse->words[unexplained->item[k]].text,
			k + 1 < unexplained->n ? "" : "\n");
	for (int a = 0; (a = next_anchor(x, a, words, &best)) > 0;)
		fprintf(out, "  '%s' is %s (%.2f)\n", words, names[best],
			rounded(m->there[(size_t)a * m->arrangement->n + best]));
	for (size_t i = 0; i < count; i++) {
		const char *before = ":";
		fprintf(out, "  fit %.3f %s", rounded(m->fit[shown[i]]), names[shown[i]]);
		for (size_t k = 0; k < m->part_count; k++) {
			if (m->parts[k].phrase)
				continue;
			const char *kind = part_words(words, x, &m->parts[k]);
			fprintf(out, "%s %s%s%s %.2f", before, kind, *words ? " " : "", words,
				rounded(m->parts[k].value[shown[i]]));
			before = ";";
		}
		fputc('\n', out);
	}
}

char *explain_meaning(const struct explained *x, int is_json)
{
	char parse[4 * EXPLAIN_REASON] = "", *text = NULL;
	struct parse_words w = {parse, 0, sizeof parse};
	size_t length;
	FILE *out = open_memstream(&text, &length);

	if (!out)
		return NULL;
	parse_words_tree(&w, x->parse, x->text, 0, 0);
	(is_json ? put_json : put_lines)(out, x, parse);
	if (!fclose(out))
		return text;
	free(text);
	return NULL;
}
