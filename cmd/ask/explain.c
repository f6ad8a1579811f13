/* What a sentence was taken for, as JSON or as lines. A candidate's parts are those of the target that were
 * judged, each with what it gave. */
#include "cmd/ask/explain.h"

#include "base/jsontext.h"
#include "base/largest.h"
#include "lang/motion_said.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
	explain_add_part(&w, x, part);
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
