#include "train/supervision.h"

#include "base/mem.h"
#include "mask/bits.h"

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

static const struct supervision_bits *find_equal(
	const struct supervision *s, const struct supervision_bits *like)
{
	for (size_t at = like->hash % s->slots; s->by_bits[at]; at = (at + 1) % s->slots) {
		const struct supervision_bits *b = &s->bits[s->by_bits[at] - 1];
		if (b->hash == like->hash && b->view == like->view && b->bytes == like->bytes &&
			!memcmp(b->bits, like->bits, b->bytes))
			return b;
	}
	return NULL;
}

static void put(struct supervision *s, size_t mask)
{
	size_t at = s->bits[mask].hash % s->slots;

	while (s->by_bits[at])
		at = (at + 1) % s->slots;
	s->by_bits[at] = mask + 1;
}

/* Room for one more mask, with half of the slots free. */
static int grow(struct supervision *s, struct err *e)
{
	const size_t n = s->masks.n;

	if (mem_grow((void **)&s->bits, &s->capacity, n + 1, sizeof *s->bits, "masks", e))
		return -1;
	if (2 * (n + 1) <= s->slots)
		return 0;
	const size_t slots = s->slots ? 2 * s->slots : FIRST_SLOTS;
	size_t *table = mem_zalloc(slots, sizeof *table, "masks", e);
	if (!table)
		return -1;
	free(s->by_bits);
	s->slots = slots;
	s->by_bits = table;
	for (size_t i = 0; i < n; i++)
		if (!s->bits[i].is_shared)
			put(s, i);
	return 0;
}

/* The mask's bits, at the size of the view. */
static int fill_bits(struct supervision_bits *b, int width, int height, const struct rle *mask, struct err *e)
{
	const size_t pixels = (size_t)width * (size_t)height;
	SCOPED uint8_t *bytes = mem_alloc((size_t)width, (size_t)height, "mask", e);
	int bad = -1;

	b->bytes = bits_bytes(pixels);
	b->bits = mem_alloc(b->bytes, 1, "mask", e);
	if (bytes && b->bits && !rle_decode_at(mask, height, width, bytes, e)) {
		bits_pack(bytes, pixels, b->bits);
		b->hash = hash(b->view, b->bits, b->bytes);
		bad = 0;
	}
	return bad;
}

int supervision_add(
	struct supervision *s, size_t view, int width, int height, struct mask *mask, struct err *e)
{
	struct supervision_bits b = {.view = view};
	const size_t at = s->masks.n;

	if (fill_bits(&b, width, height, &mask->rle, e) || grow(s, e)) {
		free(b.bits);
		mask_free(mask);
		return -1;
	}
	rle_free(&mask->rle);
	if (masks_add(&s->masks, mask, e)) {
		free(b.bits);
		return -1;
	}
	const struct supervision_bits *equal = find_equal(s, &b);
	if (equal) {
		free(b.bits);
		b.bits = equal->bits;
		b.is_shared = 1;
	}
	s->bits[at] = b;
	if (!equal)
		put(s, at);
	return 0;
}

int supervision_index(struct supervision *s, size_t *later, struct err *e)
{
	size_t earlier;

	if (mask_index_make(&s->index, s->masks.items, s->masks.n, MASK_BY_REF, e))
		return -1;
	if (!mask_index_twice(&s->index, &earlier, later))
		return 0;
	const struct mask *m = &s->masks.items[*later];
	return err_set(e, ERR_FORMAT, "a second mask of %s '%s' in the same view", m->ref ? "ref" : "object",
		m->ref ? m->ref : m->object);
}

void supervision_free(struct supervision *s)
{
	for (size_t i = 0; i < s->masks.n; i++)
		if (!s->bits[i].is_shared)
			free(s->bits[i].bits);
	masks_free(&s->masks);
	mask_index_free(&s->index);
	mem_free_all(s->bits, s->by_bits);
	*s = (struct supervision){0};
}

/* The pairs of one view, whose name its masks have; NULL where it has no mask. */
static int link_view(const struct supervision *s, const char *const *refs, const char *const *objects,
	size_t sentences, const char *name, struct train_view *view, struct err *e)
{
	view->count = 0;
	view->sentences = mem_alloc(sentences, sizeof *view->sentences, "sentences", e);
	view->masks = mem_alloc(sentences, sizeof *view->masks, "masks", e);
	if (!view->sentences || !view->masks)
		return -1;
	for (size_t r = 0; r < sentences && name; r++) {
		size_t begin, end;
		mask_index_ref(&s->index, name, refs[r], &begin, &end);
		if (begin == end)
			mask_index_object(&s->index, name, objects[r], &begin, &end);
		if (begin == end)
			continue;
		view->sentences[view->count] = (int)r;
		view->masks[view->count++] = s->bits[s->index.keys[begin].at].bits;
	}
	return 0;
}

int supervision_link(const struct supervision *s, const char *const *refs, const char *const *objects,
	size_t sentences, struct train_view *views, size_t view_count, struct err *e)
{
	SCOPED const char **names = mem_zalloc(view_count, sizeof *names, "views", e);
	int bad = !names;

	for (size_t i = 0; i < s->masks.n && !bad; i++)
		names[s->bits[i].view] = s->masks.items[i].view;
	for (size_t v = 0; v < view_count && !bad; v++)
		bad = link_view(s, refs, objects, sentences, names[v], &views[v], e);
	return bad ? -1 : 0;
}

void supervision_unlink(struct train_view *views, size_t view_count)
{
	for (size_t v = 0; v < view_count; v++)
		mem_free_all(views[v].sentences, views[v].masks);
}
