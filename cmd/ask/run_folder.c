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

/* RUN/lifted/NAME where it is there; else *path is NULL. */
static int find_lifted(char **path, const char *run, const char *name, struct err *e)
{
	if (!(*path = file_join(run, name, "", e)))
		return -1;
	if (!file_exists(*path)) {
		free(*path);
		*path = NULL;
	}
	return 0;
}

static int find_models(
	struct run_folder *f, const char *run, const char *given, int may_be_nameless, struct err *e)
{
	if (!given && (find_lifted(&f->labels, run, "lifted/labels.safetensors", e) ||
			      find_lifted(&f->model, run, "lifted/model.safetensors", e)))
		return -1;
	if (!f->model && f->labels) {
		f->model = f->labels;
		f->labels = NULL;
	}
	if (!f->model && !(may_be_nameless && !given))
		f->model = find_part(run, given, "lifted/model.safetensors", "--model", e);
	return f->model || (may_be_nameless && !given) ? 0 : -1;
}

int run_folder_find(struct run_folder *f, const char *run, const struct run_folder *given,
	int may_be_nameless, struct err *e)
{
	*f = (struct run_folder){0};
	if (check_there(run, e) || !(f->scene = find_part(run, given->scene, "scene", "--scene", e)) ||
		find_models(f, run, given->model, may_be_nameless, e))
		return -1;
	f->encoder = given->encoder ? mem_strdup(given->encoder, e) : cached_model("encoder", e);
	return f->encoder ? 0 : -1;
}

void run_folder_free(struct run_folder *f)
{
	mem_free_all(f->scene, f->model, f->encoder, f->labels);
}
