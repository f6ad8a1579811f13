/* How long work tells of itself. Nothing below the tools prints: it calls what its caller gave it. */
#pragma once

#include <stdarg.h>

struct report {
	void *to; /* handed to each of these */
	void (*note)(void *to, int level, const char *format, va_list ap);
	void (*warn)(void *to, const char *format, va_list ap);
	void (*start)(void *to, const char *what, double total); /* of progress: "views", how many */
	void (*step)(void *to, double done, const char *note);	 /* note may be NULL */
	void (*end)(void *to);
};

/* For a caller that wants to hear nothing. */
extern const struct report report_silent;

/* A line for who wants to know more (level 1) or much more (2). */
void report_note(const struct report *r, int level, const char *format, ...)
	__attribute__((format(printf, 3, 4)));

/* Something that is wrong but no reason to stop. */
void report_warn(const struct report *r, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Progress: one at a time. */
void report_start(const struct report *r, const char *what, double total);
void report_step(const struct report *r, double done, const char *note);
void report_end(const struct report *r);
