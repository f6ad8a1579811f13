#include "cmd/import/frames.h"

#include "base/compare.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/mem.h"
#include "base/path.h"
#include "base/textfile.h"
#include "formats/splats/anysplats.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>

enum { MOST_DIGITS = 18 };

/* A file's name: what is before its last number, that, and what comes after. */
struct frame {
	const char *name;
	size_t begin, end; /* of the digits */
	long long number;
};

static int has_number(struct frame *f, const char *name)
{
	static const char digits[] = "0123456789";
	size_t end = strlen(name);

	while (end && !strchr(digits, name[end - 1]))
		end--;
	f->begin = f->end = end;
	while (f->begin && strchr(digits, name[f->begin - 1]))
		f->begin--;
	f->name = name;
	f->number = end - f->begin <= MOST_DIGITS ? strtoll(name + f->begin, NULL, 10) : -1;
	return end > 0 && f->number >= 0;
}

static int by_number(const void *a, const void *b)
{
	const struct frame *x = a, *y = b;

	return x->number != y->number ? COMPARE(x->number, y->number) : strcmp(x->name, y->name);
}

static int is_frame(const struct dirent *d)
{
	return path_ends(d->d_name, ".ply");
}

int frames_is_folder(const char *path, struct err *e)
{
	static const char *const trained[] = {"meta.json", "point_cloud", "point_cloud.ply"};
	struct dirent **names;

	for (size_t k = 0; k < sizeof trained / sizeof *trained; k++) {
		SCOPED char *part = file_join(path, trained[k], "", e);
		if (!part)
			return -1;
		if (file_exists(part))
			return 0;
	}
	const int n = file_is_dir(path) ? scandir(path, &names, is_frame, alphasort) : 0;
	if (n > 0)
		mem_free_strings((char **)names, (size_t)n);
	return n > 1;
}

/* Names differ in their numbers alone, and these have one step. */
static int check_sequence(const struct frame *f, size_t n, const char *folder, struct err *e)
{
	long long step = n > 1 ? f[1].number - f[0].number : 1;

	for (size_t i = 1; i < n; i++) {
		if (f[i].begin != f[0].begin || memcmp(f[i].name, f[0].name, f[0].begin) != 0 ||
			strcmp(f[i].name + f[i].end, f[0].name + f[0].end) != 0)
			return err_file(e, folder, "'%s' and '%s' are not frames of one sequence", f[0].name,
				f[i].name);
		if (f[i].number == f[i - 1].number)
			return err_file(e, folder, "'%s' and '%s' are one frame", f[i - 1].name, f[i].name);
		step = f[i].number - f[i - 1].number < step ? f[i].number - f[i - 1].number : step;
	}
	for (size_t i = 1; i < n; i++)
		if (f[i].number - f[i - 1].number != step)
			return err_file(e, folder, "frame %lld is missing, between '%s' and '%s'",
				f[i - 1].number + step, f[i - 1].name, f[i].name);
	return 0;
}

static int take_paths(
	char **paths, struct frame *frames, struct dirent **names, int n, const char *folder, struct err *e)
{
	for (int i = 0; i < n; i++)
		if (!has_number(&frames[i], names[i]->d_name))
			return err_file(e, folder, "'%s' has no number that says which frame it is",
				names[i]->d_name);
	qsort(frames, (size_t)n, sizeof *frames, by_number);
	for (int i = 0; i < n; i++)
		if (!(paths[i] = file_join(folder, frames[i].name, "", e)))
			return -1;
	return check_sequence(frames, (size_t)n, folder, e);
}

int frames_list(const char *folder, char ***paths, size_t *n, struct err *e)
{
	struct dirent **names;
	const int found = scandir(folder, &names, is_frame, alphasort);

	if (found < 0)
		return err_errno(e, "%s", folder);
	SCOPED struct frame *frames = mem_alloc((size_t)found, sizeof *frames, folder, e);
	*paths = mem_zalloc((size_t)found, sizeof **paths, folder, e);
	*n = *paths ? (size_t)found : 0;
	const int bad = !frames || !*paths || take_paths(*paths, frames, names, found, folder, e);
	mem_free_strings((char **)names, (size_t)found);
	return bad ? -1 : 0;
}

int frames_check_times(const double *times, size_t n, const char *path, struct err *e)
{
	for (size_t t = 0; t < n; t++)
		if (!isfinite(times[t]) || (t && !(times[t] > times[t - 1])))
			return err_file(
				e, path, "time %zu (%.17g) does not rise, or is not finite", t + 1, times[t]);
	return 0;
}

static int read_times(double *times, size_t n, const char *path, struct err *e)
{
	SCOPED char *text = NULL;
	size_t len, count = 0;

	if (textfile_read(path, &text, &len, e))
		return -1;
	for (char *at = text + strspn(text, " \t\r\n,"), *end; *at; at = end + strspn(end, " \t\r\n,")) {
		const double t = strtod(at, &end);
		if (end == at)
			return err_file(e, path, "item %zu ('%.*s') is not a number", count + 1,
				(int)strcspn(at, " \t\r\n,"), at);
		if (count < n)
			times[count] = t;
		count++;
	}
	if (count != n)
		return err_file(e, path, "has %zu times, and there are %zu frames", count, n);
	return frames_check_times(times, n, path, e);
}

int frames_times(double *times, size_t n, const char *how, const char *of, struct err *e)
{
	double from = 0, to = 1, rate = 0;
	char after, colon;

	if (how && sscanf(how, "%lf%c%lf%c", &from, &colon, &to, &after) == 3 && colon == ':') {
		if (!isfinite(from) || !isfinite(to) || !(to > from))
			return err_set(e, ERR_USAGE, "--times: '%s' is not T0:T1 with T1 above T0", how);
	} else if (how && path_ends(how, "fps") && strspn(how, "0123456789.") == strlen(how) - 3) {
		if (!((rate = strtod(how, NULL)) > 0))
			return err_set(e, ERR_USAGE, "--times: '%s' is not a rate above 0", how);
	} else if (how) {
		return read_times(times, n, how, e);
	}
	for (size_t t = 0; t < n; t++)
		times[t] = rate > 0 ? (double)t / rate
			   : n > 1  ? from + (to - from) * (double)t / (double)(n - 1)
				    : from;
	return frames_check_times(times, n, of, e);
}

/* What stays, of Gaussian i; with standard deviations or without. */
static uint64_t hash_of(const struct splats *s, size_t i, int with_scales)
{
	const size_t width = 3 * (size_t)s->sh_coefficients;
	const uint64_t hash =
		hash64(s->sh + width * i, width * sizeof(float), hash64(s->opacities + i, sizeof(float), 0));

	return with_scales ? hash64(s->scales + 3 * i, 3 * sizeof(float), hash) : hash;
}

struct hashed {
	uint64_t hash;
	size_t i;
};

static int by_hash(const void *a, const void *b)
{
	const struct hashed *x = a, *y = b;

	return x->hash != y->hash ? COMPARE(x->hash, y->hash) : COMPARE(x->i, y->i);
}

/* 1 where the Gaussians that differ are the same in another order: *from of the first is *to. */
static int is_reordered(const struct splats *first, const struct splats *s, int with_scales, size_t *from,
	size_t *to, struct err *e)
{
	const size_t n = first->n;
	SCOPED struct hashed *a = mem_alloc(n, sizeof *a, "splats", e),
			     *b = mem_alloc(n, sizeof *b, "splats", e);
	int is_same = 1;

	if (!a || !b)
		return -1;
	for (size_t i = 0; i < n; i++) {
		a[i] = (struct hashed){hash_of(first, i, with_scales), i};
		b[i] = (struct hashed){hash_of(s, i, with_scales), i};
	}
	qsort(a, n, sizeof *a, by_hash);
	qsort(b, n, sizeof *b, by_hash);
	*from = *to = 0;
	for (size_t i = 0; i < n && is_same; i++) {
		is_same = a[i].hash == b[i].hash;
		if (a[i].i != b[i].i && *from == *to) {
			*from = a[i].i;
			*to = b[i].i;
		}
	}
	return is_same && *from != *to;
}

static int differs(const float *a, const float *b, size_t width, size_t i)
{
	return memcmp(a + width * i, b + width * i, width * sizeof *a) != 0;
}

static int check_order(const struct splats *first, const struct splats *s, const char *first_path,
	const char *path, struct err *e)
{
	const size_t width = 3 * (size_t)first->sh_coefficients;
	size_t changed = 0, resized = 0, which = 0, from, to;

	for (size_t i = 0; i < s->n; i++) {
		const int is_other =
			differs(s->opacities, first->opacities, 1, i) || differs(s->sh, first->sh, width, i);
		which = is_other && !changed ? i : which;
		changed += (size_t)is_other;
		resized += (size_t)differs(s->scales, first->scales, 3, i);
	}
	if (!changed && !resized)
		return 0;
	int found = is_reordered(first, s, 1, &from, &to, e);
	if (!found && changed)
		found = is_reordered(first, s, 0, &from, &to, e);
	if (found > 0)
		return err_file(e, path,
			"the order of its Gaussians is another than in %s (Gaussian %zu is there what %zu is here, by opacity and colour): export frames in one order",
			first_path, from, to);
	if (found < 0 || !changed)
		return found;
	return err_file(e, path,
		"opacity or colour of %zu Gaussians, the first of them %zu, is another than in %s: only places, rotations and sizes may change",
		changed, which, first_path);
}

int frames_read(struct splats *s, const struct ply_like *like, const double offset[3], const char *first_path,
	const char *path, struct err *e)
{
	const struct splats *first = like->splats;
	struct rows_report rows = {0};
	double own[3] = {0};

	if (anysplats_read_like(s, own, &rows, path, like, e))
		return -1;
	const size_t bad = rows.not_finite + rows.zero_quat, which = bad ? rows.dropped[0] : 0;
	free(rows.dropped);
	if (rows.read != first->n)
		return err_file(
			e, path, "holds %zu Gaussians, %s holds %zu", rows.read, first_path, first->n);
	if (bad)
		return err_file(e, path, FRAMES_NOT_FINITE, which);
	if (s->sh_coefficients != first->sh_coefficients)
		return err_file(e, path, "has harmonics of another degree than %s", first_path);
	for (size_t i = 0; i < 3 * s->n; i++)
		if (own[i % 3] != offset[i % 3])
			s->means[i] = (float)((double)s->means[i] + (own[i % 3] - offset[i % 3]));
	return check_order(first, s, first_path, path, e);
}
