#include "formats/records/readings.h"

#include "base/mem.h"
#include "formats/records/jsonl.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

void readings_free(struct reading_set *s)
{
	for (size_t i = 0; i < s->n; i++) {
		free(s->records[i].ref);
		free(s->records[i].room);
	}
	free(s->records);
	*s = (struct reading_set){0};
}

/* The lemma of the last word. */
static void last_lemma(const char *noun, char *out)
{
	char word[TOKEN_LENGTH];
	size_t end = strlen(noun), begin, n = 0;

	while (end && !isalnum((unsigned char)noun[end - 1]))
		end--;
	for (begin = end;
		begin && noun[begin - 1] != ' ' && noun[begin - 1] != '-' && noun[begin - 1] != '/';)
		begin--;
	while (begin < end && n < TOKEN_LENGTH - 1)
		word[n++] = (char)tolower((unsigned char)noun[begin++]);
	word[n] = 0;
	token_lemma(word, out);
}

/* Clauses beyond what a reading holds are left out. */
static void read_clauses(struct reading *r, const cJSON *of, int figure)
{
	const cJSON *c, *a;

	cJSON_ArrayForEach(c, cJSON_GetObjectItemCaseSensitive(of, "clauses"))
	{
		const cJSON *relation = cJSON_GetObjectItemCaseSensitive(c, "relation");
		int at = r->clause_count;
		if (at == READING_CLAUSES || !cJSON_IsString(relation))
			continue;
		r->clause_count++;
		r->clause[at].relations = reading_relations(relation->valuestring);
		r->clause[at].negated = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(c, "negated"));
		r->clause[at].figure = figure;
		cJSON_ArrayForEach(a, cJSON_GetObjectItemCaseSensitive(c, "anchors"))
		{
			const cJSON *noun = cJSON_GetObjectItemCaseSensitive(a, "noun");
			int k = r->anchor_count;
			if (k == READING_ANCHORS || !cJSON_IsString(noun))
				continue;
			r->anchor_count++;
			last_lemma(noun->valuestring, r->anchor[k].noun);
			r->anchor[k].clause = at;
			read_clauses(r, a, k);
		}
	}
}

static int read_record(const struct jsonl *j, const cJSON *o, struct reading_record *r, struct err *e)
{
	const char *target = NULL;

	if (jsonl_name(j, o, "ref", NAME_DATA, 1, &r->ref, e) ||
		jsonl_name(j, o, "room", NAME_DATA, 0, &r->room, e) ||
		jsonl_string(j, o, "target", 1, &target, e) < 0)
		return -1;
	last_lemma(target, r->reading.target);
	read_clauses(&r->reading, o, ROOT);
	return 0;
}

int readings_read(struct reading_set *s, const char *path, struct err *e)
{
	struct jsonl j;
	size_t capacity = 0;
	void *records = NULL;
	cJSON *o;
	int got;

	*s = (struct reading_set){0};
	if (jsonl_open(&j, path, e))
		return -1;
	while ((got = jsonl_next(&j, &o, e)) > 0) {
		struct reading_record r = {0};
		int bad = read_record(&j, o, &r, e) ||
			  mem_grow(&records, &capacity, s->n + 1, sizeof r, j.path, e);
		cJSON_Delete(o);
		s->records = records;
		if (bad) {
			free(r.ref);
			free(r.room);
			got = -1;
			break;
		}
		s->records[s->n++] = r;
	}
	jsonl_close(&j);
	if (got)
		readings_free(s);
	return got;
}

const struct reading_record *readings_find(const struct reading_set *s, const char *ref)
{
	for (size_t i = 0; i < s->n; i++)
		if (!strcmp(s->records[i].ref, ref))
			return &s->records[i];
	return NULL;
}

int readings_fold(const struct reading_record *r, long long folds)
{
	unsigned hash = 0;

	for (const char *p = r->room ? r->room : ""; *p; p++)
		hash = (hash * 31u + (unsigned char)*p) & 0xffff;
	return folds ? (int)(hash % folds) : 0;
}
