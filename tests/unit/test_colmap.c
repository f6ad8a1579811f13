#include "unit.h"

#include "base/file.h"
#include "base/mem.h"
#include "base/rng.h"
#include "formats/cameras/colmap.h"
#include "geom/lens.h"

#include <fcntl.h>
#include <stdint.h>
#include <unistd.h>

static char dir[] = "/tmp/test_colmap.XXXXXX";

/* A binary file in the making, open all the time: closing a truncated file may wait for the disk. */
struct bytes {
	unsigned char data[4096];
	size_t len;
	int file;
};

static void open_bytes(struct bytes *b, const char *name)
{
	char path[128];

	snprintf(path, sizeof path, "%s/%s", dir, name);
	b->len = 0;
	b->file = open(path, O_RDWR | O_CREAT, 0600);
	if (b->file < 0)
		exit(1);
}

static void save(const struct bytes *b, size_t len)
{
	if (pwrite(b->file, b->data, len, 0) != (ssize_t)len || ftruncate(b->file, (off_t)len))
		exit(1);
}

static void put(struct bytes *b, uint64_t bits, int size)
{
	for (int i = 0; i < size; i++)
		b->data[b->len++] = (unsigned char)(bits >> 8 * i);
}

static void put_double(struct bytes *b, double value)
{
	uint64_t bits;

	memcpy(&bits, &value, 8);
	put(b, bits, 8);
}

static void put_camera(struct bytes *b, uint32_t id, uint32_t model, int params, const double *values)
{
	put(b, id, 4);
	put(b, model, 4);
	put(b, 640, 8);
	put(b, 480, 8);
	for (int i = 0; i < params; i++)
		put_double(b, values[i]);
}

static void put_image(
	struct bytes *b, const double pose[7], uint32_t camera, const char *name, uint64_t points)
{
	put(b, 9, 4);
	for (int i = 0; i < 7; i++)
		put_double(b, pose[i]);
	put(b, camera, 4);
	for (const char *p = name; *p; p++)
		put(b, (uint64_t)*p, 1);
	put(b, 0, 1);
	put(b, points, 8);
	for (uint64_t i = 0; i < 24 * points; i++)
		put(b, i, 1);
}

static const double focal[] = {500, 510, 320.5, 239.25, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};

static void build_model(struct bytes *cameras, struct bytes *images)
{
	open_bytes(cameras, "cameras.bin");
	open_bytes(images, "images.bin");
	put(cameras, 3, 8);
	put_camera(cameras, 7, 1, 4, focal);				   /* PINHOLE */
	put_camera(cameras, 4000000000u, 0, 3, (double[]){600, 320, 240}); /* SIMPLE_PINHOLE */
	put_camera(cameras, 2, 4, 8, focal);				   /* OPENCV, all 0 */
	put(images, 3, 8);
	/* A third of a turn about (1,1,1), of length 2: x to y, y to z, z to x. */
	put_image(images, (double[]){1, 1, 1, 1, 0.5, -1, 2}, 4000000000u, "left/b.jpg", 2);
	put_image(images, (double[]){1, 0, 0, 0, 0, 0, 3}, 7, "c.PNG", 0);
	put_image(images, (double[]){0, 0, 1, 0, 0, 0, 0}, 2, "right/a.jpeg", 1);
	save(cameras, cameras->len);
	save(images, images->len);
}

static void binary(void)
{
	static const double turn[3][4] = {{0, 0, 1, 0.5}, {1, 0, 0, -1}, {0, 1, 0, 2}};
	struct bytes cameras, images;
	struct cameras c;
	struct err e = {0};

	build_model(&cameras, &images);
	CHECK(colmap_is_model(dir), "the folder holds a model");
	int bad = colmap_read(&c, dir, &e);
	if (!CHECK(!bad, "%s", e.message))
		return;
	CHECK(c.n == 3, "%zu views", c.n);
	CHECK(!strcmp(c.views[0].name, "a") && !strcmp(c.views[1].name, "b") && !strcmp(c.views[2].name, "c"),
		"sorted by name: %s %s %s", c.views[0].name, c.views[1].name, c.views[2].name);
	CHECK(!strcmp(c.views[1].image, "left/b.jpg"), "image %s", c.views[1].image);
	for (int r = 0; r < 3; r++)
		for (int k = 0; k < 4; k++)
			CHECK(fabs(c.views[1].world_to_camera[r][k] - turn[r][k]) < 1e-15, "pose %d %d is %g",
				r, k, c.views[1].world_to_camera[r][k]);
	CHECK(c.views[0].world_to_camera[0][0] == -1 && c.views[0].world_to_camera[1][1] == 1,
		"half a turn about y");
	CHECK(c.views[1].fx == 600 && c.views[1].fy == 600 && c.views[1].cx == 320 && c.views[1].cy == 240,
		"SIMPLE_PINHOLE has one focal length");
	CHECK(c.views[2].fx == 500 && c.views[2].fy == 510 && c.views[2].cx == 320.5 &&
			c.views[2].cy == 239.25 && c.views[0].fy == 510 && c.views[0].width == 640 &&
			c.views[0].height == 480,
		"PINHOLE and OPENCV have two");
	cameras_free(&c);
	close(cameras.file);
	close(images.file);
}

/* Every cut is refused; a changed byte does no harm. */
static void broken(void)
{
	struct bytes files[2];
	struct cameras c;
	int accepted = 0, wrong_code = 0;

	build_model(&files[0], &files[1]);
	for (int f = 0; f < 2; f++) {
		for (size_t len = 0; len < files[f].len; len++) {
			struct err e = {0};
			save(&files[f], len);
			if (!colmap_read(&c, dir, &e)) {
				accepted++;
				cameras_free(&c);
			} else {
				wrong_code += e.code != ERR_FORMAT || c.views != NULL;
			}
		}
		for (size_t at = 0; at < files[f].len; at++) {
			struct err e = {0};
			files[f].data[at] ^= 0xff;
			save(&files[f], files[f].len);
			if (!colmap_read(&c, dir, &e))
				cameras_free(&c);
			else
				wrong_code += e.code != ERR_FORMAT;
			files[f].data[at] ^= 0xff;
		}
		save(&files[f], files[f].len);
		files[f].data[files[f].len++] = 0;
		save(&files[f], files[f].len);
		struct err e = {0};
		CHECK(colmap_read(&c, dir, &e) &&
				strstr(e.message, ": 1 bytes after the last entry, from offset"),
			"a byte too many: %s", e.message);
		save(&files[f], --files[f].len);
	}
	CHECK(accepted == 0, "%d cut files were read", accepted);
	CHECK(wrong_code == 0, "%d broken files gave another error", wrong_code);
	close(files[0].file);
	close(files[1].file);
}

/* Each model with all distortion 0, then with each coefficient set in turn. */
static void distortion(void)
{
	static const struct {
		uint32_t id;
		int params, first; /* of the distortion */
		int is_fisheye;
		const char *name;
	} models[] = {{0, 3, 3, 0, ""}, {1, 4, 4, 0, ""}, {2, 4, 3, 0, "SIMPLE_RADIAL"},
		{3, 5, 3, 0, "RADIAL"}, {4, 8, 4, 0, "OPENCV"}, {5, 8, 4, 1, "OPENCV_FISHEYE"},
		{6, 12, 4, 0, "FULL_OPENCV"}, {7, 5, 4, 0, "FOV"}, {8, 4, 3, 1, "SIMPLE_RADIAL_FISHEYE"},
		{9, 5, 3, 1, "RADIAL_FISHEYE"}, {10, 12, 4, 1, "THIN_PRISM_FISHEYE"},
		{11, 16, 4, 1, "RAD_TAN_THIN_PRISM_FISHEYE"}, {12, 4, 3, 0, "SIMPLE_DIVISION"},
		{13, 5, 4, 0, "DIVISION"}, {14, 3, 3, 1, "SIMPLE_FISHEYE"}, {15, 4, 4, 1, "FISHEYE"}};
	struct bytes b, images;
	struct cameras c;

	open_bytes(&images, "images.bin");
	put(&images, 1, 8);
	put_image(&images, (double[]){1, 0, 0, 0, 0, 0, 0}, 1, "a.jpg", 0);
	save(&images, images.len);
	open_bytes(&b, "cameras.bin");
	for (size_t m = 0; m < sizeof models / sizeof *models; m++)
		for (int bent = models[m].first - 1; bent < models[m].params; bent++) {
			double params[16] = {500, 500, 320, 240};
			struct err e = {0};
			for (int k = models[m].first; k < models[m].params; k++)
				params[k] = k == bent ? -1e-9 : 0;
			b.len = 0;
			put(&b, 1, 8);
			put_camera(&b, 1, models[m].id, models[m].params, params);
			save(&b, b.len);
			const int bad = colmap_read(&c, dir, &e),
				  is_bent = models[m].is_fisheye || bent >= models[m].first;
			CHECK(!bad, "model %u, parameter %d: %s", models[m].id, bent, e.message);
			const struct lens *l = bad ? NULL : &c.views[0].lens;
			CHECK(bad || !l->model == !is_bent, "model %u, parameter %d: has %s lens",
				models[m].id, bent, l->model ? "a" : "no");
			CHECK(bad || !is_bent ||
					(!strcmp(lens_model_name(l->model), models[m].name) &&
						!memcmp(l->parameters, params,
							(size_t)models[m].params * sizeof *params)),
				"model %u, parameter %d: another lens", models[m].id, bent);
			cameras_free(&c);
		}
	close(b.file);
	close(images.file);
}

static void random_pose(struct camera *v, struct rng *r, int i)
{
	double q[4], m[3][3], length = 0, centre[3];

	for (int k = 0; k < 4; k++) {
		q[k] = i < 4 ? k == i : rng_normal(r); /* first each half turn, where w is 0 */
		length += q[k] * q[k];
	}
	double s = 2 / length, w = q[0], x = q[1], y = q[2], z = q[3];
	double rows[3][3] = {{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
		{s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
		{s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}};
	memcpy(m, rows, sizeof m);
	for (int k = 0; k < 3; k++)
		centre[k] = rng_range(r, -5, 5);
	camera_set_centre(v, m, centre);
}

static void text_round_trip(void)
{
	struct camera views[40] = {0};
	struct cameras a = {40, views}, b;
	struct err e = {0};
	struct rng r;
	char names[40][32];
	double worst = 0;
	int same = 1;

	rng_seed(&r, 3, 1);
	for (int i = 0; i < 40; i++) {
		struct camera *v = &views[i];
		snprintf(names[i], sizeof names[i], i % 2 ? "images/a view %02d.png" : "a view %02d", i);
		*(i % 2 ? &v->image : &v->name) = names[i];
		v->width = 100 + i / 10;
		v->height = 80;
		v->fx = 90;
		v->fy = 91.0 / 3;
		v->cx = 50.125;
		v->cy = 40;
		random_pose(v, &r, i);
	}
	char sub[64];
	snprintf(sub, sizeof sub, "%s/sparse/0", dir);
	int bad = colmap_write_text(&a, sub, &e) || colmap_read(&b, sub, &e);
	if (!CHECK(!bad, "%s", e.message))
		return;
	CHECK(b.n == 40, "%zu views", b.n);
	for (size_t i = 0; i < b.n; i++) {
		const struct camera *v = &views[i], *w = &b.views[i];
		char want[32];
		snprintf(want, sizeof want, "a view %02zu", i);
		same = same && !strcmp(w->name, want) && w->width == v->width && w->height == v->height &&
		       w->fx == v->fx && w->fy == v->fy && w->cx == v->cx && w->cy == v->cy;
		for (int k = 0; k < 12; k++)
			worst = fmax(worst,
				fabs(v->world_to_camera[k / 4][k % 4] - w->world_to_camera[k / 4][k % 4]));
	}
	CHECK(same, "names, sizes and intrinsics are kept");
	CHECK(worst < 2e-15, "poses off by %g", worst);
	cameras_free(&b);
}

int main(void)
{
	if (!mkdtemp(dir))
		return 1;
	binary();
	broken();
	distortion();
	text_round_trip();
	static const char *const made[] = {"cameras.bin", "images.bin", "sparse/0/cameras.txt",
		"sparse/0/images.txt", "sparse/0/points3D.txt", "sparse/0", "sparse", ""};
	for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
		char path[128];
		snprintf(path, sizeof path, "%s/%s", dir, made[i]);
		CHECK(remove(path) == 0, "%s", path);
	}
	return unit_end();
}
