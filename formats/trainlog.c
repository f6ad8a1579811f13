#include "formats/trainlog.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Where the lines up to an iteration end. Only whole lines count. */
static long find_end(FILE *in, long iteration)
{
	char *line = NULL;
	size_t capacity = 0;
	ssize_t length;
	long at = 0, end = 0, own;

	while ((length = getline(&line, &capacity, in)) > 0) {
		at += length;
		if (line[length - 1] == '\n' && sscanf(line, "{\"iteration\":%ld,", &own) == 1 &&
			own <= iteration)
			end = at;
	}
	free(line);
	return end;
}

int trainlog_open(struct trainlog *l, const char *path, long iteration, struct err *e)
{
	struct stat st;

	*l = (struct trainlog){.path = path};
	if (!path)
		return 0;
	if (!strcmp(path, "-") || (!stat(path, &st) && !S_ISREG(st.st_mode))) {
		if (file_out_open(&l->out, path, e))
			return -1;
		l->stream = l->out.stream;
		return 0;
	}
	l->stream = fopen(path, iteration ? "a+" : "w");
	if (!l->stream)
		return err_errno(e, "%s", path);
	rewind(l->stream);
	if (iteration && (ftruncate(fileno(l->stream), find_end(l->stream, iteration)) ||
				 fseek(l->stream, 0, SEEK_END)))
		return err_errno(e, "%s", path);
	return 0;
}

int trainlog_put(struct trainlog *l, long iteration, const struct step_losses *sum, long steps, struct err *e)
{
	const double n = (double)steps;

	if (l->stream &&
		(fprintf(l->stream, "{\"iteration\":%ld,\"bce\":%.9g,\"contrast\":%.9g,\"loss\":%.9g}\n",
			 iteration, sum->bce / n, sum->contrast / n, sum->total / n) < 0 ||
			fflush(l->stream)))
		return err_errno(e, "%s", file_name(l->path));
	return 0;
}

int trainlog_close(struct trainlog *l, struct err *e)
{
	int bad = 0;

	if (l->out.stream)
		bad = file_out_commit(&l->out, e);
	else if (l->stream && fclose(l->stream))
		bad = err_errno(e, "%s", l->path);
	*l = (struct trainlog){0};
	return bad;
}
