#include "train/supervision.h"

#include "base/mem.h"
#include "mask/bits.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST_SLOTS = 64 };

/* FNV-1a over words of eight bytes, the last filled up with 0, and its high bits folded into the low ones,
 * which choose the slot. */
static uint64_t hash(uint64_t h, const void *data, size_t bytes)
{
	const unsigned char *at = data;

	for (size_t i = 0; i < bytes; i += 8) {
		uint64_t word = 0;
		memcpy(&word, at + i, bytes - i < 8 ? bytes - i : 8);
		h = (h ^ word) * 0x100000001b3;
		h ^= h >> 29;
	}
	return h;
}

/* A mask answers to its ref, or without one to its object. */
static uint64_t hash_name(size_t view, const char *ref, const char *object)
{
	const char *name = ref ? ref : object ? object : "";

	return hash(0xcbf29ce484222325 + 2 * view + !ref, name, strlen(name));
}

static int same(const char *a, const char *b)
{
	return a && b && !strcmp(a, b);
}

static const struct supervision_mask *find(
	const struct supervision *s, size_t view, const char *ref, const char *object)
{
	const uint64_t h = hash_name(view, ref, object);

	if (!s->slots)
		return NULL;
	for (size_t at = h % s->slots; s->by_name[at]; at = (at + 1) % s->slots) {
		const struct supervision_mask *m = &s->masks[s->by_name[at] - 1];
		if (m->name_hash == h && m->view == view &&
			(ref ? same(m->ref, ref) : !m->ref && same(m->object, object)))
			return m;
	}
	return NULL;
}

static const struct supervision_mask *find_equal(
	const struct supervision *s, const struct supervision_mask *like)
{
	for (size_t at = like->bits_hash % s->slots; s->by_bits[at]; at = (at + 1) % s->slots) {
		const struct supervision_mask *m = &s->masks[s->by_bits[at] - 1];
		if (m->bits_hash == like->bits_hash && m->view == like->view && m->bytes == like->bytes &&
			!memcmp(m->bits, like->bits, m->bytes))
			return m;
	}
	return NULL;
}

static void put(size_t *table, size_t slots, uint64_t h, size_t mask)
{
	size_t at = h % slots;

	while (table[at])
		at = (at + 1) % slots;
	table[at] = mask + 1;
}

static void put_mask(struct supervision *s, size_t mask)
{
	const struct supervision_mask *m = &s->masks[mask];

	put(s->by_name, s->slots, m->name_hash, mask);
	if (!m->is_shared)
		put(s->by_bits, s->slots, m->bits_hash, mask);
}

/* Room for one more mask, with half of the slots free. */
static int grow(struct supervision *s, struct err *e)
{
	void *block = s->masks;

	if (mem_grow(&block, &s->capacity, s->n + 1, sizeof *s->masks, "masks", e))
		return -1;
	s->masks = block;
	if (2 * (s->n + 1) <= s->slots)
		return 0;
	const size_t slots = s->slots ? 2 * s->slots : FIRST_SLOTS;
	size_t *tables = mem_zalloc(slots, 2 * sizeof *tables, "masks", e);
	if (!tables)
		return -1;
	free(s->by_name);
	s->slots = slots;
	s->by_name = tables;
	s->by_bits = tables + slots;
	for (size_t i = 0; i < s->n; i++)
		put_mask(s, i);
	return 0;
}

static void free_mask(struct supervision_mask *m)
{
	free(m->ref);
	free(m->object);
	if (!m->is_shared)
		free(m->bits);
}

/* The mask's bits, at the size of the view. */
static int fill_bits(struct supervision_mask *m, int width, int height, const struct rle *mask, struct err *e)
{
	const size_t pixels = (size_t)width * (size_t)height;
	struct rle resized = {0};
	uint8_t *bytes = mem_alloc((size_t)width, (size_t)height, "mask", e);
	int bad = -1;

	m->bytes = bits_bytes(pixels);
	m->bits = mem_alloc(m->bytes, 1, "mask", e);
	if (bytes && m->bits && !rle_resize(&resized, mask, height, width, e)) {
		rle_decode(&resized, bytes);
		bits_pack(bytes, pixels, m->bits);
		m->bits_hash = hash(m->view, m->bits, m->bytes);
		bad = 0;
	}
	rle_free(&resized);
	free(bytes);
	return bad;
}

int supervision_add(struct supervision *s, size_t view, int width, int height, const char *ref,
	const char *object, const struct rle *mask, struct err *e)
{
	struct supervision_mask m = {.view = view, .name_hash = hash_name(view, ref, object)};

	if (find(s, view, ref, object))
		return err_set(e, ERR_FORMAT, "a second mask of %s '%s' in the same view",
			ref ? "ref" : "object", ref ? ref : object);
	if ((ref && !(m.ref = mem_strdup(ref, e))) || (object && !(m.object = mem_strdup(object, e))) ||
		fill_bits(&m, width, height, mask, e) || grow(s, e)) {
		free_mask(&m);
		return -1;
	}
	const struct supervision_mask *equal = find_equal(s, &m);
	if (equal) {
		free(m.bits);
		m.bits = equal->bits;
		m.is_shared = 1;
	}
	s->masks[s->n] = m;
	put_mask(s, s->n++);
	return 0;
}

void supervision_free(struct supervision *s)
{
	for (size_t i = 0; i < s->n; i++)
		free_mask(&s->masks[i]);
	free(s->masks);
	free(s->by_name);
	*s = (struct supervision){0};
}

int supervision_link(const struct supervision *s, const char *const *refs, const char *const *objects,
	size_t sentences, struct train_view *views, size_t view_count, struct err *e)
{
	for (size_t v = 0; v < view_count; v++) {
		views[v].count = 0;
		views[v].sentences = mem_alloc(sentences, sizeof *views[v].sentences, "sentences", e);
		views[v].masks = mem_alloc(sentences, sizeof *views[v].masks, "masks", e);
		if (!views[v].sentences || !views[v].masks)
			return -1;
		for (size_t r = 0; r < sentences; r++) {
			const struct supervision_mask *m = find(s, v, refs[r], NULL);
			if (!m)
				m = find(s, v, NULL, objects[r]);
			if (!m)
				continue;
			views[v].sentences[views[v].count] = (int)r;
			views[v].masks[views[v].count++] = m->bits;
		}
	}
	return 0;
}

void supervision_unlink(struct train_view *views, size_t view_count)
{
	for (size_t v = 0; v < view_count; v++) {
		free(views[v].sentences);
		free(views[v].masks);
	}
}
