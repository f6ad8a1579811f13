/* JSON as text, written as it comes. Nothing fails here: whoever opened the stream looks at it at the end. */
#pragma once

#include <stdio.h>

struct jsontext {
	FILE *out;
	int is_page;  /* in a script of HTML: what could end that, or begin a comment, is escaped */
	int has_item; /* the list or object that is open has an item already */
};

/* The key of a value is NULL in a list and at the top. An object, '{', or a list, '['; and its end. */
void jsontext_open(struct jsontext *j, const char *key, char bracket);
void jsontext_close(struct jsontext *j, char bracket);

void jsontext_string(struct jsontext *j, const char *key, const char *text);
/* In as many digits as tell it from others; to four decimals; null where it is not finite. */
void jsontext_number(struct jsontext *j, const char *key, double x);
void jsontext_rounded(struct jsontext *j, const char *key, double x);
void jsontext_flag(struct jsontext *j, const char *key, int is);
/* A string by itself, in quotes. */
void jsontext_quote(FILE *out, const char *text);
/* Text that is JSON already. */
void jsontext_raw(struct jsontext *j, const char *key, const char *json);
