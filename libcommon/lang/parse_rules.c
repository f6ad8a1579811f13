/* What a parse still has wrong once it is built, and its own words tell: lang/rules.def. */
#include "lang/analysis.h"
#include "lang/closed.h"
#include "lang/kinds.h"
#include "lang/rules.h"

/* "the first two hooks" are two, but "of my two coats the second" is one of two. */
static void take_one_of(const struct parse *p, struct parse_phrase *f)
{
	if (!f->ordinal || f->count == PARSE_ONE)
		return;
	for (int w = 0; w + 1 < p->word_count; w++)
		if (closed_class_of(p, w) == CLOSED_ORDINAL && closed_class_of(p, w + 1) == CLOSED_NUMBER)
			return;
	f->group = f->group ? f->group : f->count;
	f->count = PARSE_ONE;
}

/* A jar of tea is a jar: what fills it only says which. */
static void take_content(const struct parse *p, struct parse_phrase *f)
{
	const int content = f->noun.n ? f->noun.item[f->noun.n - 1] : 0;

	for (int k = 0; k < f->attributes.n && parse_word_is(p, content - 1, "of"); k++) {
		int *const word = &f->attributes.item[k];
		if (*word == content - 2 && kinds_listed("holder", p->words[*word].lemma)) {
			f->noun.item[f->noun.n - 1] = *word;
			*word = content;
			return;
		}
	}
}

int parse_apply_rules(struct parse *p, unsigned without, struct err *e)
{
	for (int i = 0; i < p->phrase_count && rule_counts(without, RULE_content); i++)
		take_content(p, &p->phrases[i]);
	if (rule_counts(without, RULE_one_of))
		take_one_of(p, &p->phrases[0]);
	return (rule_counts(without, RULE_shared) && parse_shared(p, e)) ||
			       (rule_counts(without, RULE_members) && parse_members(p, e)) ||
			       (rule_counts(without, RULE_companion) && parse_companion(p, e))
		       ? -1
		       : 0;
}
