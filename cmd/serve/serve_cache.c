#include "cmd/serve/serving.h"

#include "base/hash.h"
#include "base/mem.h"

static struct serving_cached *find_cached(struct serving *s, const char *key)
{
	return &s->answers[hash64(key, strlen(key), 0) % SERVING_ANSWERS];
}

void serving_forget(struct serving *s)
{
	for (struct serving_cached *c = s->answers; c < s->answers + SERVING_ANSWERS; c++) {
		mem_free_all(c->key, c->bytes);
		*c = (struct serving_cached){0};
	}
}

int serving_recall(struct serving *s, const char *key, struct serving_reply *to, struct err *e)
{
	int found;

	pthread_mutex_lock(&s->lock);
	const struct serving_cached *c = find_cached(s, key);
	found = c->key && !strcmp(c->key, key);
	if (found) {
		*to = (struct serving_reply){"application/json", mem_strdup(c->bytes, e), c->length};
		found = to->bytes ? 1 : -1;
	}
	pthread_mutex_unlock(&s->lock);
	return found;
}

void serving_remember(struct serving *s, const char *key, const struct serving_reply *reply)
{
	struct err e;
	struct serving_cached *c = find_cached(s, key);
	const struct serving_cached now = {mem_strdup(key, &e), mem_strdup(reply->bytes, &e), reply->length};

	pthread_mutex_lock(&s->lock);
	mem_free_all(c->key, c->bytes);
	*c = now;
	if (!now.key || !now.bytes) {
		mem_free_all(now.key, now.bytes);
		*c = (struct serving_cached){0};
	}
	pthread_mutex_unlock(&s->lock);
}
