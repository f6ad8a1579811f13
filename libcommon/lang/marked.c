#include "lang/marked.h"

#include "lang/closed.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static int same(const struct mark_name *a, const struct mark_name *b)
{
	return a->role == b->role && a->number == b->number && a->place == b->place;
}

/* "T", "S2", "3b": which noun; the text after it, or NULL. */
static const char *read_name(const char *s, struct mark_name *name)
{
	static const struct {
		char letter;
		enum word_role role;
	} letters[] = {{'T', ROLE_TARGET}, {'S', ROLE_ALSO}, {'X', ROLE_EXCEPT}, {'V', ROLE_VIEW},
		{'M', ROLE_MEMBER}};
	char *end;

	*name = (struct mark_name){.role = ROLE_ANCHOR};
	for (size_t i = 0; i < sizeof letters / sizeof *letters; i++)
		if (*s == letters[i].letter) {
			name->role = letters[i].role;
			if (name->role == ROLE_TARGET) /* there is one */
				return s + 1;
			name->number = (int)strtol(s + 1, &end, 10);
			return end;
		}
	if (!isdigit((unsigned char)*s))
		return NULL;
	name->number = (int)strtol(s, &end, 10);
	name->place = *end == 'b';
	return end + name->place;
}

/* "@3b" or nothing. */
static int read_of(const char *s, struct mark *m)
{
	m->of = (struct mark_name){.role = ROLE_TARGET};
	if (*s == '@')
		s = read_name(s + 1, &m->of);
	return s && !*s;
}

/* ":!near@2" */
static int read_predicate(const char *s, struct mark *m)
{
	char name[16] = "";
	size_t n;

	if (*s++ != ':')
		return 0;
	m->negated = *s == '!';
	s += m->negated;
	n = strspn(s, "abcdefghijklmnopqrstuvwxyz");
	if (n >= sizeof name)
		return 0;
	memcpy(name, s, n);
	const int relation = parse_relation_find(name);
	m->relation = relation < 0 ? PARSE_OTHER : (enum parse_relation)relation;
	return relation >= 0 && read_of(s + n, m);
}

static int read_tag(const char *s, struct mark *m)
{
	char *end;

	if (*s == 'n' && !s[1]) {
		m->role = ROLE_NAME;
		return 1;
	}
	if (*s == 'a') {
		m->role = ROLE_ATTRIBUTE;
		return read_of(s + 1, m);
	}
	if ((*s == 'A' || *s == 'P') && isdigit((unsigned char)s[1])) {
		m->role = m->name.role = *s == 'A' ? ROLE_ANCHOR : ROLE_PREDICATE;
		m->name.number = (int)strtol(s + 1, &end, 10);
		return *s == 'A' ? !*end : read_predicate(end, m);
	}
	s = read_name(s, &m->name);
	m->role = m->name.role;
	return s && !*s && m->role != ROLE_ANCHOR;
}

/* The mark of that name, or NULL. */
static const struct mark *find(const struct marked *m, const struct mark_name *name)
{
	for (int i = 0; i < m->n; i++)
		if ((role_is_phrase(m->mark[i].role) || m->mark[i].role == ROLE_PREDICATE) &&
			same(&m->mark[i].name, name))
			return &m->mark[i];
	return NULL;
}

static int add(struct marked *m, struct mark *mark, const char *tag, struct err *e)
{
	if (!read_tag(tag, mark))
		return err_set(e, ERR_FORMAT, "'/%s' is no mark", tag);
	while (mark->role == ROLE_ANCHOR && mark->name.place < MARKED_MOST && find(m, &mark->name))
		mark->name.place++;
	if ((role_is_phrase(mark->role) || mark->role == ROLE_PREDICATE) && find(m, &mark->name))
		return err_set(e, ERR_FORMAT, "mark '/%s' appears twice", tag);
	if (m->n == MARKED_MOST)
		return err_set(e, ERR_FORMAT, "more than %d marks", MARKED_MOST);
	m->mark[m->n++] = *mark;
	return 0;
}

/* What every mark hangs on is there. */
static int check(const struct marked *m, struct err *e)
{
	for (int i = 0; i < m->n; i++) {
		const struct mark *k = &m->mark[i];
		const struct mark_name predicate = {.role = ROLE_PREDICATE, .number = k->name.number};
		int noun = i + 1;
		while (noun < m->n && !role_is_phrase(m->mark[noun].role))
			noun++;
		if (k->role == ROLE_NAME && noun == m->n)
			return err_set(e, ERR_FORMAT, "no noun after mark '/n' of '%.*s'",
				k->span.end - k->span.begin, m->text + k->span.begin);
		if (k->role == ROLE_ANCHOR && !find(m, &predicate))
			return err_set(
				e, ERR_FORMAT, "mark '/A%d' has no '/P%d'", k->name.number, k->name.number);
		if ((k->role == ROLE_PREDICATE || k->role == ROLE_ATTRIBUTE) && k->of.role != ROLE_TARGET &&
			!find(m, &k->of))
			return err_set(e, ERR_FORMAT, "'%.*s' is said of a noun that has no mark",
				k->span.end - k->span.begin, m->text + k->span.begin);
	}
	return m->n ? 0 : err_set(e, ERR_FORMAT, "no mark");
}

int marked_take(struct marked *m, const char *line, struct err *e)
{
	static const char blanks[] = " \t\r\n";
	int length = 0;

	*m = (struct marked){0};
	for (line += strspn(line, blanks); *line; line += strspn(line, blanks)) {
		const int n = (int)strcspn(line, blanks);
		const char *slash = memchr(line, '/', (size_t)n);
		int word = slash ? (int)(slash - line) : n, end = n;
		char tag[32] = "";
		if (slash) {
			while (end > word + 1 && !isalnum((unsigned char)line[end - 1]))
				end--;
			if (end - word > (int)sizeof tag || !word)
				return err_set(e, ERR_FORMAT, "'%.*s' is no word with a mark", n, line);
			memcpy(tag, slash + 1, (size_t)(end - word - 1));
		}
		if (length + n + 2 > MARKED_LENGTH)
			return err_set(e, ERR_FORMAT, "longer than %d bytes", MARKED_LENGTH);
		if (length)
			m->text[length++] = ' ';
		struct mark mark = {.span = {length, length + word}};
		memcpy(m->text + length, line, (size_t)word);
		memcpy(m->text + length + word, line + end, (size_t)(n - end));
		length += word + n - end;
		line += n;
		if (slash && add(m, &mark, tag, e))
			return -1;
	}
	return check(m, e);
}

/* The words from *from to *to-1 lie in the span, but for a clitic: "plate's" is the plate. */
static void words_of(const struct tokens *t, struct parse_span span, int *from, int *to)
{
	for (*from = 0; *from < t->n && t->word[*from].span.end <= span.begin;)
		++*from;
	for (*to = *from; *to < t->n && t->word[*to].span.begin < span.end;)
		++*to;
	while (*to - *from > 1 && (t->word[*to - 1].text[0] == '\'' || tokens_is(t, *to - 1, "n't")))
		--*to;
}

/* Of a word that is several ("left-most"): the one that places, or the last. */
static int main_word(const struct tokens *t, int from, int to)
{
	for (int i = from; i < to; i++)
		if (tokens_class(t, i) == CLOSED_PLACE || tokens_class(t, i) == CLOSED_SIZE)
			return i;
	return to - 1;
}

/* The word that what is said of `of` hangs on. */
static int head_of(const struct marked *m, const struct tokens *t, const struct mark_name *of)
{
	const struct mark *k = of->role == ROLE_TARGET ? NULL : find(m, of);
	int from, to;

	if (!k)
		return ROOT;
	words_of(t, k->span, &from, &to);
	return k->role == ROLE_PREDICATE ? main_word(t, from, to) : to - 1;
}

/* The noun after mark i, as a head. */
static int noun_after(const struct marked *m, int i, const struct tokens *t)
{
	int from, to;

	while (i < m->n && !role_is_phrase(m->mark[i].role))
		i++;
	if (i == m->n || m->mark[i].role == ROLE_TARGET)
		return ROOT;
	words_of(t, m->mark[i].span, &from, &to);
	return to - 1;
}

static void mark_words(const struct marked *m, int i, const struct tokens *t, struct analysis *a)
{
	const struct mark *k = &m->mark[i];
	int from, to, head = ROOT;

	words_of(t, k->span, &from, &to);
	if (k->role == ROLE_ATTRIBUTE || k->role == ROLE_PREDICATE)
		head = head_of(m, t, &k->of);
	else if (k->role == ROLE_ANCHOR)
		head = head_of(m, t, &(struct mark_name){.role = ROLE_PREDICATE, .number = k->name.number});
	else if (k->role == ROLE_NAME)
		head = noun_after(m, i, t);
	for (int w = from; w < to; w++) {
		struct analysis_word *word = &a->word[w];
		if (k->role == ROLE_PREDICATE && w != main_word(t, from, to))
			continue;
		*word = (struct analysis_word){
			.role = k->role, .head = head, .relation = k->relation, .negated = k->negated};
		if (role_is_phrase(k->role) && w + 1 < to)
			*word = (struct analysis_word){
				.role = ROLE_NAME, .head = k->role == ROLE_TARGET ? ROOT : to - 1};
	}
}

int marked_analyse(const struct marked *m, const struct tokens *t, struct analysis *a, struct err *e)
{
	struct analysis mended;

	a->n = t->n;
	for (int i = 0; i < t->n; i++)
		analysis_give_up(&a->word[i]);
	for (int i = 0; i < m->n; i++)
		mark_words(m, i, t, a);
	mended = *a;
	analysis_repair(&mended);
	for (int i = 0; i < t->n; i++)
		if (mended.word[i].role != a->word[i].role || mended.word[i].head != a->word[i].head)
			return err_set(e, ERR_FORMAT, "'%s' hangs on itself, or on what has no mark",
				t->word[i].text);
	return 0;
}
