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

int list_name_is(const struct list_name *name, const char *text)
{
	return !strncmp(name->text, text, name->length) && !text[name->length];
}
