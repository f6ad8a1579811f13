#include "cmd/jobs/questions.h"

#include "base/utf8.h"

#include <string.h>

static const char too_long[] = "is longer than 2000 bytes";

/* Without the blanks at its ends: its new length. */
static size_t trim(char *text, size_t n)
{
	const size_t blank = strspn(text, " \t\r\n");

	while (n > blank && strchr(" \t\r\n", text[n - 1]))
		n--;
	n = n > blank ? n - blank : 0;
	memmove(text, text + blank, n);
	text[n] = 0;
	return n;
}

/* Why a text of n bytes is no question; NULL: it may be one. */
static const char *find_fault(const char *text, size_t n)
{
	if (strlen(text) < n)
		return "has a NUL byte";
	if (utf8_check(text, n) < n)
		return "is not UTF-8";
	return n > QUESTION_MOST ? too_long : NULL;
}

int question_next(struct question *q, FILE *in, struct err *e)
{
	int byte;

	do {
		size_t n = 0;
		int is_long = 0;
		while ((byte = getc(in)) != EOF && byte != '\n') {
			is_long |= n > QUESTION_MOST;
			if (n <= QUESTION_MOST)
				q->text[n++] = (char)byte;
		}
		if (ferror(in))
			return err_errno(e, "stdin");
		q->line += byte != EOF || n;
		q->text[n] = 0;
		q->fault = is_long ? too_long : find_fault(q->text, n);
		if (q->fault || trim(q->text, n))
			return 1;
	} while (byte != EOF);
	return 0;
}

int question_take(struct question *q, const char *text)
{
	const size_t n = strlen(text);

	q->fault = find_fault(text, n);
	if (q->fault)
		return 0;
	memcpy(q->text, text, n + 1);
	if (trim(q->text, n))
		return 1;
	q->fault = "is empty";
	return 0;
}
