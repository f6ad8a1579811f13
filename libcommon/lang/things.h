/* Everyday things: what people call each, what it is for, and what it is made of and has. English; the table
 * is lang/things.tsv, a line of three fields (names; uses; what it has) each. */
#pragma once

#include <stddef.h>
#include <stdint.h>

enum { THINGS_ROWS = 6, THINGS_NAME = 28 /* bytes of the longest name with its 0 */ };

/* The lines that have a word among their names; a word may name several kinds of things. */
struct things_rows {
	int n;
	int row[THINGS_ROWS];
};

enum things_field { THINGS_NAMES, THINGS_USES, THINGS_HAS };

/* A word's, or its plural's ("scissors"). */
void things_find(struct things_rows *to, const char *lemma);

/* Whether two words name one kind of thing. */
int things_share(const struct things_rows *a, const struct things_rows *b);

/* A field of a line, of *length bytes, not ended by 0; NULL past the last line. */
const char *things_text(int row, enum things_field field, size_t *length);

/* A hash of the whole table (FNV-1a), by which what is made of it says so. */
uint32_t things_hash(void);
