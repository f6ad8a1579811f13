#include "cli/overwrite.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"
#include "cli/cli.h"

#include <assert.h>
#include <dirent.h>

enum { MOST = 16, NAME_ROOM = 32 }; /* files of a tool's options; letters of an option */

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
		SCOPED char *path = file_join(folder->path, entry->d_name, "", &e);
		if (!path)
			fail(c, &e);
		found = is_same(c, file, path);
	}
	if (dir)
		closedir(dir);
	return found;
}

/* Whether a file is there in a folder that is one of the folder's parts. */
static int is_below(const struct cli *c, const char *target, const struct cli_file *folder)
{
	struct err e;
	SCOPED char *dir = file_dir(target, &e), *above = dir ? file_dir(dir, &e) : NULL;
	int length;

	if (!above)
		fail(c, &e);
	return parts_meet(path_last(dir, &length), folder->parts) && is_same(c, above, folder->path);
}

/* Whether a file is one of the folder's parts, or will be once it is made. */
static int is_within(const struct cli *c, const char *file, const struct cli_file *folder)
{
	struct err e;
	SCOPED char *target = path_follow(file, &e), *dir = target ? file_dir(target, &e) : NULL;
	int length;

	if (!dir)
		fail(c, &e);
	const char *name = path_last(target, &length);
	return (parts_meet(name, folder->parts) && is_same(c, dir, folder->path)) ||
	       (file_exists(file) && (is_below(c, target, folder) || is_listed(c, file, folder)));
}

static int do_clash(const struct cli *c, const struct cli_file *a, const struct cli_file *b)
{
	if (a->use == b->use && !strcmp(a->path, "-") && !strcmp(b->path, "-"))
		return 1;
	if (a->use == CLI_READS && b->use == CLI_READS)
		return 0;
	if (!a->parts == !b->parts)
		return is_same(c, path_of(a), path_of(b)) && (!a->parts || parts_meet(a->parts, b->parts));
	return a->parts ? is_within(c, path_of(b), a) : is_within(c, path_of(a), b);
}

static void refuse(const struct cli *c, const struct cli_file *a, const struct cli_file *b)
{
	const struct cli_file *out = a->use == CLI_WRITES ? a : b, *other = out == a ? b : a;

	if (a->use == b->use && !strcmp(a->path, "-") && !strcmp(b->path, "-"))
		cli_usage(c, "%s and %s cannot both be %s", a->name, b->name,
			a->use == CLI_READS ? "stdin" : "stdout");
	if (other->use == CLI_WRITES && !out->parts == !other->parts)
		cli_usage(c, "%s %s and %s %s are the same", out->name, out->path, other->name, other->path);
	if (other->parts && !out->parts)
		cli_usage(c, "%s %s would be among the files of %s %s", out->name, out->path, other->name,
			other->path);
	cli_usage(c, "%s %s would overwrite %s %s", out->name, out->path, other->name, other->path);
}

static void check_pairs(const struct cli *c, const struct cli_file *files, size_t n)
{
	for (size_t i = 0; i < n; i++)
		for (size_t k = i + 1; k < n; k++)
			if (files[i].path && files[k].path && do_clash(c, &files[i], &files[k]))
				refuse(c, &files[i], &files[k]);
}

/* What a word of a list, "NAME" or "NAME:PARTS", stands for. The word and `shown` are pointed to. */
static struct cli_file from_word(const struct cli *c, char *word, char *shown, enum cli_use use)
{
	struct cli_file f = {.name = shown, .use = use};
	char *colon = strchr(word, ':');

	if (colon) {
		*colon = 0;
		f.parts = colon + 1;
	}
	snprintf(shown, NAME_ROOM, "--%s", word);
	if (!strcmp(word, "output")) {
		f.name = "-o";
		f.path = c->output;
	} else if (*word >= 'A' && *word <= 'Z') {
		f.name = word;
		f.path = c->operand_count ? c->operands[0] : "-";
	}
	for (const struct cli_option *o = c->tool->options; o && o->name; o++)
		if (!f.path && !strcmp(o->name, word))
			f.path = *(const char **)o->value;
	return f;
}

void cli_refuse_overwrite(
	const struct cli *c, const char *reads, const char *writes, const struct cli_file *more)
{
	char text[1024], shown[MOST][NAME_ROOM], *rest;
	const int length = snprintf(text, sizeof text, "%s > %s", writes, reads);
	enum cli_use use = CLI_WRITES;
	size_t n = 0, count = 0;
	struct err e;

	while (more && more[count].name)
		count++;
	SCOPED struct cli_file *files = mem_alloc(MOST + count, sizeof *files, "files", &e);
	if (!files)
		fail(c, &e);
	assert(length < (int)sizeof text);
	for (char *word = strtok_r(text, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
		assert(n < MOST);
		if (!strcmp(word, ">")) {
			use = CLI_READS;
			continue;
		}
		files[n] = from_word(c, word, shown[n], use);
		n++;
	}
	for (size_t i = 0; i < count; i++)
		files[n++] = more[i];
	check_pairs(c, files, n);
}
