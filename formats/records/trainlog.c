#include "formats/records/trainlog.h"

#include "base/mem.h"

#include <stdarg.h>
#include <sys/stat.h>
#include <unistd.h>

/* Where the lines up to an iteration end. Only whole lines count. */
static long find_end(FILE *in, long iteration)
{
	SCOPED char *line = NULL;
	size_t capacity = 0;
	ssize_t length;
	long at = 0, end = 0, own;

	while ((length = getline(&line, &capacity, in)) > 0) {
		at += length;
		if (line[length - 1] == '\n' && sscanf(line, "{\"iteration\":%ld,", &own) == 1 &&
			own <= iteration)
			end = at;
	}
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

/* A line, at once. */
static int put(struct trainlog *l, struct err *e, const char *format, ...)
	__attribute__((format(printf, 3, 4)));

static int put(struct trainlog *l, struct err *e, const char *format, ...)
{
	va_list ap;

	if (!l->stream)
		return 0;
	va_start(ap, format);
	const int bad = vfprintf(l->stream, format, ap) < 0 || fflush(l->stream);
	va_end(ap);
	return bad ? err_errno(e, "%s", file_name(l->path)) : 0;
}

int trainlog_step(struct trainlog *l, struct train_state *t, struct err *e)
{
	const double n = TRAINLOG_EVERY;

	if (t->iteration % TRAINLOG_EVERY)
		return 0;
	if (put(l, e, "{\"iteration\":%ld,\"bce\":%.9g,\"contrast\":%.9g,\"loss\":%.9g}\n", t->iteration,
		    t->sum.bce / n, t->sum.contrast / n, t->sum.total / n))
		return -1;
	t->sum = (struct step_losses){0};
	return 0;
}

int trainlog_put_fit(
	struct trainlog *l, long iteration, size_t gaussians, double loss, double psnr, struct err *e)
{
	return put(l, e, "{\"iteration\":%ld,\"gaussians\":%zu,\"loss\":%.9g,\"psnr\":%.9g}\n", iteration,
		gaussians, loss, psnr);
}

int trainlog_put_judged(
	struct trainlog *l, long iteration, size_t gaussians, double psnr, double ssim, struct err *e)
{
	return put(l, e, "{\"iteration\":%ld,\"gaussians\":%zu,\"judged_psnr\":%.9g,\"judged_ssim\":%.9g}\n",
		iteration, gaussians, psnr, ssim);
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
