#include "cmd/jobs/score_masks.h"

#include "base/file.h"
#include "mask/mask_index.h"

#include <stdlib.h>

void score_masks_free(struct score_masks *s)
{
	masks_free(&s->set);
}

static int check_twice(const struct score_masks *s, const long *lines, struct err *e)
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
		lines[later], m->view, m->ref ? "ref" : "object", m->ref ? m->ref : m->object,
		lines[earlier]);
}

int score_masks_read(struct score_masks *s, const char *path, struct err *e)
{
	long *lines;

	*s = (struct score_masks){.path = path};
	if (masks_read_lines(&s->set, &lines, path, e))
		return -1;
	s->n = s->set.n;
	int bad = check_twice(s, lines, e);
	free(lines);
	if (bad)
		score_masks_free(s);
	return bad;
}
