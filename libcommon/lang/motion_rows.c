#include "lang/motion_rows.h"

#include "base/embed.h"
#include "base/list.h"
#include "lang/closed.h"

#include <string.h>

EMBED(motion_words, "libcommon/lang/motion_words.tsv");
extern const unsigned char motion_words_begin[];

static const char *const names[MOTION_KINDS] = {"moves", "still", "starts", "stops", "pauses", "falls",
	"raised", "lowered", "rolls", "slides", "turns", "tips", "left", "right", "up", "down", "towards",
	"away", "passes", "behind", "front", "swaps", "follows", "fastest", "slowest", "farthest", "least",
	"first", "last", "while", "before", "after", "time"};

const char *motion_kind_name(enum motion_kind kind)
{
	return names[kind];
}

/* Whether a word is a form of a verb: "roll", "rolls", "rolled", "rolling", "stopping". */
static int is_form(const char *word, const char *verb, size_t n)
{
	const char last = verb[n - 1];
	const size_t stem = last == 'e' ? n - 1 : n;
	char tail[8];

	if (last == 'y' && n > 2 && !strncmp(word, verb, n - 1) && list_has("ies|ied", word + n - 1))
		return 1;
	if (last == 'e' && !strncmp(word, verb, stem) && !strcmp(word + stem, "ing"))
		return 1;
	if (strncmp(word, verb, n) != 0 || strlen(word) > n + 4)
		return 0;
	memcpy(tail, word + n, strlen(word + n) + 1);
	if (*tail == last && strlen(tail) > 2) /* doubled */
		memmove(tail, tail + 1, strlen(tail));
	return !*tail || list_has("s|es|d|ed|ing", tail);
}

static int is_choice(const struct parse *p, int at, const char *choice, size_t length)
{
	const char *word = p->words[at].text;

	if (*choice == '*')
		return is_form(word, choice + 1, length - 1);
	if (*choice == '=')
		return closed_class_of(p, at) == CLOSED_BE;
	return strlen(word) == length && !strncmp(word, choice, length);
}

/* Matches what is said in a row, from a word on; -1 or the word behind it. */
static int match(const struct parse *p, int at, int end, const char *said)
{
	size_t length = strcspn(said, " \n");
	const char *rest = said + length + (said[length] == ' ');
	int is = 0;

	if (!length)
		return at;
	if (*said == 'B' && length == 1)
		return at < end ? at : -1;
	const int is_free = said[length - 1] == '?';
	length -= (size_t)is_free;
	for (size_t from = 0, to; at < end && from < length && !is; from = to + 1) {
		for (to = from; to < length && said[to] != '|'; to++)
			;
		is = is_choice(p, at, said + from, to - from);
	}
	const int taken = is ? match(p, at + 1, end, rest) : -1;
	return taken < 0 && is_free ? match(p, at, end, rest) : taken;
}

static enum motion_kind kind_of(const char *line)
{
	const size_t n = strcspn(line, "\t");
	int k = 0;

	while (k < MOTION_KINDS && (strlen(names[k]) != n || strncmp(names[k], line, n) != 0))
		k++;
	return (enum motion_kind)k;
}

int motion_row_find(
	const struct parse *p, int at, int end, char slot, int may_have_other, struct motion_row *r)
{
	*r = (struct motion_row){MOTION_NONE, at, 0};
	for (const char *row = (const char *)motion_words_begin, *last; *row; row = last + 1) {
		last = strchr(row, '\n');
		const char *columns = memchr(row, '\t', (size_t)(last - row));
		const int has_other = last[-1] == 'B';
		if (!columns || columns[1] != slot || has_other > may_have_other)
			continue;
		const int to = match(p, at, end, columns + 3);
		if (to > r->end)
			*r = (struct motion_row){kind_of(row), to, has_other};
	}
	return r->kind != MOTION_NONE;
}
