/* bench_psnr SCENE OTHER: how alike two scenes of the same cameras look: the mean and the least PSNR in dB of
 * every fourth view, at a quarter of its size. */
#include "formats/scene/scene.h"
#include "splat/render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { STEP = 4 };

static float *draw(const struct splats *s, const struct camera *c)
{
	static const float black[3];
	struct err e;
	float *rgb = malloc(3 * sizeof *rgb * (size_t)c->width * (size_t)c->height);
	struct render_view *v = render_prepare(s, c, &e);

	if (!rgb || !v || render_colors(v, s, c, black, rgb, &e))
		exit(1);
	render_free(v);
	return rgb;
}

static double psnr(const struct scene *a, const struct scene *b, const struct camera *view)
{
	int width, height;
	double sum = 0;

	camera_scaled_size(view, 0.25, &width, &height);
	const struct camera c = camera_resize(view, width, height);
	float *p = draw(&a->splats, &c), *q = draw(&b->splats, &c);
	const size_t n = 3 * (size_t)width * (size_t)height;
	for (size_t i = 0; i < n; i++)
		sum += pow((double)p[i] - (double)q[i], 2);
	free(p);
	free(q);
	return -10 * log10(sum / (double)n);
}

int main(int argc, char **argv)
{
	struct scene a, b;
	struct err e;
	double sum = 0, least = INFINITY;
	int views = 0;

	if (argc != 3 || scene_read(&a, argv[1], &e) || scene_read(&b, argv[2], &e)) {
		fprintf(stderr, "bench_psnr: %s\n", argc == 3 ? e.message : "usage: bench_psnr SCENE OTHER");
		return 1;
	}
	for (size_t i = 0; i < a.cameras.n; i += STEP, views++) {
		const double one = psnr(&a, &b, &a.cameras.views[i]);
		sum += one;
		least = fmin(least, one);
	}
	printf("%.1f\t%.1f\n", sum / views, least);
	scene_free(&a);
	scene_free(&b);
	return 0;
}
