#include "formats/encoders/vocab.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/utf8.h"
#include "formats/records/json.h"

#include <math.h>
#include <stdio.h>

/* A member that, if it is there at all, must be true. */
static int need_flag(const cJSON *object, const char *key, const char *path, const char *where, struct err *e)
{
	const cJSON *item = json_get(object, key);

	if (!item || cJSON_IsNull(item) || cJSON_IsTrue(item))
		return 0;
	return err_file(e, path, "%s: '%s' is not true: only uncased BERT tokenizers are read", where, key);
}

/* A member that must be this string; `may_miss` allows it to be absent. */
static int need_string(const cJSON *object, const char *key, const char *wanted, int may_miss,
	const char *path, const char *where, struct err *e)
{
	const cJSON *item = json_get(object, key);

	if ((may_miss && !item) || json_is(item, wanted))
		return 0;
	return err_file(
		e, path, "%s: '%s' is not \"%s\": only uncased BERT tokenizers are read", where, key, wanted);
}

static int check_kind(const cJSON *root, const char *path, struct err *e)
{
	const cJSON *normalizer = json_get(root, "normalizer");
	const cJSON *splitter = json_get(root, "pre_tokenizer");
	const cJSON *model = json_get(root, "model");
	const cJSON *longest = json_get(model, "max_input_chars_per_word");

	if (need_string(normalizer, "type", "BertNormalizer", 0, path, "normalizer", e) ||
		need_flag(normalizer, "clean_text", path, "normalizer", e) ||
		need_flag(normalizer, "handle_chinese_chars", path, "normalizer", e) ||
		need_flag(normalizer, "strip_accents", path, "normalizer", e) ||
		need_flag(normalizer, "lowercase", path, "normalizer", e) ||
		need_string(splitter, "type", "BertPreTokenizer", 0, path, "pre_tokenizer", e) ||
		need_string(model, "type", "WordPiece", 1, path, "model", e) ||
		need_string(model, "unk_token", "[UNK]", 1, path, "model", e) ||
		need_string(model, "continuing_subword_prefix", "##", 1, path, "model", e))
		return -1;
	if (longest && longest->valuedouble != WORDPIECE_LONGEST)
		return err_file(e, path, "model: 'max_input_chars_per_word' is not %d", WORDPIECE_LONGEST);
	return 0;
}

static int add_token(struct vocab *v, const char *token, double id, const char *path, struct err *e)
{
	if (utf8_check(token, strlen(token)) < strlen(token))
		return err_file(e, path, "token with id %.0f is not UTF-8", id);
	if (!(id >= 0 && id < INT32_MAX) || id != floor(id))
		return err_file(e, path, "token '%s': its id is not a whole number from 0", token);
	int added = vocab_add(v, token, (int32_t)id, e);
	return added > 0 ? err_file(e, path, "token '%s' appears twice", token) : added;
}

int vocab_add_all(struct vocab *v, const cJSON *tokens, const char *path, struct err *e)
{
	const cJSON *entry;
	int bad = 0;

	for (entry = tokens->child; entry && !bad; entry = entry->next)
		bad = add_token(v, entry->string, cJSON_IsNumber(entry) ? entry->valuedouble : -1, path, e);
	return bad;
}

static int read_tokenizer(struct vocab *v, const char *path, struct err *e)
{
	SCOPED_BY(json_release) cJSON *root = json_read(path, e);

	if (!root || check_kind(root, path, e))
		return -1;
	const cJSON *tokens = json_get(json_get(root, "model"), "vocab");
	return cJSON_IsObject(tokens) ? vocab_add_all(v, tokens, path, e)
				      : err_file(e, path, "model: 'vocab' is not an object");
}

/* One token a line; its id is the line's number from 0. */
static int read_list(struct vocab *v, const char *path, struct err *e)
{
	SCOPED char *text = NULL;
	size_t len, line = 0;
	int bad = 0;

	if (file_read(path, &text, &len, e))
		return -1;
	if (strlen(text) < len)
		bad = err_file(e, path, "a NUL byte at offset %zu", strlen(text));
	for (char *at = text, *next; *at && !bad; at = next, line++) {
		size_t size = strcspn(at, "\n");
		next = at + size + (at[size] == '\n');
		at[size] = 0;
		if (size && at[size - 1] == '\r')
			at[size - 1] = 0;
		if (utf8_check(at, strlen(at)) < strlen(at))
			bad = err_set(e, ERR_FORMAT, "%s:%zu: not UTF-8", path, line + 1);
		else if ((bad = vocab_add(v, at, (int32_t)line, e)) > 0)
			bad = err_set(e, ERR_FORMAT, "%s:%zu: token '%s' appears twice", path, line + 1, at);
	}
	return bad;
}

/* tokenizer_config.json says of a vocab.txt whether it is cased. */
static int check_config(const char *dir, struct err *e)
{
	SCOPED char *path = file_join(dir, "tokenizer_config.json", "", e);

	if (!path || !file_exists(path))
		return path ? 0 : -1;
	SCOPED_BY(json_release) cJSON *root = json_read(path, e);
	return -(!root || need_flag(root, "do_lower_case", path, "tokenizer", e) ||
		 need_flag(root, "strip_accents", path, "tokenizer", e) ||
		 need_flag(root, "tokenize_chinese_chars", path, "tokenizer", e));
}

int vocab_read(struct vocab *v, const char *dir, struct err *e)
{
	SCOPED char *json = file_join(dir, "tokenizer.json", "", e),
		    *list = file_join(dir, "vocab.txt", "", e);
	const char *missing, *path = json;
	int bad = -1;

	*v = (struct vocab){0};
	if (!json || !list)
		return -1;
	if (file_exists(json)) {
		bad = read_tokenizer(v, json, e);
	} else if (file_exists(list)) {
		path = list;
		bad = read_list(v, list, e) || check_config(dir, e);
	} else if (!file_is_dir(dir)) {
		err_errno(e, "%s", dir);
	} else {
		err_set(e, ERR_SYSTEM, "%s: has neither tokenizer.json nor vocab.txt", dir);
	}
	if (!bad && (missing = vocab_finish(v)))
		bad = err_file(e, path, "token '%s' is missing", missing);
	return bad ? -1 : 0;
}

char *vocab_print(const struct vocab *v, const int32_t *ids, size_t n, struct err *e)
{
	char *text = NULL;
	size_t length;
	FILE *stream = open_memstream(&text, &length);

	for (size_t i = 0; stream && i < n; i++)
		fprintf(stream, "%s%s", i ? " " : "", vocab_token(v, ids[i]));
	return mem_text_end(stream, &text, 0, "pieces", e);
}
