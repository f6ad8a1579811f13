/* JSON as it is written, against cJSON. */
#include "base/jsontext.h"
#include "base/rng.h"
#include "unit.h"

#include <cjson/cJSON.h>

/* What put writes; free() it. */
static char *written(void (*put)(struct jsontext *to, const void *what), const void *what, int is_page)
{
	char *text = NULL;
	size_t length;
	struct jsontext to = {.out = open_memstream(&text, &length), .is_page = is_page};

	put(&to, what);
	fclose(to.out);
	return text;
}

static void put_number(struct jsontext *to, const void *x)
{
	jsontext_number(to, NULL, *(const double *)x);
}

static void put_string(struct jsontext *to, const void *text)
{
	jsontext_string(to, NULL, text);
}

static void same(char *text, cJSON *item)
{
	char *theirs = cJSON_PrintUnformatted(item);

	CHECK(!strcmp(text, theirs), "%s is not %s", text, theirs);
	cJSON_Delete(item);
	cJSON_free(theirs);
	free(text);
}

static void values(void)
{
	static const double numbers[] = {
		0, -0.0, 1, -3, 3e9, 1e20, 0.1, 1.0 / 3, 5e-324, 1e-7, NAN, INFINITY};
	static const char *const strings[] = {
		"", "a \"b\" \\ /", "\b\f\n\r\t\x01\x1f\x7f", "</script> \xc3\xa9"};
	struct rng r;

	rng_seed(&r, 1, 1);
	for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
		same(written(put_number, &numbers[i], 0), cJSON_CreateNumber(numbers[i]));
	for (int i = 0; i < 10000; i++) {
		const double x = rng_uniform(&r) * pow(10, i % 40 - 20);
		same(written(put_number, &x, 0), cJSON_CreateNumber(x));
	}
	for (size_t i = 0; i < sizeof strings / sizeof *strings; i++)
		same(written(put_string, strings[i], 0), cJSON_CreateString(strings[i]));
}

static void put_nested(struct jsontext *to, const void *none)
{
	(void)none;
	jsontext_open(to, NULL, '{');
	jsontext_rounded(to, "x", 0.123456);
	jsontext_open(to, "list", '[');
	jsontext_flag(to, NULL, 1);
	jsontext_open(to, NULL, '{');
	jsontext_close(to, '}');
	jsontext_raw(to, NULL, "\"<\"");
	jsontext_close(to, ']');
	jsontext_string(to, "a<b", "<!--");
	jsontext_close(to, '}');
}

static void nesting(void)
{
	char *plain = written(put_nested, NULL, 0), *page = written(put_nested, NULL, 1);

	CHECK(!strcmp(plain, "{\"x\":0.1235,\"list\":[true,{},\"<\"],\"a<b\":\"<!--\"}"), "%s", plain);
	CHECK(!strcmp(page, "{\"x\":0.1235,\"list\":[true,{},\"\\u003c\"],\"a\\u003cb\":\"\\u003c!--\"}"),
		"%s", page);
	free(plain);
	free(page);
}

int main(void)
{
	values();
	nesting();
	return unit_end();
}
