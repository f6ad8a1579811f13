#include "cmd/score/score_masks.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/names.h"
#include "mask/mask_index.h"

#include <stddef.h>
#include <stdlib.h>

void score_masks_free(struct score_masks *s)
{
	masks_free(&s->set);
	free(s->lines);
	s->lines = NULL;
}

static int check_twice(const struct score_masks *s, struct err *e)
{
	struct mask_index x;
	size_t earlier, later;

	if (mask_index_make(&x, s->set.items, s->n, MASK_BY_REF, e))
		return -1;
	const int found = mask_index_twice(&x, &earlier, &later);
	mask_index_free(&x);
	if (!found)
		return 0;
	const struct mask *m = &s->set.items[later];
	return err_set(e, ERR_FORMAT, "%s:%ld: view '%s', %s '%s' is on line %ld already", file_name(s->path),
		s->lines[later], m->view, m->ref ? "ref" : "object", m->ref ? m->ref : m->object,
		s->lines[earlier]);
}

int score_masks_read(struct score_masks *s, const char *path, struct err *e)
{
	*s = (struct score_masks){.path = path};
	if (masks_read_lines(&s->set, &s->lines, path, e))
		return -1;
	s->n = s->set.n;
	int bad = check_twice(s, e);
	if (bad)
		score_masks_free(s);
	return bad;
}

int score_masks_check(const struct score_masks *s, const struct score_masks *truth, struct err *e)
{
	const struct mask *of = truth->set.items;
	SCOPED_BY(names_free) struct names views = {0};
	int bad = names_make(&views, of, sizeof *of, offsetof(struct mask, view), truth->n, e);

	for (size_t i = 0; i < s->n && !bad; i++) {
		const size_t at = names_find(&views, s->set.items[i].view);
		if (at != NAMES_NONE)
			bad = masks_check_shape(&s->set.items[i], "its truth", of[at].rle.height,
				of[at].rle.width, s->path, s->lines[i], e);
	}
	return bad;
}
