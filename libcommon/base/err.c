#include "base/err.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A message is one line, whatever names and keys it quotes. */
static void make_plain(struct err *e)
{
	for (char *p = e->message; *p; p++)
		if ((unsigned char)*p < 0x20 || *p == 0x7f)
			*p = '?';
}

int err_set(struct err *e, enum err_code code, const char *format, ...)
{
	va_list ap;

	e->code = code;
	va_start(ap, format);
	vsnprintf(e->message, sizeof e->message, format, ap);
	va_end(ap);
	make_plain(e);
	return -1;
}

int err_file(struct err *e, const char *path, const char *format, ...)
{
	char reason[sizeof e->message];
	va_list ap;

	va_start(ap, format);
	vsnprintf(reason, sizeof reason, format, ap);
	va_end(ap);
	return err_set(e, ERR_FORMAT, "%s: %s", path, reason);
}

int err_errno(struct err *e, const char *format, ...)
{
	int saved = errno;
	va_list ap;

	e->code = ERR_SYSTEM;
	va_start(ap, format);
	vsnprintf(e->message, sizeof e->message, format, ap);
	va_end(ap);
	size_t used = strlen(e->message);
	snprintf(e->message + used, sizeof e->message - used, ": %s", strerror(saved));
	make_plain(e);
	return -1;
}

int err_prefix(struct err *e, const char *prefix)
{
	char old[sizeof e->message];

	memcpy(old, e->message, sizeof old);
	snprintf(e->message, sizeof e->message, "%s: %.900s", prefix, old);
	make_plain(e);
	return -1;
}
