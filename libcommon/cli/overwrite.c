#include "cli/overwrite.h"

#include "base/file.h"
#include "base/path.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

static _Noreturn void fail(const struct cli *c, const struct err *e)
{
	exit(cli_fail(c, e));
}

static const char *path_of(const struct cli_file *f)
{
	if (strcmp(f->path, "-"))
		return f->path;
	return f->use == CLI_READS ? "/dev/stdin" : "/dev/stdout";
}

static int is_same(const struct cli *c, const char *a, const char *b)
{
	struct err e;
	int same = path_is_same(a, b, &e);

	if (same < 0)
		fail(c, &e);
	return same;
}

/* Whether two parts, each a name or '*' and an ending, can be one file's. */
static int can_meet(const char *a, size_t m, const char *b, size_t n)
{
	const int is_any = *a == '*', is_other_any = *b == '*';

	if (!is_any && !is_other_any)
		return m == n && !strncmp(a, b, n);
	a += m;
	b += n;
	m -= (size_t)is_any;
	n -= (size_t)is_other_any;
	if ((!is_any && m < n) || (!is_other_any && n < m))
		return 0;
	const size_t shared = m < n ? m : n;
	return !strncmp(a - shared, b - shared, shared);
}

/* Whether any of the parts of one list can be the file of any of the other's. */
static int parts_meet(const char *a, const char *b)
{
	for (; *a; a += strcspn(a, "|"), a += *a == '|')
		for (const char *other = b; *other; other += strcspn(other, "|"), other += *other == '|')
			if (can_meet(a, strcspn(a, "|"), other, strcspn(other, "|")))
				return 1;
	return 0;
}

/* Whether a file, which may have several names, is one of the folder's parts that are there. */
static int is_listed(const struct cli *c, const char *file, const struct cli_file *folder)
{
	DIR *dir = opendir(folder->path);
	struct dirent *entry;
	int found = 0;

	while (dir && !found && (entry = readdir(dir))) {
		struct err e;
		if (!parts_meet(entry->d_name, folder->parts))
			continue;
		char *path = file_join(folder->path, entry->d_name, "", &e);
		if (!path)
			fail(c, &e);
		found = is_same(c, file, path);
		free(path);
	}
	if (dir)
		closedir(dir);
	return found;
}

/* Whether a file is one of the folder's parts, or will be once it is made. */
static int is_within(const struct cli *c, const char *file, const struct cli_file *folder)
{
	struct err e;
	char *target = path_follow(file, &e), *dir = target ? file_dir(target, &e) : NULL;
	int length;

	if (!dir)
		fail(c, &e);
	const char *name = path_last(target, &length);
	int found = (parts_meet(name, folder->parts) && is_same(c, dir, folder->path)) ||
		    (file_exists(file) && is_listed(c, file, folder));
	free(target);
	free(dir);
	return found;
}

static int do_clash(const struct cli *c, const struct cli_file *a, const struct cli_file *b)
{
	if (a->use == CLI_WRITES && b->use == CLI_WRITES && !strcmp(a->path, "-") && !strcmp(b->path, "-"))
		return 1;
	if (!a->parts == !b->parts)
		return is_same(c, path_of(a), path_of(b)) && (!a->parts || parts_meet(a->parts, b->parts));
	return a->parts ? is_within(c, path_of(b), a) : is_within(c, path_of(a), b);
}

static void refuse(const struct cli *c, const struct cli_file *out, const struct cli_file *other)
{
	if (!strcmp(out->path, "-") && !strcmp(other->path, "-") && other->use == CLI_WRITES)
		cli_usage(c, "%s and %s cannot both be stdout", out->name, other->name);
	if (other->use == CLI_WRITES && !out->parts == !other->parts)
		cli_usage(c, "%s %s and %s %s are the same", out->name, out->path, other->name, other->path);
	if (other->parts && !out->parts)
		cli_usage(c, "%s %s would be among the files of %s %s", out->name, out->path, other->name,
			other->path);
	cli_usage(c, "%s %s would overwrite %s %s", out->name, out->path, other->name, other->path);
}

void cli_refuse_overwrite(const struct cli *c, const struct cli_file *files)
{
	for (const struct cli_file *a = files; a->name; a++)
		for (const struct cli_file *b = files; a->path && a->use == CLI_WRITES && b->name; b++)
			if (b->path && (b->use == CLI_READS || b > a) && do_clash(c, a, b))
				refuse(c, a, b);
}
