#include "base/report.h"

#include <stddef.h>

static void say_nothing(void *to, int level, const char *format, va_list ap)
{
	(void)to, (void)level, (void)format, (void)ap;
}

static void warn_of_nothing(void *to, const char *format, va_list ap)
{
	(void)to, (void)format, (void)ap;
}

static void start_nothing(void *to, const char *what, double total)
{
	(void)to, (void)what, (void)total;
}

static void step_nowhere(void *to, double done, const char *note)
{
	(void)to, (void)done, (void)note;
}

static void end_nothing(void *to)
{
	(void)to;
}

const struct report report_silent = {
	NULL, say_nothing, warn_of_nothing, start_nothing, step_nowhere, end_nothing};

void report_note(const struct report *r, int level, const char *format, ...)
{
	va_list ap;

	va_start(ap, format);
	r->note(r->to, level, format, ap);
	va_end(ap);
}

void report_warn(const struct report *r, const char *format, ...)
{
	va_list ap;

	va_start(ap, format);
	r->warn(r->to, format, ap);
	va_end(ap);
}

void report_start(const struct report *r, const char *what, double total)
{
	r->start(r->to, what, total);
}

void report_step(const struct report *r, double done, const char *note)
{
	r->step(r->to, done, note);
}

void report_end(const struct report *r)
{
	r->end(r->to);
}
