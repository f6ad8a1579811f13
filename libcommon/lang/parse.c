#include "lang/parse.h"

#include "base/list.h"

#include <stdlib.h>
#include <string.h>

static const char *const names[PARSE_RELATIONS] = {"left", "right", "front", "behind", "above", "below", "on",
	"inside", "near", "far", "between", "middle", "larger", "smaller", "taller", "shorter", "longer",
	"wider", "corner", "wall", "floor", "facing", "across", "supports", "with", "other"};

const char *parse_relation_name(enum parse_relation r)
{
	return names[r];
}

int parse_relation_find(const char *name)
{
	for (int r = 0; r < PARSE_RELATIONS; r++)
		if (!strcmp(names[r], name))
			return r;
	return -1;
}

void parse_free(struct parse *p)
{
	for (int i = 0; i < p->word_count; i++) {
		free(p->words[i].text);
		free(p->words[i].lemma);
	}
	for (int i = 0; i < p->phrase_count; i++) {
		struct parse_phrase *f = &p->phrases[i];
		free(f->noun.item);
		free(f->attributes.item);
		free(f->clauses.item);
		free(f->among.item);
		free(f->except.item);
		free(f->also.item);
	}
	for (int i = 0; i < p->clause_count; i++) {
		free(p->clauses[i].anchors.item);
		free(p->clauses[i].words.item);
	}
	free(p->unexplained.item);
	free(p->words);
	free(p->phrases);
	free(p->clauses);
	*p = (struct parse){0};
}

int parse_list_add(struct parse_list *list, int item, struct err *e)
{
	int *grown = realloc(list->item, sizeof *grown * (size_t)(list->n + 1));

	if (!grown)
		return err_set(e, ERR_SYSTEM, "parse: out of memory");
	list->item = grown;
	list->item[list->n++] = item;
	return 0;
}

int parse_list_join(struct parse_list *to, const struct parse_list *from, struct err *e)
{
	for (int i = 0; i < from->n; i++)
		if (parse_list_add(to, from->item[i], e))
			return -1;
	return 0;
}

int parse_list_has(const struct parse_list *list, int item)
{
	for (int i = 0; i < list->n; i++)
		if (list->item[i] == item)
			return 1;
	return 0;
}

void parse_list_cut(struct parse_list *list, int end)
{
	int n = 0;

	for (int i = 0; i < list->n; i++)
		if (list->item[i] < end)
			list->item[n++] = list->item[i];
	list->n = n;
}

int parse_word_is(const struct parse *p, int word, const char *words)
{
	return word >= 0 && word < p->word_count && list_has(words, p->words[word].text);
}
