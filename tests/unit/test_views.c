#include "unit.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/path.h"
#include "geom/views.h"

/* Views of these images, in this order. */
static void make_views(struct cameras *c, const char *const *images)
{
	struct err e;

	c->n = 0;
	while (images[c->n])
		c->n++;
	c->views = mem_zalloc(c->n, sizeof *c->views, "views", &e);
	for (size_t i = 0; i < c->n; i++) {
		struct camera *v = &c->views[i];
		*v = (struct camera){
			.image = view_image(images[i], &e), .width = 4, .height = 3, .fx = 1, .fy = 1};
		for (int k = 0; k < 4; k++)
			v->world_to_camera[k][k] = 1;
	}
}

/* Expects these names, in this order; NULL images end the lists. */
static void names(const char *const *images, const char *const *expected)
{
	struct cameras c;
	struct err e = {0};

	make_views(&c, images);
	int bad = views_finish(&c, "file", &e);
	CHECK(!bad, "%s", e.message);
	size_t n = 0;
	for (; !bad && expected[n] && n < c.n; n++) {
		const char *name = c.views[n].name ? c.views[n].name : "unnamed";
		CHECK(!strcmp(name, expected[n]), "view %zu is %s, not %s", n, name, expected[n]);
	}
	CHECK(bad || (n == c.n && !expected[n]), "%zu views, %zu of them as expected", c.n, n);
	/* the same in the order of the images, without cameras */
	char **own = mem_zalloc(c.n, sizeof *own, "views", &e);
	bad = bad || views_name(images, c.n, own, "file", &e);
	for (size_t i = 0; !bad && i < c.n; i++) {
		size_t at = 0;
		char *image = view_image(images[i], &e);
		while (strcmp(c.views[at].image, image))
			at++;
		free(image);
		CHECK(!strcmp(own[i], c.views[at].name), "%s is %s, not %s", images[i], own[i],
			c.views[at].name);
		free(own[i]);
	}
	free(own);
	cameras_free(&c);
}

#define LIST(...) ((const char *const[]){__VA_ARGS__, NULL})

static void naming(void)
{
	names(LIST("b.jpg", "./images/a.JPEG", "v1.5", "z/c.tiff"), LIST("a", "b", "c", "v1.5"));
	names(LIST("10.jpg", "9.jpg", "1.jpg"), LIST("1", "10", "9"));
	names(LIST("l/1.jpg", "r/1.jpg", "2.jpg"), LIST("2", "l_1", "r_1"));
	names(LIST("l/1.png", "l/1.jpg"), LIST("l_1.jpg", "l_1.png"));
	/* The longer name of one is another's own. */
	names(LIST("l/1.jpg", "r/1.jpg", "l_1.png"), LIST("l_1", "l_1.jpg", "r_1"));
	/* What no file name can be, or no list of names can have. */
	names(LIST("..", "x/.", "a/caf\xe9.jpg", "b\n.png", "c,d.jpg"),
		LIST("%2E", "%2E%2E", "b%0A", "c%2Cd", "caf%E9"));
	/* Paths that '_' for '/' makes the same. */
	names(LIST("x/a_b.jpg", "x_a/b.jpg", "y/b.jpg", "y/a_b.jpg"),
		LIST("x%2Fa_b.jpg", "x_a%2Fb.jpg", "y_a_b", "y_b"));
	names(LIST("cam1/0001.png", "cam2/0001.png", "cam1/0002.png"),
		LIST("0002", "cam1_0001", "cam2_0001"));
}

static void paths(void)
{
	static const char *const pairs[][2] = {{"..\\a.jpg", "../a.jpg"}, {"x/../a", "a"}, {"/../a", "/../a"},
		{"../../x/../a", "../../a"}, {"x/..", "x/.."}, {"C:\\..\\.\\x//..\\a", "/../a"},
		{"ab/c/..//d/.", "ab/d/."}};
	struct err e;

	for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
		SCOPED char *image = view_image(pairs[i][0], &e);
		CHECK(!strcmp(image, pairs[i][1]), "%s is %s, not %s", pairs[i][0], image, pairs[i][1]);
	}
}

static void faults(void)
{
	struct cameras c;
	struct err e = {0};

	make_views(&c, LIST("a.jpg", "b.jpg", "a.jpg"));
	CHECK(views_finish(&c, "file", &e) && e.code == ERR_FORMAT &&
			!strcmp(e.message, "file: two views are of 'a.jpg': take one out"),
		"%s", e.message);
	cameras_free(&c);
	make_views(&c, LIST("x/a.jpg", "x//a.jpg", "./x/a.jpg"));
	CHECK(views_finish(&c, "file", &e) &&
			!strcmp(e.message, "file: two views are of 'x/a.jpg': take one out"),
		"%s", e.message);
	cameras_free(&c);
	make_views(&c, LIST("x/a.jpg", "x/y/z/../../a.jpg"));
	CHECK(views_finish(&c, "file", &e) &&
			!strcmp(e.message, "file: two views are of 'x/a.jpg': take one out"),
		"%s", e.message);
	cameras_free(&c);
	make_views(&c, LIST("l/.jpg"));
	CHECK(views_finish(&c, "file", &e) && !strcmp(e.message, "file: image 'l/.jpg' gives no view name"),
		"%s", e.message);
	cameras_free(&c);
	make_views(&c, LIST("a.jpg"));
	c.views[0].world_to_camera[2][2] = -1; /* a reflection */
	CHECK(views_finish(&c, "file", &e) &&
			!strcmp(e.message,
				"file: view 'a.jpg': its pose is not a rotation and a translation: is it mirrored, scaled or rounded to few digits?"),
		"%s", e.message);
	struct camera *v = &c.views[0];
	v->world_to_camera[2][2] = 1.001;
	CHECK(!camera_is_rigid(v), "a stretched axis");
	v->world_to_camera[2][2] = 1;
	v->world_to_camera[1][3] = NAN;
	CHECK(!camera_is_rigid(v), "a translation that is not finite");
	v->world_to_camera[1][3] = 1e6;
	v->world_to_camera[3][0] = 1e-9;
	CHECK(!camera_is_rigid(v), "a last row that is not 0 0 0 1");
	v->world_to_camera[3][0] = 0;
	CHECK(!view_fault(v), "all is well: %s", view_fault(v));
	v->fx = 0;
	CHECK(view_fault(v) && !strcmp(view_fault(v), "its focal length is not positive"), "focal length 0");
	v->fx = 1;
	v->cx = INFINITY;
	CHECK(view_fault(v) && !strcmp(view_fault(v), "its principal point is not finite"), "infinite cx");
	v->width = 65537;
	CHECK(view_fault(v) && !strcmp(view_fault(v), "its size is not within 1 to 65536"), "width 65537");
	cameras_free(&c);
	CHECK(view_set_size(&(struct camera){0}, 3.5, 4) && view_set_size(&(struct camera){0}, 0, 4) &&
			view_set_size(&(struct camera){0}, NAN, 4) &&
			view_set_size(&(struct camera){0}, 4, 65537) &&
			!view_set_size(&(struct camera){0}, 1, 65536),
		"sizes");
}

/* A point keeps its place in the picture when the world's origin moves. */
static void shift(void)
{
	struct cameras c;
	double offset[3] = {1e6, -2e6, 5}, before[3], after[3], moved[3];
	const double point[3] = {1000001, -2000002, 3}, expected[3] = {2, 1, -2};
	double turned[3][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};

	make_views(&c, LIST("a.jpg"));
	camera_set_centre(&c.views[0], turned, (double[]){1e6, -2e6, 1});
	camera_centre(&c.views[0], before);
	CHECK(before[0] == 1e6 && before[1] == -2e6 && before[2] == 1, "centre %g %g %g", before[0],
		before[1], before[2]);
	camera_transform(&c.views[0], point, before);
	cameras_shift(&c, offset);
	for (int k = 0; k < 3; k++)
		moved[k] = point[k] - offset[k];
	camera_transform(&c.views[0], moved, after);
	for (int k = 0; k < 3; k++)
		CHECK(before[k] == after[k] && after[k] == expected[k], "%g becomes %g", before[k], after[k]);
	cameras_free(&c);
}

/* Which of 10 views, of which every third is for testing, are taken: by their focal lengths. */
static void spread(void)
{
	struct camera views[10], chosen[10];
	struct cameras c = {10, views};

	for (int i = 0; i < 10; i++)
		views[i] = (struct camera){.width = 40,
			.height = 20,
			.fx = 4 * i,
			.split = i % 3 == 2 ? SPLIT_TEST : SPLIT_TRAIN};
	CHECK(cameras_spread(&c, 3, 10, chosen) == 3, "not three");
	/* of the training views 0 1 3 4 6 7 9 those at 0, 7/3 and 14/3 */
	CHECK(chosen[0].fx == 0 && chosen[1].fx == 3 && chosen[2].fx == 6, "%g %g %g", chosen[0].fx,
		chosen[1].fx, chosen[2].fx);
	CHECK(chosen[1].width == 10 && chosen[1].height == 5, "%d x %d", chosen[1].width, chosen[1].height);
	CHECK(cameras_spread(&c, 9, 100, chosen) == 7 && chosen[6].fx == 36 && chosen[6].width == 40,
		"all, none enlarged");
	c.views = views + 2;
	c.n = 1;
	CHECK(cameras_spread(&c, 3, 100, chosen) == 1 && chosen[0].fx == 8, "a test view where no other is");
	c.n = 0;
	CHECK(cameras_spread(&c, 3, 100, chosen) == 0, "a view of none");
}

static void relative(const char *dir, const char *from, const char *to, const char *expected)
{
	struct err e = {0};
	char *a = file_join(dir, from, "", &e), *b = file_join(dir, to, "", &e),
	     *path = path_relative(a, b, &e);

	CHECK(path && !strcmp(path, expected), "from %s to %s: %s", from, to, path ? path : e.message);
	free(a);
	free(b);
	free(path);
}

static void relative_paths(void)
{
	char dir[] = "/tmp/test_views.XXXXXX";
	struct err e = {0};

	if (!mkdtemp(dir))
		exit(1);
	char *deep = file_join(dir, "ab/c/d", "", &e), *near = file_join(dir, "a", "", &e);
	CHECK(!file_make_dir(deep, &e) && !file_make_dir(near, &e), "%s", e.message);
	relative(dir, "a", "ab/f.jpg", "../ab/f.jpg");
	relative(dir, "ab", "a/f.jpg", "../a/f.jpg");
	relative(dir, "a", "a/f.jpg", "f.jpg");
	relative(dir, "ab/c/d", "ab/f.jpg", "../../f.jpg");
	relative(dir, "ab/c/d", "a/../ab/c/f.jpg", "../f.jpg");
	relative(dir, "ab/", "ab/c/d/f.jpg", "c/d/f.jpg");
	char *none = file_join(dir, "none", "", &e), *missing = path_relative(none, deep, &e);
	CHECK(!missing && e.code == ERR_SYSTEM, "a folder that is not there");
	char *up = path_relative("/", "/tmp", &e);
	CHECK(up && !strcmp(up, "tmp"), "from the root: %s", up ? up : e.message);
	free(up);
	CHECK(!remove(deep), "%s", deep);
	static const char *const made[] = {"ab/c", "ab", "a", ""};
	for (int i = 0; i < 4; i++) {
		char *path = file_join(dir, made[i], "", &e);
		CHECK(!remove(path), "%s", path);
		free(path);
	}
	free(none);
	free(deep);
	free(near);
}

int main(void)
{
	naming();
	spread();
	paths();
	faults();
	shift();
	relative_paths();
	return unit_end();
}
