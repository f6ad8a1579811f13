/* Errors: filled in where they happen, printed by the tool. The library never prints or exits. Brings
 * <stddef.h>: what can fail has sizes. */
#pragma once

#include <stddef.h>

/* The values are the tools' exit statuses. */
enum err_code {
	ERR_NONE = 0,
	ERR_CHECK = 1,	/* a check was false */
	ERR_USAGE = 2,	/* command line */
	ERR_FORMAT = 3, /* malformed or inconsistent input */
	ERR_SYSTEM = 4, /* input/output or memory */
};

struct err {
	enum err_code code;
	char message[1024]; /* complete but for the tool's name: "file: reason, with offset, line or key" */
};

/* Sets code and message; an earlier message is replaced. Control characters become '?', so that a message is
 * one line whatever names it quotes. Always returns -1, so `return err_set(...)` fails. */
int err_set(struct err *e, enum err_code code, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Of a file that is malformed: ERR_FORMAT, "PATH: " and the reason. */
int err_file(struct err *e, const char *path, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* As err_set with ERR_SYSTEM; appends ": " and the text of errno. */
int err_errno(struct err *e, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Puts "prefix: " before the message. Always returns -1. */
int err_prefix(struct err *e, const char *prefix);
