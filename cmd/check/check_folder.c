#include "cmd/check/check.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/names.h"
#include "formats/cameras/colmap.h"
#include "formats/records/boxes.h"
#include "formats/records/detections.h"
#include "formats/records/masks.h"
#include "formats/records/sentences.h"
#include "formats/scene/weights.h"

#include <dirent.h>

/* The records of gs-check: sentences, masks and boxes, each read by its own reader and counted. */
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
	return -(add_names(c, "views", set.items, stride, offsetof(struct mask, view), set.n, e) ||
		 add_names(c, "objects", set.items, stride, offsetof(struct mask, object), set.n, e));
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

int check_detections(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(detections_free) struct detections d = {0};
	const size_t stride = sizeof *d.items;

	if (detections_read(&d, path, e))
		return -1;
	c->kind = "detections";
	check_add(c, "boxes", (long long)d.n);
	return add_names(c, "views", d.items, stride, offsetof(struct detection, view), d.n, e) ||
			       add_names(c, "classes", d.items, stride, offsetof(struct detection, name), d.n,
				       e)
		       ? -1
		       : 0;
}

static int check_scene(struct check *c, const char *path, struct err *e)
{
	SCOPED_BY(scene_free) struct scene s = {0};

	if (scene_read(&s, path, e))
		return -1;
	c->kind = "scene";
	c->scene = s.fingerprint;
	check_add_splats(c, &s.splats);
	check_add_views(c, &s.cameras);
	if (s.motion.times)
		check_add_motion(c, &s.motion);
	return 0;
}

/* One view of a folder, which is of the scene that the folder's first one with a fingerprint is of. */
static int add_view_weights(struct check *c, const char *file, char **first, long long *total, struct err *e)
{
	SCOPED_BY(weights_close) struct weights w = {0};

	if (weights_open_file(&w, file, e))
		return -1;
	int bad = *first ? fingerprint_check("scene", file, &w.scene, *first, &c->scene, e) : 0;
	if (!bad && !*first && *w.scene.hex) {
		c->scene = w.scene;
		*first = mem_strdup(file, e);
		bad = *first ? 0 : -1;
	}
	*total += (long long)w.indptr[(int64_t)w.width * w.height];
	return bad;
}

/* Adds the views of a folder of gs-weigh, in the order of their names; *views says how many there are. */
static int add_weights(
	struct check *c, const char *path, struct dirent **names, int n, long long *views, struct err *e)
{
	long long total = 0;
	SCOPED char *first = NULL;
	int bad = 0;

	*views = 0;
	for (int i = 0; i < n && !bad; i++) {
		const char *dot = strrchr(names[i]->d_name, '.');
		if (!dot || strcmp(dot, ".safetensors"))
			continue;
		SCOPED char *file = file_join(path, names[i]->d_name, "", e);
		bad = file ? add_view_weights(c, file, &first, &total, e) : -1;
		++*views;
	}
	if (bad)
		return -1;
	c->kind = "weights";
	check_add(c, "views", *views);
	check_add(c, "weights", total);
	return 0;
}

/* Each kind of folder is known by what lies in it. */
int check_folder(struct check *c, const char *path, struct err *e)
{
	static const char *const parts[] = {"splats.safetensors", "cameras.json"};
	struct dirent **names = NULL;
	long long views = 0;
	int found = 0;

	for (int i = 0; i < 2; i++) {
		SCOPED char *part = file_join(path, parts[i], "", e);
		if (!part)
			return -1;
		found |= file_exists(part) << i;
	}
	if (found == 3)
		return check_scene(c, path, e);
	if (found & 1)
		return err_set(e, ERR_FORMAT, "%s: a scene without %s", path, parts[1]);
	if (colmap_is_model(path))
		return check_cameras(c, path, "COLMAP model", camerafile_read, e);
	int n = scandir(path, &names, NULL, alphasort);
	if (n < 0)
		return err_errno(e, "%s", path);
	int bad = add_weights(c, path, names, n, &views, e);
	mem_free_strings((char **)names, (size_t)n);
	if (!bad && !views)
		return err_set(e, ERR_FORMAT, "%s: not a scene, COLMAP model or folder of weights", path);
	return bad;
}
