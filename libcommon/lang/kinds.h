/* Everyday nouns by which people call things of one kind or one shape, which WordNet, a hierarchy of senses,
 * does not have near one another: a block, a cube and a box; a drum and a cylinder. English. */
#ifndef LANG_KINDS_H
#define LANG_KINDS_H

/* Whether two lemmas are in one group. */
int kinds_share(const char *a, const char *b);

#endif
