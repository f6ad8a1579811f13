#include "formats/fingerprint.h"

#include "base/hash.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static struct fingerprint fingerprint_of(uint64_t hash)
{
	struct fingerprint f;

	snprintf(f.hex, sizeof f.hex, "%016" PRIx64, hash);
	return f;
}

struct fingerprint fingerprint_scene(const float *means, size_t n)
{
	return fingerprint_of(hash64(means, 3 * n * sizeof *means, 0));
}

struct fingerprint fingerprint_camera(const struct camera *c)
{
	double numbers[6 + 16] = {c->width, c->height, c->fx, c->fy, c->cx, c->cy};

	memcpy(numbers + 6, c->world_to_camera, sizeof c->world_to_camera);
	for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
		numbers[i] += 0.0; /* -0 becomes 0 */
	return fingerprint_of(hash64(numbers, sizeof numbers, 0));
}

struct fingerprint fingerprint_encoder(const struct bert *b, const struct vocab *v, int is_static)
{
	const int64_t sizes[] = {b->words, b->positions, b->types, b->body.width, b->body.heads,
		b->body.inner, b->body.layer_count, (int64_t)b->body.activation, is_static};
	uint64_t vocabulary = 0;

	/* A sum, as the order in which a file lists its tokens means nothing. */
	for (size_t i = 0; i < v->n; i++)
		vocabulary +=
			hash64(v->entries[i].token, strlen(v->entries[i].token), (uint64_t)v->entries[i].id);
	uint64_t hash = hash64(sizes, sizeof sizes, 0);
	hash = hash64(&b->body.eps, sizeof b->body.eps, hash);
	hash = bert_hash(b, hash);
	return fingerprint_of(hash64(&vocabulary, sizeof vocabulary, hash));
}

int fingerprint_read(struct fingerprint *f, const struct safetensors *st, const char *key, struct err *e)
{
	const char *text = safetensors_meta(st, key);

	*f = (struct fingerprint){""};
	if (!text)
		return 0;
	if (strlen(text) != sizeof f->hex - 1 || strspn(text, "0123456789abcdef") != sizeof f->hex - 1)
		return err_set(e, ERR_FORMAT, "%s: metadata '%s' is '%s', not 16 hexadecimal digits",
			st->path, key, text);
	memcpy(f->hex, text, sizeof f->hex);
	return 0;
}

int origin_read(struct origin *o, const struct safetensors *st, struct err *e)
{
	return fingerprint_read(&o->scene, st, "scene", e) || fingerprint_read(&o->encoder, st, "encoder", e)
		       ? -1
		       : 0;
}

const char *fingerprint_text(const struct fingerprint *f)
{
	return *f->hex ? f->hex : NULL;
}

int fingerprint_check(const char *what, const char *path, const struct fingerprint *mine, const char *other,
	const struct fingerprint *theirs, struct err *e)
{
	if (!*mine->hex || !*theirs->hex || !strcmp(mine->hex, theirs->hex))
		return 0;
	return err_set(e, ERR_FORMAT, "%s: is of another %s than %s (%s, not %s)", path, what, other,
		mine->hex, theirs->hex);
}
