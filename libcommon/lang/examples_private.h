/* A sentence in the making, for examples.c, and the phrases and clauses that it is made of
 * (examples_phrases.c). */
#ifndef LANG_EXAMPLES_PRIVATE_H
#define LANG_EXAMPLES_PRIVATE_H

#include "lang/examples.h"

#include <stddef.h>

enum { MADE_MOST = 160, MADE_LENGTH = 40, DEPTH_MOST = 2 };

/* A sentence in the making: words with what they are. */
struct making {
	const struct example_wordings *w;
	const struct example_list *nouns;
	struct rng *r;
	int n, depth, has_noun, noun, is_plural;
	int spoken_of[2], spoken; /* anchors that wait for their predicate: "see the box ? T near it" */
	struct made {
		char text[MADE_LENGTH];
		enum word_role role;
		int head, negated, begin;
		enum parse_relation relation;
	} word[MADE_MOST];
};

int making_chance(struct making *m, double p);
const char *making_pick(struct making *m, const struct example_list *list);

/* Words are appended; each returns the index of its last. Of "a|b|" one is taken; "_" parts words. */
int making_put(struct making *m, const char *text, size_t length);
int making_put_choice(struct making *m, const char *text, size_t length);
int making_put_any(struct making *m, const char *choices);
/* Words from to to-1 are `role` and hang on head, but for "of". */
void making_mark(struct making *m, int from, int to, enum word_role role, int head);
/* Whether the word before already is an article or the like. */
int making_follows_article(const struct making *m);

/* An adjective that places or sizes: its index is added to list. */
void making_put_before(struct making *m, int *list, int *count);
/* A noun with what stands before it, and at times its look after it. plain: without an article. Returns its
 * index. */
int making_noun_phrase(
	struct making *m, enum word_role role, int head, const char *noun, int is_plural, int plain);
/* What a thing is for or does, said of the word figure or ROOT. */
void making_function(struct making *m, int figure);
/* The same of any noun, with clauses of its own where it may. */
int making_anchor(struct making *m, enum word_role role, int may_nest);

enum { FORM_PLACED = 1, FORM_HAVING = 2, FORM_TURNED = 4, FORM_HAS = 8, FORM_WITH = 16 };

/* A clause of any of the forms (bits), said of the word figure or ROOT. */
void making_clause(struct making *m, int figure, int forms, int denied);
/* That clause; has: "has" in place of "with". */
void making_expand(struct making *m, const struct example_clause *c, int figure, int denied, int has);

#endif
