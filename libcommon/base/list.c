#include "base/list.h"

#include <string.h>

int list_next(const char **rest, struct list_name *name)
{
	if (!*rest)
		return 0;
	*name = (struct list_name){*rest, strcspn(*rest, ",")};
	*rest = name->text[name->length] ? name->text + name->length + 1 : NULL;
	return 1;
}

int list_has(const char *words, const char *word)
{
	for (;; words++) {
		const char *w = word;
		while (*w && *w != '|' && *w == *words)
			w++, words++;
		if (!*w && (!*words || *words == '|'))
			return 1;
		while (*words && *words != '|')
			words++;
		if (!*words)
			return 0;
	}
}

int list_name_is(const struct list_name *name, const char *text)
{
	return !strncmp(name->text, text, name->length) && !text[name->length];
}
