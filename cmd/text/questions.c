#include "cmd/text/questions.h"

#include "base/name.h"
#include "base/utf8.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char too_long[] = "is longer than 2000 bytes";

/* In plain characters, without the blanks at its ends: whether anything is left. */
static int trim(char *text)
{
	const char *kept = name_trim(text);

	memmove(text, kept, strlen(kept) + 1);
	return *text != 0;
}

/* Why a text of n bytes is no question; NULL: it may be one. */
static const char *find_fault(const char *text, size_t n)
{
	if (strlen(text) < n)
		return "has a NUL byte, as UTF-16 has: write it as UTF-8";
	if (utf8_check(text, n) < n)
		return "is not UTF-8";
	return n > QUESTION_MOST ? too_long : NULL;
}

/* Reads what there is, behind what was read; waits for it. Returns 0, or -1 with *e set. */
static int read_more(struct questions *from, struct err *e)
{
	ssize_t got;

	if (from->begin == from->end)
		from->begin = from->end = 0;
	do
		got = read(from->fd, from->read + from->end, sizeof from->read - from->end);
	while (got < 0 && errno == EINTR);
	if (got < 0)
		return err_errno(e, "stdin");
	from->is_at_end = !got;
	from->end += (size_t)got;
	return 0;
}

/* The next byte, EOF at the end, or -2 with *e set. */
static int next_byte(struct questions *from, struct err *e)
{
	if (from->begin == from->end && !from->is_at_end && read_more(from, e))
		return -2;
	return from->begin < from->end ? (unsigned char)from->read[from->begin++] : EOF;
}

int question_next(struct question *q, struct questions *from, struct err *e)
{
	int byte;

	for (q->is_first = 0;; q->is_first = 1) {
		size_t n = 0;
		int is_long = 0;
		while ((byte = next_byte(from, e)) >= 0 && byte != '\n') {
			is_long |= n > QUESTION_MOST;
			if (n <= QUESTION_MOST)
				q->text[n++] = (char)byte;
		}
		if (byte == -2)
			return -1;
		from->line += byte != EOF || n;
		q->line = from->line;
		q->text[n] = 0;
		q->fault = is_long ? too_long : find_fault(q->text, n);
		if (q->fault || trim(q->text))
			return 1;
		if (byte == EOF)
			return 0;
	}
}

/* 1 where a whole line that is not blank has been read. */
static int has_line(const struct questions *from)
{
	const char *at = from->read + from->begin, *end = from->read + from->end, *newline;

	for (; (newline = memchr(at, '\n', (size_t)(end - at))); at = newline + 1)
		for (; at < newline; at++)
			if (!*at || !strchr(" \t\r", *at))
				return 1;
	return 0;
}

int question_waits(struct questions *from)
{
	struct pollfd more = {.fd = from->fd, .events = POLLIN};
	struct err e;

	while (!has_line(from) && !from->is_at_end) {
		memmove(from->read, from->read + from->begin, from->end - from->begin);
		from->end -= from->begin;
		from->begin = 0;
		if (from->end == sizeof from->read || poll(&more, 1, 0) <= 0 || read_more(from, &e))
			return 0;
	}
	return has_line(from);
}

int question_take(struct question *q, const char *text)
{
	const size_t n = strlen(text);

	q->fault = find_fault(text, n);
	if (q->fault)
		return 0;
	memcpy(q->text, text, n + 1);
	if (trim(q->text))
		return 1;
	q->fault = "is empty";
	return 0;
}
