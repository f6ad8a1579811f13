/* HTTP by libmicrohttpd, a thread a connection, of which there are few at a time. A request is looked at
 * before its body is taken: that it names this server (a page that renamed its own address to this machine's
 * does not), that no other page of the browser sent it, that its path is one of a few and its body short. No
 * path of a request is one of the file system. */
#include "cmd/serve/serving.h"

#include "base/embed.h"
#include "base/mem.h"
#include "cmd/report/reporting.h"
#include "formats/records/json.h"

#include <arpa/inet.h>
#include <microhttpd.h>
#include <signal.h>

enum { CONNECTIONS = 64, BODY_MOST = 1 << 20, SECONDS_IDLE = 20, SECONDS_BODY = 60, TOKEN_BYTES = 16 };

#define POLICY                                                                                                                \
	"default-src 'none'; script-src 'self' 'wasm-unsafe-eval' blob:; style-src 'self' 'unsafe-inline'; "                  \
	"img-src 'self' blob: data:; connect-src 'self' blob: data:; worker-src blob:; base-uri 'none'; form-action 'none'; " \
	"frame-ancestors 'none'"

EMBED(serve_page, "cmd/serve/page.html");
EMBED(serve_script, "cmd/serve/page.js");
extern const char serve_page_begin[], serve_script_begin[];

struct server {
	struct serving *serving;
	const char *address;
	int port, is_local;
	char token[2 * TOKEN_BYTES + 1];
};

struct request {
	char *body;
	size_t length, room;
	struct timespec start;
};

static enum MHD_Result reply(struct MHD_Connection *c, unsigned status, const char *type, const char *cache,
	void *bytes, size_t n, enum MHD_ResponseMemoryMode mode)
{
	struct MHD_Response *r = MHD_create_response_from_buffer(n, bytes, mode);

	if (!r)
		return MHD_NO;
	MHD_add_response_header(r, "Content-Type", type);
	MHD_add_response_header(r, "Cache-Control", cache);
	MHD_add_response_header(r, "X-Content-Type-Options", "nosniff");
	MHD_add_response_header(r, "Referrer-Policy", "no-referrer");
	MHD_add_response_header(r, "Cross-Origin-Resource-Policy", "same-origin");
	MHD_add_response_header(r, "Content-Security-Policy", POLICY);
	const enum MHD_Result sent = MHD_queue_response(c, status, r);
	MHD_destroy_response(r);
	return sent;
}

static enum MHD_Result refuse(struct MHD_Connection *c, unsigned status, const char *why)
{
	struct serving_text text;
	struct serving_reply got;
	struct err e;

	if (serving_text_open(&text, &e))
		return MHD_NO;
	fputs("{\"error\":", text.out);
	jsontext_quote(text.out, why);
	fputs("}\n", text.out);
	if (serving_text_end(&text, 0, &got, &e))
		return MHD_NO;
	return reply(c, status, got.type, "no-store", got.bytes, got.length, MHD_RESPMEM_MUST_FREE);
}

/* Whether a host, with a port or without, is this server's. Not on this machine alone, it is one by any
 * number. */
static int is_own_host(const struct server *s, const char *host)
{
	static const char *const own[] = {"127.0.0.1", "localhost", "[::1]"};
	char name[64], port[16];
	const char *colon = strrchr(host, ':'), *bracket = strrchr(host, ']');
	const size_t length = colon && (!bracket || colon > bracket) ? (size_t)(colon - host) : strlen(host);
	unsigned char number[16];

	if (length >= sizeof name)
		return 0;
	snprintf(name, sizeof name, "%.*s", (int)length, host);
	snprintf(port, sizeof port, ":%d", s->port);
	if (host[length] ? strcmp(host + length, port) != 0 : s->port != 80)
		return 0;
	for (size_t k = 0; k < sizeof own / sizeof *own; k++)
		if (!strcmp(name, own[k]))
			return 1;
	if (!strcmp(name, s->address))
		return 1;
	return !s->is_local && (inet_pton(AF_INET, name, number) == 1 || *name == '[');
}

/* Why a request is not served, with its status; NULL: it is. */
static const char *find_fault(const struct server *s, struct MHD_Connection *c, unsigned *status)
{
	const char *host = MHD_lookup_connection_value(c, MHD_HEADER_KIND, "Host");
	const char *origin = MHD_lookup_connection_value(c, MHD_HEADER_KIND, "Origin");
	const char *site = MHD_lookup_connection_value(c, MHD_HEADER_KIND, "Sec-Fetch-Site");
	const char *length = MHD_lookup_connection_value(c, MHD_HEADER_KIND, "Content-Length");

	*status = MHD_HTTP_FORBIDDEN;
	if (!host || !is_own_host(s, host))
		return "the Host is not this server's";
	if (origin && (strncmp(origin, "http://", 7) != 0 || !is_own_host(s, origin + 7)))
		return "another page's Origin";
	if (site && strcmp(site, "same-origin") != 0 && strcmp(site, "none") != 0)
		return "another page's request";
	*status = MHD_HTTP_CONTENT_TOO_LARGE;
	return length && strtoull(length, NULL, 10) > BODY_MOST ? "the body is longer than a megabyte" : NULL;
}

static int may_write(const struct server *s, struct MHD_Connection *c)
{
	const char *given = MHD_lookup_connection_value(c, MHD_HEADER_KIND, "Authorization");
	unsigned char differs = 0;

	if (!given || strncmp(given, "Bearer ", 7) != 0 || strlen(given + 7) != 2 * TOKEN_BYTES)
		return 0;
	for (int k = 0; k < 2 * TOKEN_BYTES; k++)
		differs |= (unsigned char)(given[7 + k] ^ s->token[k]);
	return !differs;
}

/* What stands behind a path's "?", as a body: a key that is there twice is a list. */
static enum MHD_Result take_argument(void *data, enum MHD_ValueKind kind, const char *key, const char *value)
{
	cJSON *body = data, *earlier = json_get(body, key), *item = cJSON_CreateString(value ? value : "");

	(void)kind;
	if (earlier && !cJSON_IsArray(earlier)) {
		earlier = cJSON_DetachItemViaPointer(body, earlier);
		cJSON *list = cJSON_AddArrayToObject(body, key);
		cJSON_AddItemToArray(list, earlier);
		earlier = list;
	}
	if (earlier)
		cJSON_AddItemToArray(earlier, item);
	else
		cJSON_AddItemToObject(body, key, item);
	return MHD_YES;
}

static unsigned status_of(const struct err *e)
{
	switch (e->code) {
	case ERR_CHECK:
		return MHD_HTTP_NOT_FOUND;
	case ERR_USAGE:
		return MHD_HTTP_FORBIDDEN;
	case ERR_FORMAT:
		return MHD_HTTP_BAD_REQUEST;
	default:
		return MHD_HTTP_INTERNAL_SERVER_ERROR;
	}
}

static enum MHD_Result answer(const struct server *s, struct MHD_Connection *c, const char *what, int is_post,
	const struct request *r)
{
	struct err e = {ERR_SYSTEM, "request: out of memory"};
	struct serving_reply got = {0};
	SCOPED_BY(json_release)
	cJSON *body =
		is_post ? json_parse(r->body ? r->body : "", r->length, "request", &e) : cJSON_CreateObject();

	if (!is_post && body)
		MHD_get_connection_values(c, MHD_GET_ARGUMENT_KIND, take_argument, body);
	if (body && !cJSON_IsObject(body))
		return refuse(c, MHD_HTTP_BAD_REQUEST, "request: not a JSON object");
	if (!body || serving_answer(s->serving, what, body, may_write(s, c), &got, &e)) {
		free(got.bytes);
		return refuse(c, status_of(&e), e.message);
	}
	return reply(c, MHD_HTTP_OK, got.type, !strcmp(what, "view") ? "private, max-age=3600" : "no-store",
		got.bytes, got.length, MHD_RESPMEM_MUST_FREE);
}

static enum MHD_Result send_text(struct MHD_Connection *c, const char *type, const char *text)
{
	return reply(c, MHD_HTTP_OK, type, "no-store", (void *)(uintptr_t)text, strlen(text),
		MHD_RESPMEM_PERSISTENT);
}

static enum MHD_Result send_module(const struct server *s, struct MHD_Connection *c, const char *name)
{
	for (size_t k = 0; k < REPORT_MODULES && s->serving->viewer; k++) {
		struct err e;
		char *bytes = NULL;
		size_t n;
		if (strcmp(name, report_modules[k].file) != 0)
			continue;
		SCOPED char *path = file_join(s->serving->viewer, report_modules[k].file, "", &e);
		if (!path || file_read(path, &bytes, &n, &e))
			return refuse(c, MHD_HTTP_INTERNAL_SERVER_ERROR, e.message);
		return reply(c, MHD_HTTP_OK, "text/javascript", "private, max-age=3600", bytes, n,
			MHD_RESPMEM_MUST_FREE);
	}
	return refuse(c, MHD_HTTP_NOT_FOUND, "no such module: 'make viewer' fetches them");
}

static enum MHD_Result route(const struct server *s, struct MHD_Connection *c, const char *path,
	const char *method, const struct request *r)
{
	static const char *const posts[] = {"/v1/ask", "/v1/pick", "/v1/label"};
	int wants_post = 0;

	for (size_t k = 0; k < sizeof posts / sizeof *posts; k++)
		wants_post |= !strcmp(path, posts[k]);
	const int is_post = !strcmp(method, MHD_HTTP_METHOD_POST),
		  is_get = !strcmp(method, MHD_HTTP_METHOD_GET) || !strcmp(method, MHD_HTTP_METHOD_HEAD);
	if (wants_post ? !is_post : !is_get)
		return refuse(c, MHD_HTTP_METHOD_NOT_ALLOWED,
			wants_post ? "POST is what this takes" : "GET is what this takes");
	if (!strncmp(path, "/v1/", 4))
		return answer(s, c, path + 4, is_post, r);
	if (!strcmp(path, "/"))
		return send_text(c, "text/html; charset=utf-8", serve_page_begin);
	if (!strcmp(path, "/page.js"))
		return send_text(c, "text/javascript; charset=utf-8", serve_script_begin);
	if (!strcmp(path, "/viewer.js"))
		return send_text(c, "text/javascript; charset=utf-8", report_viewer_begin);
	if (!strncmp(path, "/modules/", 9))
		return send_module(s, c, path + 9);
	return refuse(c, MHD_HTTP_NOT_FOUND, "nothing here");
}

/* A part of the body. A client that takes long over it, or whose body is too long, is cut off. */
static enum MHD_Result take_body(struct request *r, const char *data, size_t n)
{
	struct timespec now;
	struct err e;

	clock_gettime(CLOCK_MONOTONIC, &now);
	if (r->length + n > BODY_MOST || now.tv_sec - r->start.tv_sec > SECONDS_BODY ||
		mem_grow((void **)&r->body, &r->room, r->length + n + 1, 1, "request", &e))
		return MHD_NO;
	memcpy(r->body + r->length, data, n);
	r->length += n;
	r->body[r->length] = 0;
	return MHD_YES;
}

static enum MHD_Result handle(void *data, struct MHD_Connection *c, const char *path, const char *method,
	const char *version, const char *upload, size_t *upload_size, void **own)
{
	const struct server *s = data;
	struct request *r = *own;
	unsigned status;
	struct err e;

	(void)version;
	if (!r) {
		const char *fault = find_fault(s, c, &status);
		if (fault)
			return refuse(c, status, fault);
		if (!(*own = r = mem_zalloc(1, sizeof *r, "request", &e)))
			return MHD_NO;
		clock_gettime(CLOCK_MONOTONIC, &r->start);
		return MHD_YES;
	}
	if (*upload_size) {
		const size_t n = *upload_size;
		*upload_size = 0;
		return take_body(r, upload, n);
	}
	return route(s, c, path, method, r);
}

static void finish(void *data, struct MHD_Connection *c, void **own, enum MHD_RequestTerminationCode why)
{
	struct request *r = *own;

	(void)data, (void)c, (void)why;
	if (r)
		free(r->body);
	free(r);
	*own = NULL;
}

static int make_token(struct server *s, struct err *e)
{
	unsigned char bytes[TOKEN_BYTES];
	FILE *in = fopen("/dev/urandom", "rb");
	const int bad = !in || fread(bytes, 1, sizeof bytes, in) != sizeof bytes;

	if (in)
		fclose(in);
	for (int k = 0; k < TOKEN_BYTES && !bad; k++)
		snprintf(s->token + 2 * k, 3, "%02x", bytes[k]);
	return bad ? err_errno(e, "/dev/urandom") : 0;
}

static struct MHD_Daemon *start(struct server *s, int port, struct err *e)
{
	struct sockaddr_in four = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
	struct sockaddr_in6 six = {.sin6_family = AF_INET6, .sin6_port = htons((uint16_t)port)};
	const int is_six = inet_pton(AF_INET6, s->address, &six.sin6_addr) == 1;

	if (!is_six && inet_pton(AF_INET, s->address, &four.sin_addr) != 1) {
		err_set(e, ERR_USAGE, "--address: '%s' is no number of an interface, such as 127.0.0.1",
			s->address);
		return NULL;
	}
	s->is_local =
		is_six ? IN6_IS_ADDR_LOOPBACK(&six.sin6_addr) : ntohl(four.sin_addr.s_addr) >> 24 == 127;
	struct MHD_Daemon *d =
		MHD_start_daemon(MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION |
					 (is_six ? MHD_USE_IPv6 : 0u),
			(uint16_t)port, NULL, NULL, handle, s, MHD_OPTION_SOCK_ADDR,
			is_six ? (struct sockaddr *)&six : (struct sockaddr *)&four,
			MHD_OPTION_CONNECTION_LIMIT, (unsigned)CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT,
			(unsigned)SECONDS_IDLE, MHD_OPTION_NOTIFY_COMPLETED, finish, NULL, MHD_OPTION_END);
	if (!d)
		err_errno(e, "%s port %d", s->address, port);
	return d;
}

int serving_http(struct serving *serving, const struct serving_http *at, FILE *out, struct err *e)
{
	struct server s = {.serving = serving, .address = at->address};
	sigset_t ends;
	int got;

	sigemptyset(&ends);
	sigaddset(&ends, SIGINT);
	sigaddset(&ends, SIGTERM);
	struct MHD_Daemon *d = make_token(&s, e) ? NULL : start(&s, at->port, e);
	if (!d)
		return -1;
	s.port = MHD_get_daemon_info(d, MHD_DAEMON_INFO_BIND_PORT)->port;
	if (!s.is_local)
		report_warn(serving->to, "--address %s: whoever reaches this machine can ask the scene",
			at->address);
	fprintf(out, strchr(at->address, ':') ? "http://[%s]:%d/#%s\n" : "http://%s:%d/#%s\n", at->address,
		s.port, s.token);
	if (fflush(out)) {
		MHD_stop_daemon(d);
		return err_errno(e, "stdout");
	}
	serving_labels_look(serving);
	sigwait(&ends, &got);
	MHD_stop_daemon(d);
	return 0;
}
