#include "cmd/serve/serving.h"

#include "base/mem.h"
#include "formats/records/json.h"

enum { LINE_MOST = 1 << 20 /* bytes */ };

static void put_error(FILE *out, const char *why)
{
	fputs("{\"error\":", out);
	jsontext_quote(out, why);
	fputs("}\n", out);
}

/* Bytes that are no JSON have no place in a line: pictures and splats. */
static int answer(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e)
{
	const char *what;

	if (json_string(body, "do", 1, &what, "request", e) < 0)
		return -1;
	if (!strcmp(what, "view") || !strcmp(what, "splats"))
		return err_set(e, ERR_CHECK, "'%s' is for HTTP alone", what);
	return serving_answer(s, what, body, 1, to, e);
}

static void answer_line(struct serving *s, char *line, size_t length, FILE *out)
{
	struct serving_reply reply = {0};
	struct err e;
	SCOPED_BY(json_release)
	cJSON *body = length > LINE_MOST ? NULL : json_parse(line, length, "request", &e);

	if (length > LINE_MOST)
		put_error(out, "request: longer than a megabyte");
	else if (!body || answer(s, body, &reply, &e))
		put_error(out, e.message);
	else
		fwrite(reply.bytes, 1, reply.length, out);
	free(reply.bytes);
}

int serving_lines(struct serving *s, FILE *out, struct err *e)
{
	char *line = NULL;
	size_t room = 0;
	ssize_t n;

	while ((n = getline(&line, &room, stdin)) > 0) {
		if (line[strspn(line, " \t\r\n")])
			answer_line(s, line, (size_t)n, out);
		if (fflush(out))
			break;
	}
	const int bad = ferror(out) ? err_errno(e, "stdout") : ferror(stdin) ? err_errno(e, "stdin") : 0;
	free(line);
	return bad;
}
