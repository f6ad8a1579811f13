#include "cmd/ask/asking.h"

#include "base/file.h"
#include "base/mem.h"

#include <stdlib.h>
#include <sys/stat.h>

static int check_there(const char *path, struct err *e)
{
	struct stat s;

	return stat(path, &s) ? err_errno(e, "%s", path) : 0;
}

/* A part of the folder, or what was given in its place by an option. */
static char *find_part(
	const char *run, const char *given, const char *part, const char *option, struct err *e)
{
	char *path = given ? mem_strdup(given, e) : file_join(run, part, "", e);

	if (!path || given || file_exists(path))
		return path;
	free(path);
	err_set(e, ERR_SYSTEM,
		"%s: no %s in it: 'make -f pipelines/lift.mk SCENE=%s ...' makes one, %s names another", run,
		part, run, option);
	return NULL;
}

int run_folder_find(struct run_folder *f, const char *run, const struct run_folder *given, struct err *e)
{
	*f = (struct run_folder){0};
	if (check_there(run, e))
		return -1;
	if (!(f->scene = find_part(run, given->scene, "scene", "--scene", e)) ||
		!(f->model = find_part(run, given->model, "lifted/model.safetensors", "--model", e)))
		return -1;
	f->encoder = given->encoder ? mem_strdup(given->encoder, e) : encoder_default(e);
	return f->encoder ? 0 : -1;
}

void run_folder_free(struct run_folder *f)
{
	free(f->scene);
	free(f->model);
	free(f->encoder);
}
