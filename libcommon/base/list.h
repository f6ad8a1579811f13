/* Comma-separated names, as command lines have them; words of a list, as the program has them. */
#pragma once

#include <stddef.h>

struct list_name {
	const char *text; /* length bytes, no NUL after them */
	size_t length;
};

/* The next name of *rest, which moves on: 1, or 0 where *rest is NULL, as after the last. "" is one name. */
int list_next(const char **rest, struct list_name *name);

/* 1 where the name is this text. */
int list_name_is(const struct list_name *name, const char *text);

/* 1 where a word is one of "this|that|those". */
int list_has(const char *words, const char *word);
