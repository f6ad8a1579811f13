/* The records of gs-check: sentences, masks and boxes, each read by its own reader and counted. */
#include "cmd/check/check.h"

#include "base/mem.h"
#include "base/names.h"
#include "formats/records/boxes.h"
#include "formats/records/masks.h"
#include "formats/records/sentences.h"

#include <stddef.h>

void check_add(struct check *c, const char *name, long long value)
{
	c->facts[c->n++] = (struct check_fact){name, value};
}

/* Adds the number of different names, as names_make finds them. */
static int add_names(struct check *c, const char *fact, const void *items, size_t stride, size_t offset,
	size_t n, struct err *e)
{
	SCOPED_BY(names_free) struct names names = {0};

	if (names_make(&names, items, stride, offset, n, e))
		return -1;
	check_add(c, fact, (long long)names_count(&names));
	return 0;
}

/* Every object that sentences name: an array of names to free, none of them owned; *n gets their number. */
static const char **sentence_objects(const struct sentences *s, size_t *n, struct err *e)
{
	size_t most = s->n;

	for (size_t i = 0; i < s->n; i++)
		most += s->items[i].object_count;
	const char **names = mem_alloc(most, sizeof *names, "objects", e);
	*n = 0;
	for (size_t i = 0; names && i < s->n; i++) {
		if (*s->items[i].object)
			names[(*n)++] = s->items[i].object;
		for (size_t k = 0; k < s->items[i].object_count; k++)
			names[(*n)++] = s->items[i].objects[k];
	}
	return names;
}

int check_sentences(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(sentences_free) struct sentences s = {0};
	size_t test = 0;

	if (sentences_read(&s, path, e))
		return -1;
	for (size_t i = 0; i < s.n; i++)
		test += s.items[i].split == SPLIT_TEST;
	c->kind = "sentences";
	check_add(c, "training sentences", (long long)(s.n - test));
	check_add(c, "test sentences", (long long)test);
	size_t n;
	SCOPED const char **names = sentence_objects(&s, &n, e);
	return !names || add_names(c, "objects", names, sizeof *names, 0, n, e) ? -1 : 0;
}

int check_masks(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(masks_free) struct masks set = {0};
	size_t same = 0;

	if (masks_read(&set, path, e))
		return -1;
	for (size_t i = 0; i < set.n; i++)
		same += (size_t)rle_same_size(&set.items[i].rle, &set.items[0].rle);
	c->kind = "masks";
	if (set.n && same == set.n) {
		c->width = set.items[0].rle.width;
		c->height = set.items[0].rle.height;
	}
	check_add(c, "masks", (long long)set.n);
	const size_t stride = sizeof *set.items;
	return add_names(c, "views", set.items, stride, offsetof(struct mask, view), set.n, e) ||
			       add_names(c, "objects", set.items, stride, offsetof(struct mask, object),
				       set.n, e)
		       ? -1
		       : 0;
}

int check_boxes(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(boxes_free) struct box_set set = {0};
	size_t empty = 0;

	if (boxes_read(&set, path, e))
		return -1;
	for (size_t i = 0; i < set.n; i++)
		empty += set.records[i].is_empty != 0;
	c->kind = "boxes";
	check_add(c, "boxes", (long long)(set.n - empty));
	int bad = add_names(c, "objects", set.records, sizeof *set.records,
		offsetof(struct box_record, object), set.n, e);
	check_add(c, "empty", (long long)empty);
	return bad ? -1 : 0;
}
