/* Comma-separated names, as command lines have them. */
#pragma once

#include <stddef.h>

struct list_name {
	const char *text; /* length bytes, no NUL after them */
	size_t length;
};

/* The next name of *rest, which moves on: 1, or 0 where *rest is NULL, as it is after the last. "" is one
 * empty name. */
int list_next(const char **rest, struct list_name *name);

/* 1 where the name is this text. */
int list_name_is(const struct list_name *name, const char *text);
