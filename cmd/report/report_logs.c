#include "cmd/report/reporting.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/records/jsonl.h"
#include "formats/arrays/safetensors.h"

#include <stdlib.h>
#include <string.h>

/* Metadata longer than this are lists of sentences and names. */
enum { LONGEST = 300 };

static cJSON *finish(cJSON *list, int is_fine, struct err *e)
{
	if (is_fine && list)
		return list;
	if (is_fine)
		err_set(e, ERR_SYSTEM, "page: out of memory");
	cJSON_Delete(list);
	return NULL;
}

/* The text of RUN/log/STEP or RUN/log/STEP.command; NULL where it is not there. */
static char *read_log(const char *run, const char *step, const char *suffix)
{
	struct err ignored;
	size_t length;
	char *text = NULL, *dir = file_join(run, "log", "", &ignored);
	SCOPED char *path = dir ? file_join(dir, step, suffix, &ignored) : NULL;

	if (!path || !file_exists(path) || file_read(path, &text, &length, &ignored))
		text = NULL;
	free(dir);
	return text;
}

/* "tool: 13.92 s, peak memory 299.8 MiB", the last line that -v writes. */
static int add_cost(cJSON *to, const char *log)
{
	const char *at = NULL;
	double seconds, mib;

	for (const char *next = log; (next = strstr(next, " s, peak memory ")); next++)
		at = next;
	while (at && at > log && at[-1] != ' ')
		at--;
	if (!at || sscanf(at, "%lf s, peak memory %lf MiB", &seconds, &mib) != 2)
		return 1;
	return cJSON_AddNumberToObject(to, "seconds", seconds) && cJSON_AddNumberToObject(to, "mib", mib);
}

cJSON *report_steps(const char *run, struct err *e)
{
	static const char *const steps[] = {"import", "weigh", "paint", "encode", "select", "select3d",
		"lift", "train1", "teach", "train2", "encode3", "render3.train", "render3.test",
		"render3.asked", "render3.whole", "locate", "overlay3", "render1.train", "render1.test",
		"render2.train", "render2.test", "overlay1", "overlay2"};
	cJSON *list = cJSON_CreateArray();
	int fine = 1;

	for (size_t k = 0; k < sizeof steps / sizeof *steps && fine; k++) {
		SCOPED char *log = read_log(run, steps[k], ""),
			    *command = read_log(run, steps[k], ".command");
		cJSON *one = log ? cJSON_CreateObject() : NULL;
		if (log)
			fine = cJSON_AddItemToArray(list, one) &&
			       cJSON_AddStringToObject(one, "step", steps[k]) && add_cost(one, log) &&
			       (!command || cJSON_AddStringToObject(one, "command", command));
	}
	return finish(list, fine, e);
}

/* Adds the numbers of these keys as a list, where the line has the first of them. */
static int add_numbers(cJSON *list, const cJSON *line, const char *const *keys)
{
	cJSON *row = cJSON_CreateArray();
	int fine = row != NULL;

	for (int k = -1; fine && (k < 0 || keys[k]); k++) {
		const char *key = k < 0 ? "iteration" : keys[k];
		const cJSON *value = cJSON_GetObjectItemCaseSensitive(line, key);
		fine = cJSON_AddItemToArray(row,
			cJSON_IsNumber(value) ? cJSON_CreateNumber(value->valuedouble) : cJSON_CreateNull());
	}
	return fine && cJSON_AddItemToArray(list, row);
}

static int read_losses(cJSON *to, const char *path, struct err *e)
{
	static const char *const own[] = {"bce", "contrast", "loss", NULL}, *const held[] = {"held_bce",
										    "held_iou", NULL};
	cJSON *lines = cJSON_AddArrayToObject(to, "lines"), *helds = cJSON_AddArrayToObject(to, "held");
	cJSON *line;
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	int got, fine = 1;

	if (jsonl_open(&j, path, e))
		return -1;
	while ((got = jsonl_next(&j, &line, e)) > 0 && fine) {
		const int is_held = cJSON_HasObjectItem(line, "held_iou");
		fine = add_numbers(is_held ? helds : lines, line, is_held ? held : own);
		cJSON_Delete(line);
	}
	return fine ? got : err_set(e, ERR_SYSTEM, "page: out of memory");
}

cJSON *report_losses(const char *run, struct err *e)
{
	static const char *const stages[] = {"stage1", "stage2"};
	cJSON *list = cJSON_CreateArray();

	for (size_t k = 0; k < 2; k++) {
		char *dir = file_join(run, stages[k], "", e),
		     *path = dir ? file_join(dir, "train.log", "", e) : NULL;
		cJSON *one = path && file_exists(path) ? cJSON_CreateObject() : NULL;
		const int bad = one && (!cJSON_AddItemToArray(list, one) ||
					       !cJSON_AddStringToObject(one, "stage", stages[k]) ||
					       read_losses(one, path, e));
		free(path);
		free(dir);
		if (bad)
			return finish(list, 0, e);
	}
	return finish(list, 1, e);
}

static int add_metadata(cJSON *to, const char *path, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};
	int fine = 1;

	if (safetensors_open(&st, path, e))
		return 0;
	for (size_t k = 0; k < st.meta_count && fine; k++) {
		const struct st_meta *m = &st.meta[k];
		if (strncmp(m->key, "crc32.", 6) && strlen(m->value) <= LONGEST)
			fine = cJSON_AddStringToObject(to, m->key, m->value) != NULL;
	}
	if (!fine)
		err_set(e, ERR_SYSTEM, "page: out of memory");
	return fine;
}

cJSON *report_settings(const char *run, struct err *e)
{
	static const char *const files[] = {"scene/splats.safetensors", "text.safetensors",
		"lifted/asked.safetensors", "lifted/model.safetensors", "stage1/model.safetensors",
		"stage2/model.safetensors"};
	cJSON *list = cJSON_CreateArray();
	int fine = 1;

	for (size_t k = 0; k < sizeof files / sizeof *files && fine; k++) {
		SCOPED char *path = file_join(run, files[k], "", e);
		cJSON *one = path && file_exists(path) ? cJSON_CreateObject() : NULL;
		if (one)
			fine = cJSON_AddItemToArray(list, one) &&
			       cJSON_AddStringToObject(one, "file", files[k]) &&
			       add_metadata(cJSON_AddObjectToObject(one, "metadata"), path, e);
	}
	return finish(list, fine, e);
}
