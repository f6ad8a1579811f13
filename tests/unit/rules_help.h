/* Analyses that were made wrong by hand, and what they become by the rules (lang/rules.def). Checks are
 * counted by the test that includes this. */
#ifndef RULES_HELP_H
#define RULES_HELP_H

#include "lang/analysis.h"
#include "unit.h"

/* An analysis of a text: for each word '.' nothing, N name, T target, A anchor, L also, a attribute, P
 * predicate, E left out, M one that is chosen from; the digit after A, a and P is the word that it hangs on,
 * none for ROOT. All predicates are of the relation.
 */
static inline struct analysis made(const struct tokens *t, const char *roles, enum parse_relation relation)
{
	static const char letters[] = ".TALaPEMN";
	static const enum word_role role[] = {ROLE_NONE, ROLE_TARGET, ROLE_ANCHOR, ROLE_ALSO, ROLE_ATTRIBUTE,
		ROLE_PREDICATE, ROLE_EXCEPT, ROLE_MEMBER, ROLE_NAME};
	struct analysis a = {.n = t->n};
	int i = 0;

	for (const char *p = roles; *p && i < t->n; i++) {
		a.word[i].role = role[strchr(letters, *p++) - letters];
		a.word[i].head = *p >= '0' && *p <= '9' ? *p++ - '0' : ROOT;
		a.word[i].relation = a.word[i].role == ROLE_PREDICATE ? relation : (enum parse_relation)0;
		while (*p == ' ')
			p++;
	}
	CHECK(i == t->n, "%d roles for %d words", i, t->n);
	return a;
}

/* That analysis after the rules. */
static inline struct analysis ruled(const char *text, const char *roles, enum parse_relation relation)
{
	struct tokens t;
	struct analysis a;

	tokens_take(&t, text, NULL, NULL, 0);
	a = made(&t, roles, relation);
	analysis_apply_rules(&a, &t, 0);
	return a;
}

/* A word's role and head are so then, and its relation where it is a predicate. */
static inline void rules_make(const char *text, const char *roles, enum parse_relation relation, int word,
	enum word_role role, int head, enum parse_relation now)
{
	const struct analysis a = ruled(text, roles, relation);

	CHECK(a.word[word].role == role && a.word[word].head == head, "'%s': word %d has role %d of %d", text,
		word, a.word[word].role, a.word[word].head);
	CHECK(role != ROLE_PREDICATE || a.word[word].relation == now, "'%s': relation %s", text,
		parse_relation_name(a.word[word].relation));
}

/* The parse that is built of it. */
static inline struct parse built(const char *text, const char *roles, enum parse_relation relation)
{
	struct tokens t;
	struct parse p;
	struct err e;

	tokens_take(&t, text, NULL, NULL, 0);
	const struct analysis a = made(&t, roles, relation);
	CHECK(!parse_build(&p, &a, &t, 0, &e), "'%s'", text);
	return p;
}

#endif
