/* Modules and splats stand in the page packed (zlib) and as base64, in scripts of no language;
 * report_viewer.js unpacks them when the scene is first looked at. */
#include "cmd/report/reporting.h"

#include "base/base64.h"
#include "base/compare.h"
#include "base/embed.h"
#include "base/file.h"
#include "base/mem.h"
#include "cmd/text/encode.h"
#include "formats/splats/splat.h"
#include "geom/up.h"

#include <math.h>
#include <zlib.h>

/* Gaussians of less opacity are not shown: an eye hardly sees them, and they are many. */
#define REPORT_LEAST_OPACITY 0.03f

struct shown {
	size_t gaussian, group;
	double size; /* opacity times area */
};

static int largest_first(const void *a, const void *b)
{
	const struct shown *x = a, *y = b;

	return x->size != y->size ? COMPARE(y->size, x->size) : COMPARE(x->gaussian, y->gaussian);
}

static int by_group(const void *a, const void *b)
{
	const struct shown *x = a, *y = b;

	return x->group != y->group ? COMPARE(x->group, y->group) : largest_first(a, b);
}

/* groups (N): 1 + the object that has most of each Gaussian, where that is more than its cut; else 0. */
static int find_groups(const struct report_run *r, size_t *groups, struct err *e)
{
	const struct lifted *l = &r->lifted.lifted;
	SCOPED float *best = mem_zalloc(r->scene.splats.n, sizeof *best, "splats", e);

	if (!best)
		return -1;
	for (size_t o = 0; r->has_lifted && o < l->objects; o++)
		for (int64_t k = l->indptr[o]; k < l->indptr[o + 1]; k++) {
			const size_t i = (size_t)l->index[k];
			if (l->share[k] <= lifted_cut_of(l, o) || l->share[k] <= best[i])
				continue;
			best[i] = l->share[k];
			groups[i] = 1 + o;
		}
	return 0;
}

/* Those that are seen, the largest first. Returns how many. */
static size_t find_shown(const struct splats *s, const size_t *groups, struct shown *shown)
{
	size_t n = 0;

	for (size_t i = 0; i < s->n; i++) {
		const float *scale = s->scales + 3 * i;
		const double a = (double)scale[0], b = (double)scale[1], c = (double)scale[2];
		const double area =
			a * b > a * c ? (a * b > b * c ? a * b : b * c) : (a * c > b * c ? a * c : b * c);
		if (s->opacities[i] >= REPORT_LEAST_OPACITY)
			shown[n++] = (struct shown){i, groups[i], area * (double)s->opacities[i]};
	}
	qsort(shown, n, sizeof *shown, largest_first);
	return n;
}

/* Drops the low bits of a float's mantissa. */
static void round_float(unsigned char *bytes, int zeros)
{
	for (int k = 0; k < zeros; k++)
		bytes[k] = 0;
}

static void pack(struct report_splats *to, const struct splats *s, const struct shown *shown)
{
	unsigned char one[SPLAT_BYTES];

	for (size_t i = 0; i < to->n; i++) {
		splat_pack(one, s, shown[i].gaussian);
		for (int k = 0; k < 3; k++) {
			round_float(one + 4 * k, 1);
			round_float(one + 12 + 4 * k, 2);
		}
		for (size_t k = 0; k < SPLAT_BYTES; k++)
			to->bytes[k * to->n + i] = one[k];
		to->counts[shown[i].group]++;
	}
}

int report_splats_make(struct report_splats *s, const struct report_run *r, struct err *e)
{
	const struct splats *from = &r->scene.splats;
	SCOPED size_t *groups = mem_zalloc(from->n, sizeof *groups, "splats", e);
	SCOPED struct shown *shown = mem_alloc(from->n, sizeof *shown, "splats", e);

	*s = (struct report_splats){.groups = 1 + (r->has_lifted ? r->lifted.lifted.objects : 0)};
	s->counts = mem_zalloc(s->groups, sizeof *s->counts, "splats", e);
	int bad = !groups || !shown || !s->counts || find_groups(r, groups, e);
	if (!bad) {
		const size_t n = find_shown(from, groups, shown), most = (size_t)r->options->splats;
		s->n = n < most ? n : most;
		qsort(shown, s->n, sizeof *shown, by_group);
		bad = !(s->bytes = mem_alloc(s->n, SPLAT_BYTES, "splats", e));
	}
	if (!bad)
		pack(s, from, shown);
	return bad ? -1 : 0;
}

void report_splats_free(struct report_splats *s)
{
	mem_free_all(s->counts, s->bytes);
	*s = (struct report_splats){0};
}

EMBED(report_viewer, "cmd/report/report_viewer.js");

/* What `make viewer` puts into its folder, by the names under which they import each other. */
const struct report_module report_modules[REPORT_MODULES] = {
	{"./three.core.min.js", "three.core.min.js"},
	{"three", "three.module.min.js"},
	{"three/addons/postprocessing/Pass.js", "Pass.js"},
	{"orbit", "OrbitControls.js"},
	{"spark", "spark.module.min.js"},
};

static int put_packed(FILE *out, const char *attributes, const void *bytes, size_t n, struct err *e)
{
	uLongf length = compressBound((uLong)n);
	SCOPED uint8_t *packed = mem_alloc(length, 1, "viewer", e);
	SCOPED char *text = NULL;

	if (packed && compress2(packed, &length, bytes, (uLong)n, Z_BEST_COMPRESSION) != Z_OK)
		err_set(e, ERR_SYSTEM, "viewer: cannot be packed");
	else if (packed)
		text = base64_text("", packed, length, e);
	if (text)
		fprintf(out, "<script type=\"text/plain\" %s>%s</script>\n", attributes, text);
	return text ? 0 : -1;
}

static int put_modules(FILE *out, const char *dir, struct err *e)
{
	for (size_t k = 0; k < REPORT_MODULES; k++) {
		SCOPED char *path = file_join(dir, report_modules[k].file, "", e), *bytes = NULL;
		char attributes[80];
		size_t n;
		snprintf(attributes, sizeof attributes, "data-module=\"%s\"", report_modules[k].name);
		const int bad =
			!path || file_read(path, &bytes, &n, e) || put_packed(out, attributes, bytes, n, e);
		if (bad)
			return -1;
	}
	return 0;
}

/* To six digits of the largest. */
static void put_numbers(struct jsontext *to, const char *key, const double x[3])
{
	double most = 0;

	for (int k = 0; k < 3; k++)
		most = fmax(most, fabs(x[k]));
	const double digits = most > 0 ? pow(10, 5 - floor(log10(most))) : 1;
	jsontext_open(to, key, '[');
	for (int k = 0; k < 3; k++)
		jsontext_number(to, NULL, round(x[k] * digits) / digits);
	jsontext_close(to, ']');
}

static void put_box(struct jsontext *to, const struct box *b)
{
	jsontext_open(to, "box", '{');
	jsontext_open(to, "axes", '[');
	for (int k = 0; k < 3; k++)
		put_numbers(to, NULL, b->axes[k]);
	jsontext_close(to, ']');
	put_numbers(to, "centre", b->centre);
	put_numbers(to, "half", b->half);
	jsontext_close(to, '}');
}

static void put_groups(struct jsontext *to, const struct report_run *r, const struct report_splats *s)
{
	const struct extent *extents = r->lifted.extents;

	jsontext_open(to, "groups", '[');
	for (size_t g = 0; g < s->groups; g++) {
		jsontext_open(to, NULL, '{');
		jsontext_number(to, "count", (double)s->counts[g]);
		if (g)
			jsontext_string(to, "name", r->lifted.lifted.names[g - 1]);
		if (g && extents[g - 1].n)
			put_box(to, &extents[g - 1].turned);
		jsontext_close(to, '}');
	}
	jsontext_close(to, ']');
}

/* Where the viewer begins: the first view that has a picture. */
static void put_camera(struct jsontext *to, const struct report_run *r)
{
	const struct camera *c = r->shown_count ? &r->shown[0] : NULL;
	double centre[3], up[3];

	jsontext_open(to, "camera", '{');
	if (c) {
		camera_centre(c, centre);
		jsontext_string(to, "name", c->name);
		put_numbers(to, "centre", centre);
		put_numbers(to, "forward", c->world_to_camera[2]);
		jsontext_number(to, "tan_x", round(5e4 * c->width / c->fx) / 1e5);
		jsontext_number(to, "tan_y", round(5e4 * c->height / c->fy) / 1e5);
	}
	jsontext_close(to, '}');
	cameras_up(&r->scene.cameras, up);
	put_numbers(to, "up", up);
}

/* Both ask to be handed on with their licences. */
static int put_licences(struct jsontext *to, const char *dir, struct err *e)
{
	static const char *const files[] = {"LICENSE.spark", "LICENSE.three"};

	jsontext_open(to, "licences", '[');
	for (size_t k = 0; k < 2; k++) {
		SCOPED char *path = file_join(dir, files[k], "", e), *text = NULL;
		size_t n;
		if (!path || file_read(path, &text, &n, e))
			return -1;
		jsontext_string(to, NULL, text);
	}
	jsontext_close(to, ']');
	return 0;
}

int report_scene_put(struct jsontext *to, const struct report_run *r, const struct report_splats *s,
	const char *viewer, struct err *e)
{
	jsontext_number(to, "count", (double)s->n);
	jsontext_number(to, "most", (double)r->options->splats);
	jsontext_number(to, "all", (double)r->scene.splats.n);
	jsontext_rounded(to, "least_opacity", (double)REPORT_LEAST_OPACITY);
	put_groups(to, r, s);
	put_camera(to, r);
	return viewer ? put_licences(to, viewer, e) : 0;
}

static int put_scene(
	FILE *out, const struct report_run *r, const struct report_splats *s, const char *dir, struct err *e)
{
	struct jsontext to = {.out = out, .is_page = 1};

	fputs("<script type=\"application/json\" id=\"scene\">", out);
	jsontext_open(&to, NULL, '{');
	const int bad = report_scene_put(&to, r, s, dir, e);
	jsontext_close(&to, '}');
	fputs("</script>\n", out);
	return bad;
}

static int put_viewer(FILE *out, struct report_run *r, const char *dir, struct err *e)
{
	SCOPED_BY(report_splats_free) struct report_splats s = {0};

	if (report_splats_make(&s, r, e) || anymodel_place(&r->lifted, &r->scene, e) ||
		put_modules(out, dir, e) || put_scene(out, r, &s, dir, e) ||
		put_packed(out, "id=\"splats\"", s.bytes, 32 * s.n, e))
		return -1;
	fprintf(out, "<script>\n%s</script>\n", report_viewer_begin);
	return 0;
}

int report_viewer_put(FILE *out, struct report_run *r, const struct report *to, struct err *e)
{
	const char *given = r->options->viewer;

	if (r->options->is_plain)
		return 0;
	SCOPED char *dir = given ? mem_strdup(given, e) : cache_folder("viewer", e);
	if (!dir)
		return given ? -1 : 0;
	int bad = 0;
	if (given || file_is_dir(dir))
		bad = put_viewer(out, r, dir, e);
	else
		report_note(to, 1, "%s: no viewer there: 'make viewer' fetches one", dir);
	return bad;
}
