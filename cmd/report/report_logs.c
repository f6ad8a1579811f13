#include "cmd/report/reporting.h"

#include "base/file.h"
#include "base/mem.h"
#include "formats/records/json.h"
#include "formats/records/jsonl.h"
#include "formats/arrays/safetensors.h"

#include <math.h>

/* Metadata longer than this are lists of sentences and names. */
enum { LONGEST = 300 };

/* The text of RUN/log/STEP or RUN/log/STEP.command; NULL where it is not there. */
static char *read_log(const char *run, const char *step, const char *suffix)
{
	struct err ignored;
	size_t length;
	char *text = NULL;
	SCOPED char *dir = file_join(run, "log", "", &ignored),
		    *path = dir ? file_join(dir, step, suffix, &ignored) : NULL;

	if (!path || !file_exists(path) || file_read(path, &text, &length, &ignored))
		text = NULL;
	return text;
}

/* "tool: 13.92 s, peak memory 299.8 MiB", the last line that -v writes. */
static void put_cost(struct jsontext *to, const char *log)
{
	const char *at = NULL;
	double seconds, mib;

	for (const char *next = log; (next = strstr(next, " s, peak memory ")); next++)
		at = next;
	while (at && at > log && at[-1] != ' ')
		at--;
	if (!at || sscanf(at, "%lf s, peak memory %lf MiB", &seconds, &mib) != 2)
		return;
	jsontext_number(to, "seconds", seconds);
	jsontext_number(to, "mib", mib);
}

void report_steps(struct jsontext *to, const char *run)
{
	static const char *const steps[] = {"import", "weigh", "paint", "encode", "select", "select3d",
		"lift", "train1", "teach", "train2", "encode3", "render3.train", "render3.test",
		"render3.asked", "render3.whole", "locate", "overlay3", "render1.train", "render1.test",
		"render2.train", "render2.test", "overlay1", "overlay2"};

	jsontext_open(to, "steps", '[');
	for (size_t k = 0; k < sizeof steps / sizeof *steps; k++) {
		SCOPED char *log = read_log(run, steps[k], ""),
			    *command = read_log(run, steps[k], ".command");
		if (!log)
			continue;
		jsontext_open(to, NULL, '{');
		jsontext_string(to, "step", steps[k]);
		put_cost(to, log);
		if (command)
			jsontext_string(to, "command", command);
		jsontext_close(to, '}');
	}
	jsontext_close(to, ']');
}

/* A list of these numbers of each line. */
static int put_lines(
	struct jsontext *to, const char *name, const char *path, const char *const *keys, struct err *e)
{
	SCOPED_BY(jsonl_close) struct jsonl j = {0};
	cJSON *line;
	int got;

	if (jsonl_open(&j, path, e))
		return -1;
	jsontext_open(to, name, '[');
	while ((got = jsonl_next(&j, &line, e)) > 0) {
		jsontext_open(to, NULL, '[');
		for (const char *const *key = keys; *key; key++) {
			const cJSON *value = json_get(line, *key);
			jsontext_number(to, NULL, cJSON_IsNumber(value) ? value->valuedouble : NAN);
		}
		jsontext_close(to, ']');
		cJSON_Delete(line);
	}
	jsontext_close(to, ']');
	return got;
}

int report_losses(struct jsontext *to, const char *run, struct err *e)
{
	static const char *const stages[] = {"stage1", "stage2"},
				 *const logs[] = {"stage1/train.log", "stage2/train.log"},
				 *const own[] = {"iteration", "bce", "contrast", "loss", NULL};

	jsontext_open(to, "losses", '[');
	for (size_t k = 0; k < 2; k++) {
		SCOPED char *path = file_find(run, logs[k], e);
		if (!path)
			continue;
		jsontext_open(to, NULL, '{');
		jsontext_string(to, "stage", stages[k]);
		if (put_lines(to, "lines", path, own, e))
			return -1;
		jsontext_close(to, '}');
	}
	jsontext_close(to, ']');
	return 0;
}

static int put_metadata(struct jsontext *to, const char *path, struct err *e)
{
	SCOPED_BY(safetensors_close) struct safetensors st = {0};

	if (safetensors_open(&st, path, e))
		return -1;
	jsontext_open(to, "metadata", '{');
	for (size_t k = 0; k < st.meta_count; k++)
		if (strncmp(st.meta[k].key, "crc32.", 6) && strlen(st.meta[k].value) <= LONGEST)
			jsontext_string(to, st.meta[k].key, st.meta[k].value);
	jsontext_close(to, '}');
	return 0;
}

int report_settings(struct jsontext *to, const char *run, struct err *e)
{
	static const char *const files[] = {"scene/splats.safetensors", "text.safetensors",
		"lifted/asked.safetensors", "lifted/model.safetensors", "stage1/model.safetensors",
		"stage2/model.safetensors"};

	jsontext_open(to, "settings", '[');
	for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
		SCOPED char *path = file_find(run, files[k], e);
		if (!path)
			continue;
		jsontext_open(to, NULL, '{');
		jsontext_string(to, "file", files[k]);
		if (put_metadata(to, path, e))
			return -1;
		jsontext_close(to, '}');
	}
	jsontext_close(to, ']');
	return 0;
}
