#include "base/err.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

int err_set(struct err *e, enum err_code code, const char *format, ...)
{
	va_list ap;

	e->code = code;
	va_start(ap, format);
	vsnprintf(e->message, sizeof e->message, format, ap);
	va_end(ap);
	return -1;
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
	return -1;
}

int err_prefix(struct err *e, const char *prefix)
{
	char old[sizeof e->message];

	memcpy(old, e->message, sizeof old);
	snprintf(e->message, sizeof e->message, "%s: %.900s", prefix, old);
	return -1;
}
