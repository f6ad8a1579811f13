/* Rows of libcommon/lang/motion_words.tsv: how motion is said. */
#pragma once

#include "lang/motion_said.h"

struct motion_row {
	enum motion_kind kind;
	int end;       /* the word behind it */
	int has_other; /* words for another thing follow */
};

/* The longest row of a slot, the table's letter, that fits a parse's words from `at` on, and of those the
 * first; without may_have_other only of those that need no words for another thing. Returns whether there is
 * one. */
int motion_row_find(
	const struct parse *p, int at, int end, char slot, int may_have_other, struct motion_row *r);
