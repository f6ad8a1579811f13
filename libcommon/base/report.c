#include "base/report.h"

const struct report report_silent = {0};

void report_note(const struct report *r, int level, const char *format, ...)
{
	va_list ap;

	va_start(ap, format);
	if (r->note)
		r->note(r->to, level, format, ap);
	va_end(ap);
}

void report_warn(const struct report *r, const char *format, ...)
{
	va_list ap;

	va_start(ap, format);
	if (r->warn)
		r->warn(r->to, format, ap);
	va_end(ap);
}

void report_start(const struct report *r, const char *what, double total)
{
	if (r->start)
		r->start(r->to, what, total);
}

void report_step(const struct report *r, double done, const char *note)
{
	if (r->step)
		r->step(r->to, done, note);
}

void report_end(const struct report *r)
{
	if (r->end)
		r->end(r->to);
}
