#include "formats/arrays/fingerprint.h"

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

struct fingerprint fingerprint_scene(const struct splats *s)
{
	const uint64_t hash = hash64(s->means, 3 * s->n * sizeof *s->means, 0);

	return fingerprint_of(s->near == SPLATS_NEAR ? hash : hash64(&s->near, sizeof s->near, hash));
}

struct fingerprint fingerprint_camera(const struct camera *c)
{
	double numbers[6 + 16 + 1] = {c->width, c->height, c->fx, c->fy, c->cx, c->cy};
	const size_t n = 6 + 16 + (c->has_time ? 1 : 0);

	memcpy(numbers + 6, c->world_to_camera, sizeof c->world_to_camera);
	numbers[6 + 16] = c->time;
	for (size_t i = 0; i < n; i++)
		numbers[i] += 0.0; /* -0 becomes 0 */
	return fingerprint_of(hash64(numbers, n * sizeof *numbers, 0));
}

/* A sum, as the order in which a file lists its tokens means nothing. */
static uint64_t hash_vocabulary(const struct vocab *v)
{
	uint64_t sum = 0;

	for (size_t i = 0; i < v->n; i++)
		sum += hash64(v->entries[i].token, strlen(v->entries[i].token), (uint64_t)v->entries[i].id);
	return sum;
}

/* The same of merges, wherever the table has them. */
static uint64_t hash_merges(const struct bpe *b)
{
	uint64_t sum = 0;

	for (size_t i = 0; i < b->slots; i++)
		if (b->table[i].left >= 0) {
			const struct bpe_merge *m = &b->table[i];
			const int64_t merge[] = {m->left, m->right, m->id, m->rank};
			sum += hash64(merge, sizeof merge, 0);
		}
	return sum;
}

struct fingerprint fingerprint_encoder(
	const struct text_tower *t, const struct vocab *v, const struct bpe *merges, int is_static)
{
	const struct transformer *body = &t->body;
	const int64_t sizes[] = {t->words, t->positions, body->is_norm_first ? t->projected : t->types,
		body->width, body->heads, body->inner, body->layer_count, (int64_t)body->activation,
		is_static};
	const uint64_t vocabulary[] = {hash_vocabulary(v), merges ? hash_merges(merges) : 0};
	const uint64_t seed = hash64(&body->eps, sizeof body->eps, hash64(sizes, sizeof sizes, 0));

	return fingerprint_of(
		hash64(vocabulary, (merges ? 2 : 1) * sizeof *vocabulary, text_tower_hash(t, seed)));
}

int fingerprint_read(struct fingerprint *f, const struct safetensors *st, const char *key, struct err *e)
{
	const char *text = safetensors_meta(st, key);

	*f = (struct fingerprint){""};
	if (!text)
		return 0;
	if (strlen(text) != sizeof f->hex - 1 || strspn(text, "0123456789abcdef") != sizeof f->hex - 1)
		return err_file(e, st->path, "metadata '%s' is '%s', not 16 hexadecimal digits", key, text);
	memcpy(f->hex, text, sizeof f->hex);
	return 0;
}

int origin_read(struct origin *o, const struct safetensors *st, struct err *e)
{
	return -(fingerprint_read(&o->scene, st, "scene", e) ||
		 fingerprint_read(&o->encoder, st, "encoder", e));
}

void origin_put(struct arrays_out *out, const struct origin *o)
{
	arrays_out_text(out, "scene", fingerprint_text(&o->scene));
	arrays_out_text(out, "encoder", fingerprint_text(&o->encoder));
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
	return err_file(
		e, path, "is of another %s than %s (%s, not %s)", what, other, mine->hex, theirs->hex);
}
