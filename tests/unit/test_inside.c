/* What is of a thing though no view shows it, and what is not: the ghost that would stay when it is removed.
 */
#include "unit.h"

#include "base/rng.h"
#include "lift/inside.h"
#include "splat/visibility.h"
#include "synth/synth_scene.h"

enum { MOST = 12000 };
enum kind { SHELL, BACK, TABLE, UNDER, BALL, BALL_INSIDE, FAR_BEHIND, KINDS };
static const char *const kinds[KINDS] = {
	"shell", "inside", "table", "under the foot", "ball", "inside the ball", "far behind"};

struct room {
	struct splats splats;
	char of[MOST], taken[MOST];
	float most[MOST], responses[MOST];
	int32_t ids[MOST];
	size_t n, own;
};

/* A point of a kind, in a box without a lid, 2 wide and 1 high, that stands on a table; a ball lies in it. */
static void put(struct room *r, enum kind kind, struct rng *rng)
{
	float *m = r->splats.means + 3 * r->n;
	double p[3], length = 0;

	for (int k = 0; k < 3; k++) {
		p[k] = 2 * rng_uniform(rng) - 1;
		length += p[k] * p[k];
	}
	const double ball = 0.35 / sqrt(length) * (kind == BALL_INSIDE ? 0.5 : 1);
	const int wall = (int)(4 * rng_uniform(rng)), is_ball = kind == BALL || kind == BALL_INSIDE;
	for (int k = 0; k < 3; k++)
		m[k] = (float)(is_ball ? ball * p[k] : p[k]);
	m[2] = (float)(is_ball ? 0.5 + ball * p[2] : 0.5 + 0.5 * p[2]);
	if (kind == SHELL || kind == BACK)
		m[wall & 1] = (float)((wall & 2 ? 1 : -1) * (kind == SHELL ? 1 : 0.93));
	if (kind == TABLE || kind == UNDER)
		m[2] = kind == TABLE ? 0 : -0.15F;
	if (kind == TABLE)
		m[0] += m[0] > 0 ? 1.1F : -1.1F;
	if (kind == FAR_BEHIND)
		m[1] += 3;
	r->of[r->n] = (char)kind;
	r->most[r->n] = kind == SHELL || kind == TABLE || kind == BALL ? 0.6F : 0.001F;
	r->taken[r->n] = kind == SHELL;
	if (kind == SHELL)
		r->ids[r->own++] = (int32_t)r->n;
	r->responses[r->n++] = 0.5F;
}

static double share_taken(const struct room *r, enum kind kind)
{
	size_t n = 0, taken = 0;

	for (size_t i = 0; i < r->n; i++)
		if (r->of[i] == (char)kind) {
			n++;
			taken += r->taken[i] != 0;
		}
	return (double)taken / (double)n;
}

/* A thing at any size and place. */
static void a_box_goes_without_what_is_in_it(void)
{
	static const double up[3] = {0, 0, 1}, least[KINDS] = {1, 0.97},
			    most[KINDS] = {1, 1, 0, 0.02, 0, 0.02, 0};
	static struct room r;
	struct rng rng;
	struct err e;

	if (splats_alloc(&r.splats, MOST, 1, &e))
		exit(1);
	for (int scale = 0; scale < 3; scale++) {
		struct extent x;
		rng_seed(&rng, 3, 1);
		r.n = r.own = 0;
		while (r.n < MOST)
			put(&r, (enum kind)(r.n % KINDS), &rng);
		for (size_t i = 0; i < 3 * r.n; i++)
			r.splats.means[i] = r.splats.means[i] * (float)pow(100, scale - 1) + (float)scale;
		for (size_t i = 0; i < r.n; i++) {
			memset(r.splats.scales + 3 * i, 0, 3 * sizeof(float));
			memcpy(r.splats.quats + 4 * i, (float[4]){1}, 4 * sizeof(float));
		}
		CHECK(!extent_find(&x, &r.splats, r.ids, r.responses, r.own, up, &e), "%s", e.message);
		CHECK(!inside_take(r.taken, &x, &r.splats, r.most, NULL, &e), "%s", e.message);
		for (enum kind k = 0; k < KINDS; k++) {
			const double share = share_taken(&r, k);
			CHECK(share >= least[k] && share <= most[k], "size %d, %s: %g", scale, kinds[k],
				share);
		}
		extent_free(&x);
	}
	splats_free(&r.splats);
}

/* What the views show of each thing of a synthetic scene, and what is inside it. */
static void of_a_scene_more_is_taken_and_little_of_others(void)
{
	const struct synth_preset *p = synth_preset(0);
	const struct synth_options o = {p, 5, p->objects, p->views, p->width, p->height, 8000, 0, 0};
	static const double up[3] = {0, 0, 1};
	double before = 0, after = 0, wrong = 0, all = 0;
	struct synth_scene s;
	struct err e;

	if (!CHECK(!synth_scene_make(&s, &o, &e), "%s", e.message))
		return;
	const size_t n = s.splats.n;
	float *most = malloc(n * sizeof *most), *responses = malloc(n * sizeof *responses);
	char *taken = malloc(n), *others = malloc(n);
	int32_t *ids = malloc(n * sizeof *ids);
	CHECK(!visibility_most(&s.splats, &s.cameras, most, &e), "%s", e.message);
	for (int k = 0; k < s.object_count; k++) {
		struct extent x;
		size_t own = 0;
		for (size_t i = 0; i < n; i++) {
			taken[i] = s.owner[i] == k && most[i] > INSIDE_SHOWN;
			others[i] = s.owner[i] >= 0 && s.owner[i] != k && most[i] > INSIDE_SHOWN;
			before += taken[i];
			all += s.owner[i] == k;
			if (taken[i]) {
				responses[own] = 1;
				ids[own++] = (int32_t)i;
			}
		}
		CHECK(!extent_find(&x, &s.splats, ids, responses, own, up, &e) &&
				!inside_take(taken, &x, &s.splats, most, others, &e),
			"%s", e.message);
		for (size_t i = 0; i < n; i++) {
			after += taken[i] && s.owner[i] == k;
			wrong += taken[i] && s.owner[i] != k;
		}
		extent_free(&x);
	}
	printf("own taken: %.3f of what is shown alone, %.3f with what is inside; of others %.3f as much\n",
		before / all, after / all, wrong / all);
	CHECK(after / all > before / all + 0.15, "own: %g before, %g after", before / all, after / all);
	CHECK(wrong / all < 0.04, "others: %g", wrong / all);
	free(most);
	free(responses);
	free(taken);
	free(others);
	free(ids);
	synth_scene_free(&s);
}

int main(void)
{
	a_box_goes_without_what_is_in_it();
	of_a_scene_more_is_taken_and_little_of_others();
	return unit_end();
}
