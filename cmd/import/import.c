#include "cmd/import/import.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"
#include "cmd/import/frames.h"
#include "cmd/import/photographs.h"
#include "formats/splats/anysplats.h"
#include "formats/cameras/camerafile.h"
#include "formats/cameras/colmap.h"
#include "formats/cameras/dataparser.h"
#include "geom/lens.h"
#include "geom/views.h"
#include "splat/near.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

static const char every[] = "every:";

/* The camera file in a folder: the folder itself where it is a COLMAP model, else the first there is of
 * cameras.json, sparse/0, sparse, transforms.json, 0, transforms_train.json, in any case of letters. free()
 * it. NULL without, or with *e. */
static char *find_place(const char *dir, struct err *e)
{
	static const char *const places[] = {
		"cameras.json", "sparse/0", "sparse", "transforms.json", "0", "transforms_train.json"};

	e->code = ERR_NONE;
	if (colmap_is_model(dir))
		return mem_strdup(dir, e);
	for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
		char *path = path_alike(dir, places[i], e);
		if (!path || (strstr(places[i], ".json") ? file_exists(path) : colmap_is_model(path)))
			return path;
		free(path);
	}
	return NULL;
}

/* Those of a folder, or of the first two folders in it that have some, so many folders deep. */
static int find_deep(const char *dir, int depth, char *found[2], struct err *e)
{
	char *here = find_place(dir, e);
	DIR *listed = here || e->code || depth == 0 ? NULL : opendir(dir);
	int bad = e->code;

	if (here)
		found[found[0] != NULL] = here;
	for (struct dirent *d = listed ? readdir(listed) : NULL; d && !bad && !found[1];
		d = readdir(listed)) {
		SCOPED char *path = *d->d_name == '.' ? NULL : file_join(dir, d->d_name, "", e);
		bad = path && file_is_dir(path) && find_deep(path, depth - 1, found, e);
	}
	if (listed)
		closedir(listed);
	return bad ? -1 : 0;
}

/* How deep: a zip's own folder, a program's in it, and a model's name. */
enum { DEPTH = 3 };

/* The one camera file in a folder, so many folders deep, or NULL with *e (ERR_FORMAT). */
static char *find_cameras_in(const char *dir, int depth, struct err *e)
{
	char *found[2] = {NULL, NULL};

	if (!find_deep(dir, depth, found, e)) {
		if (found[0] && !found[1])
			return found[0];
		if (found[1])
			err_set(e, ERR_FORMAT,
				"%s: cameras in several of its folders, as %s and %s: name one", dir,
				found[0], found[1]);
		else
			err_set(e, ERR_FORMAT,
				"%s: no cameras here: no COLMAP model (cameras.txt and images.txt, or .bin), cameras.json, sparse/0, sparse or transforms.json",
				dir);
	}
	mem_free_all(found[0], found[1]);
	return NULL;
}

int import_compare_models(const char *cameras, size_t n, const struct report *to, struct err *e)
{
	SCOPED char *largest = NULL;
	size_t most = n;

	for (int k = 0, is_there = 1; is_there; k++) {
		SCOPED_BY(cameras_free) struct cameras other = {0};
		struct err ignored;
		char name[16];
		snprintf(name, sizeof name, "../%d", k);
		SCOPED char *path = file_join(cameras, name, "", e);
		if (!path)
			return -1;
		is_there = colmap_is_model(path);
		if (!is_there || colmap_read(&other, path, &ignored) || other.n <= most)
			continue;
		most = other.n;
		free(largest);
		largest = path;
		path = NULL;
	}
	if (largest)
		report_warn(to,
			"%s: has %zu images, and %s %zu: COLMAP could not join them, and each model has a frame of its own: give the one that the scene was trained with, as a rule the largest: --cameras %s",
			cameras, n, largest, most, largest);
	return 0;
}

static int by_image(const void *a, const void *b)
{
	const struct camera *x = *(struct camera *const *)a, *y = *(struct camera *const *)b;

	return strcmp(x->image, y->image);
}

/* 0, N, 2N ... in the order of the photographs' whole paths, as 3DGS and gsplat hold out every 8th. */
static int split_every(struct cameras *c, const char *test_views, struct err *e)
{
	const char *text = test_views + strlen(every);
	char *end;
	unsigned long n = strtoul(text, &end, 10);

	if (text[0] < '0' || text[0] > '9' || *end || n < 1 || n > 1000000000)
		return err_set(e, ERR_USAGE, "--test-views: '%s' is not every:N with N from 1 to 1000000000",
			test_views);
	SCOPED struct camera **sorted = mem_alloc(c->n, sizeof *sorted, "views", e);
	if (!sorted)
		return -1;
	for (size_t i = 0; i < c->n; i++)
		sorted[i] = &c->views[i];
	qsort(sorted, c->n, sizeof *sorted, by_image);
	for (size_t i = 0; i < c->n; i++)
		sorted[i]->split = i % n ? SPLIT_TRAIN : SPLIT_TEST;
	return 0;
}

static int split_names(struct cameras *c, const char *test_views, struct err *e)
{
	SCOPED char *is_test = mem_zalloc(c->n, 1, "views", e);
	int bad = is_test ? cameras_mark(c, test_views, "--test-views", is_test, e) : -1;

	for (size_t i = 0; i < c->n && !bad; i++)
		c->views[i].split = is_test[i] ? SPLIT_TEST : SPLIT_TRAIN;
	return bad;
}

/* What is beside SPLATS or, where 3DGS put it into point_cloud/iteration_N, in the model's folder. */
static char *find_beside(const char *splats, struct err *e)
{
	SCOPED char *dir = file_dir(splats, e);
	char *found = dir ? find_cameras_in(dir, 0, e) : NULL;
	const char *slash = dir ? strrchr(dir, '/') : NULL;

	if (dir && !found && !strncmp(slash ? slash + 1 : dir, "iteration_", 10)) {
		struct err ignored;
		SCOPED char *model = file_join(dir, "../..", "", e);
		found = model ? find_cameras_in(model, 0, &ignored) : NULL;
	}
	return found;
}

static int check_images(const char *images_path, struct err *e)
{
	if (!images_path || file_is_dir(images_path))
		return 0;
	errno = file_exists(images_path) ? ENOTDIR : ENOENT;
	return err_errno(e, "%s", images_path);
}

/* The trained splats in a folder of 3DGS: those of the last iteration. */
static char *find_in_folder(const char *folder, struct err *e)
{
	SCOPED char *inner = file_join(folder, "point_cloud", "", e);
	char *found = NULL;
	const char *const places[] = {inner, folder};
	long most = -1;

	for (int i = 0; i < 2 && inner && !found; i++) {
		DIR *dir = opendir(places[i]);
		for (struct dirent *d = dir ? readdir(dir) : NULL; d; d = readdir(dir)) {
			const long n = strncmp(d->d_name, "iteration_", 10) ? -1 : atol(d->d_name + 10);
			if (n <= most)
				continue;
			most = n;
			free(found);
			SCOPED char *parent = file_join(places[i], d->d_name, "", e);
			found = parent ? file_join(parent, "point_cloud.ply", "", e) : NULL;
		}
		if (dir)
			closedir(dir);
	}
	if (inner && !found)
		found = file_join(folder, "point_cloud.ply", "", e);
	return found;
}

char *import_find_splats(const char *path, struct err *e)
{
	if (!strcmp(path, "-") || !file_is_dir(path))
		return mem_strdup(path, e);
	char *found = file_join(path, "meta.json", "", e); /* of SOG */
	if (!found || file_exists(found))
		return found;
	free(found);
	const int has_frames = frames_is_folder(path, e);
	if (has_frames)
		return has_frames > 0 ? mem_strdup(path, e) : NULL;
	found = find_in_folder(path, e);
	if (found && !file_exists(found)) {
		err_set(e, ERR_FORMAT,
			"%s: no trained splats in this folder: no point_cloud/iteration_N/point_cloud.ply, as 3DGS writes them, and no point_cloud.ply",
			path);
		free(found);
		return NULL;
	}
	return found;
}

/* So that a file that is missing is said to be so before cameras are looked for beside it. */
static int check_splats(const char *path, struct err *e)
{
	return strcmp(path, "-") && !file_exists(path) ? err_errno(e, "%s", path) : 0;
}

char *import_find_cameras(const struct import_options *o, struct err *e)
{
	if (check_images(o->images, e) || check_splats(o->splats, e))
		return NULL;
	if (o->cameras)
		return file_is_dir(o->cameras) ? find_cameras_in(o->cameras, DEPTH, e)
					       : mem_strdup(o->cameras, e);
	char *found = find_beside(o->splats, e);
	if (!found && e->code == ERR_FORMAT) {
		const struct err reason = *e;
		err_set(e, ERR_USAGE, "--cameras is not given, and %s", reason.message);
	}
	return found;
}

int import_split(struct cameras *c, const char *test_views, struct err *e)
{
	if (!test_views)
		return 0;
	return strncmp(test_views, every, strlen(every)) ? split_names(c, test_views, e)
							 : split_every(c, test_views, e);
}

/* Pinholes, whatever the photographs' lenses. */
static int read_cameras(struct cameras *c, const struct import_options *o, const char *cameras, struct err *e)
{
	if (camerafile_read(c, cameras, e) ||
		(!o->undistort && camerafile_need_pinholes(c, cameras, o->images, e)))
		return -1;
	cameras_undistort(c);
	for (size_t i = 0; i < c->n; i++) {
		const char *fault = view_fault(&c->views[i]);
		if (fault)
			return err_set(e, ERR_FORMAT, "%s: view '%s', undistorted: %s", file_name(cameras),
				c->views[i].name, fault);
	}
	return 0;
}

/* Into the frame that nerfstudio trained in, where it says how; else the cameras should be in the splats'. */
static int move(struct scene *s, const char *splats, const char *cameras, double *near,
	const struct report *to, struct err *e)
{
	e->code = ERR_NONE;
	SCOPED char *path = dataparser_find(splats, cameras, e);
	int bad = !path && (e->code != ERR_NONE || point_frame_find(near, s, cameras, e));

	if (path) {
		report_note(to, 1, "%s: cameras are moved by it", path);
		bad = dataparser_move(&s->cameras, path, cameras, e);
	}
	return bad ? -1 : 0;
}

/* For the scene's metadata. No paths: a scene's bytes do not depend on where its sources were. */
static char *describe_options(const char *test_views, struct err *e)
{
	size_t bytes = (test_views ? strlen(test_views) : 0) + 16;
	char *text = mem_alloc(bytes, 1, "options", e);

	if (text)
		snprintf(
			text, bytes, "%s%s", test_views ? "--test-views " : "", test_views ? test_views : "");
	return text;
}

/* What is known of the motion before the splats are read. */
static int open_motion(
	struct moving *m, struct scene *s, const struct import_options *o, const char *cameras, struct err *e)
{
	const int is_moving = o->motion || file_is_dir(o->splats);

	if (!is_moving && (o->times || !isnan(o->time)))
		return err_set(e, ERR_USAGE,
			"%s: %s is one file and there is no --motion: the scene is still",
			o->times ? "--times" : "--time", o->splats);
	for (size_t i = 0; i < s->cameras.n; i++) {
		struct camera *c = &s->cameras.views[i];
		if (is_moving && c->has_time && !isnan(o->time))
			return err_set(e, ERR_USAGE, "--time: view '%s' has a time of its own, %.17g",
				c->name, c->time);
		c->has_time = is_moving && (c->has_time || !isnan(o->time));
		c->time = isnan(o->time) ? c->time : o->time;
	}
	return is_moving && (moving_open(m, o->splats, o->motion, o->times, e) ||
				    moving_check_views(m, &s->cameras, cameras, e))
		       ? -1
		       : 0;
}

/* The splats, those of the first time where the scene moves. */
static int read_splats(struct scene *s, struct rows_report *report, const struct import_options *o,
	struct moving *m, struct err *e)
{
	const char *path = m->paths ? m->paths[0] : o->splats;

	if (anysplats_read(&s->splats, s->offset, report, path, e))
		return -1;
	if (!s->splats.n)
		return err_set(e, ERR_FORMAT, "%s: holds no Gaussians", file_name(path));
	return m->n ? moving_first(m, s, report, path, e) : 0;
}

/* The folder's files; of an earlier scene's motion nothing stays. */
static int write_folder(const struct scene *s, const struct moving *m, const char *folder,
	const char *metadata, struct import_found *found, struct err *e)
{
	SCOPED char *motion = file_join(folder, "motion.safetensors", "", e);

	found->times = m->n;
	if (!motion || (m->n && moving_write(m, s, folder, &found->moved, e)) ||
		scene_write(s, folder, metadata, e))
		return -1;
	return !m->n && remove(motion) && errno != ENOENT ? err_errno(e, "%s", motion) : 0;
}

static int import_all(struct scene *s, struct rows_report *report, const struct import_options *o,
	const char *cameras, const char *folder, struct moving *m, struct import_found *found,
	const struct report *to, struct err *e)
{
	/* Cameras first: what is wrong with them, or with a view's name, is said before the slow splats. */
	if (read_cameras(&s->cameras, o, cameras, e) || import_compare_models(cameras, s->cameras.n, to, e) ||
		import_split(&s->cameras, o->test_views, e) || open_motion(m, s, o, cameras, e) ||
		read_splats(s, report, o, m, e) || move(s, o->splats, cameras, &found->near, to, e))
		return -1;
	cameras_shift(&s->cameras, s->offset);
	s->is_metric = o->is_metric;
	SCOPED char *metadata = describe_options(o->test_views, e);
	return -(!metadata || near_find(&s->splats, &s->cameras, e) || file_make_dir(folder, e) ||
		 photographs_find(&s->cameras, o->images, folder, &found->missing, e) ||
		 (o->images && !m->n && resemblance_find(&found->resemblance, s, folder, to, e)) ||
		 write_folder(s, m, folder, metadata, found, e));
}

int import_scene(struct scene *s, struct rows_report *report, const struct import_options *o,
	const char *cameras, const char *folder, struct import_found *found, const struct report *to,
	struct err *e)
{
	const int was_there = file_exists(folder);
	struct moving m = {0};

	*found = (struct import_found){.near = 1};
	const int bad = import_all(s, report, o, cameras, folder, &m, found, to, e);
	moving_free(&m);
	if (bad && !was_there)
		rmdir(folder); /* where it is empty */
	return bad ? -1 : 0;
}
