#include "base/jsontext.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void put(struct jsontext *j, char c)
{
	if (c == '<' && j->is_page)
		fputs("\\u003c", j->out);
	else
		fputc(c, j->out);
}

static void put_quoted(struct jsontext *j, const char *text)
{
	static const char special[] = "\"\\\b\f\n\r\t", letters[] = "\"\\bfnrt";

	fputc('"', j->out);
	for (; *text; text++) {
		const char *found = strchr(special, *text);
		if (found)
			fprintf(j->out, "\\%c", letters[found - special]);
		else if ((unsigned char)*text < ' ')
			fprintf(j->out, "\\u%04x", (unsigned)*text);
		else
			put(j, *text);
	}
	fputc('"', j->out);
}

static void begin(struct jsontext *j, const char *key)
{
	if (j->has_item)
		fputc(',', j->out);
	j->has_item = 1;
	if (!key)
		return;
	put_quoted(j, key);
	fputc(':', j->out);
}

void jsontext_quote(FILE *out, const char *text)
{
	put_quoted(&(struct jsontext){.out = out}, text);
}

void jsontext_open(struct jsontext *j, const char *key, char bracket)
{
	begin(j, key);
	fputc(bracket, j->out);
	j->has_item = 0;
}

void jsontext_close(struct jsontext *j, char bracket)
{
	fputc(bracket, j->out);
	j->has_item = 1;
}

void jsontext_string(struct jsontext *j, const char *key, const char *text)
{
	begin(j, key);
	put_quoted(j, text);
}

void jsontext_number(struct jsontext *j, const char *key, double x)
{
	char text[32];

	snprintf(text, sizeof text, "%.15g", x);
	const double back = strtod(text, NULL);
	if (!(fabs(back - x) <= fmax(fabs(back), fabs(x)) * DBL_EPSILON))
		snprintf(text, sizeof text, "%.17g", x);
	jsontext_raw(j, key, isfinite(x) ? text : "null");
}

void jsontext_rounded(struct jsontext *j, const char *key, double x)
{
	jsontext_number(j, key, round(x * 1e4) / 1e4);
}

void jsontext_flag(struct jsontext *j, const char *key, int is)
{
	jsontext_raw(j, key, is ? "true" : "false");
}

void jsontext_raw(struct jsontext *j, const char *key, const char *json)
{
	begin(j, key);
	for (; *json; json++)
		put(j, *json);
}
