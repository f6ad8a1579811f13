#include "cmd/text/encode.h"

#include "base/file.h"
#include "base/mem.h"

#include <stdlib.h>

char *cache_folder(const char *name, struct err *e)
{
	const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
	const int has_cache = cache && *cache;

	if (!has_cache && !(home && *home)) {
		err_set(e, ERR_USAGE, "no %s is named, and HOME is not set", name);
		return NULL;
	}
	SCOPED char *dir = has_cache ? file_join(cache, "refersplat", "", e)
				     : file_join(home, ".cache/refersplat", "", e);
	char *path = dir ? file_join(dir, name, "", e) : NULL;
	return path;
}
