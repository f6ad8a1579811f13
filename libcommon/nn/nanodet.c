#include "nn/nanodet.h"

#include "nn/slab.h"

#include <stdlib.h>

enum { STAGES = 4, LEVELS = 3, WIDTH = 128 };

static const float leak = 0.1f;
static const size_t widths[STAGES] = {32, 64, 128, 256}, steps[STAGES] = {1, 2, 2, 2},
		    turns[STAGES] = {1, 2, 2, 3};

static struct conv *size(struct conv *c, size_t side, size_t step, size_t in, size_t out)
{
	*c = (struct conv){.side = side, .step = step, .in = in, .out = out};
	return c + 1;
}

static void set_sizes(struct nanodet *n)
{
	struct conv *c = size(n->convs, 3, 2, 3, widths[0]);
	size_t in = widths[0];

	for (int s = 0; s < STAGES; s++) {
		const size_t w = widths[s];
		c = size(c, 3, steps[s], in, w);
		for (size_t t = 0; t < turns[s]; t++) {
			c = size(c, 3, 1, w, w / 2);
			c = size(c, 3, 1, w / 2, w / 2);
		}
		c = size(c, 3, 1, w, w);
		in = 2 * w;
	}
	for (int l = 0; l < LEVELS; l++)
		c = size(c, 1, 1, 2 * widths[STAGES - LEVELS + l], WIDTH);
	for (int l = 0; l < LEVELS; l++) {
		c = size(c, 3, 1, WIDTH, WIDTH);
		c = size(c, 1, 1, WIDTH, NANODET_OUT);
	}
}

static void lay_out(void *of, struct slab *s)
{
	struct nanodet *n = of;

	for (int i = 0; i < NANODET_CONVS; i++) {
		struct conv *c = &n->convs[i];
		c->weight = slab_take(s, c->side * c->side * c->in, c->out);
		c->bias = slab_take(s, 1, c->out);
	}
}

int nanodet_alloc(struct nanodet *n, struct err *e)
{
	set_sizes(n);
	n->slab = slab_alloc(lay_out, n, "detector", e);
	return n->slab ? 0 : -1;
}

void nanodet_free(struct nanodet *n)
{
	free(n->slab);
	n->slab = NULL;
}

/* A pass through the network, which without memory only counts what it takes. */
struct pass {
	const struct conv *next;
	struct slab slab; /* of the images */
	float *scratch;	  /* for a convolution */
	size_t most;	  /* of that */
};

static struct conv_image take(struct pass *p, size_t height, size_t width, size_t channels)
{
	return (struct conv_image){
		slab_take(&p->slab, height * width, channels), height, width, channels, channels};
}

/* Channels from `first` on. */
static struct conv_image part(struct conv_image x, size_t first, size_t channels)
{
	x.data = x.data ? x.data + first : NULL;
	x.channels = channels;
	return x;
}

static void convolve(struct pass *p, struct conv_image out, struct conv_image in, float slope)
{
	const struct conv *c = p->next++;
	const size_t scratch = conv_scratch(c, out.height * out.width);

	p->most = scratch > p->most ? scratch : p->most;
	if (p->slab.at)
		conv_forward(c, out, in, slope, p->scratch);
}

static struct conv_image stage(struct pass *p, struct conv_image in, int s)
{
	const size_t w = widths[s], height = conv_size(in.height, steps[s]),
		     width = conv_size(in.width, steps[s]);
	const struct conv_image all = take(p, height, width, 2 * w), x = part(all, w, w);
	struct conv_image y = x;

	convolve(p, x, in, leak);
	for (size_t t = 0; t < turns[s]; t++) {
		const struct conv_image both = take(p, height, width, w), h = part(both, w / 2, w / 2);
		convolve(p, h, y, leak);
		convolve(p, part(both, 0, w / 2), h, leak);
		y = both;
	}
	convolve(p, part(all, 0, w), y, leak);
	return all;
}

static void add(const struct pass *p, struct conv_image to, struct conv_image from)
{
	if (p->slab.at)
		conv_add_resized(to, from);
}

static void run(struct pass *p, struct conv_image in, float *out)
{
	const size_t half = conv_size(in.height, 2), quarter = conv_size(half, 2);
	const struct conv_image first = take(p, half, half, widths[0]);
	struct conv_image x = take(p, quarter, quarter, widths[0]), levels[LEVELS];

	convolve(p, first, in, leak);
	if (p->slab.at)
		conv_largest(x, first);
	for (int s = 0; s < STAGES; s++) {
		x = stage(p, x, s);
		if (s >= STAGES - LEVELS)
			levels[s - (STAGES - LEVELS)] = x;
	}
	for (int l = 0; l < LEVELS; l++) {
		x = take(p, levels[l].height, levels[l].width, WIDTH);
		convolve(p, x, levels[l], 1);
		levels[l] = x;
	}
	for (int l = LEVELS - 1; l > 0; l--)
		add(p, levels[l - 1], levels[l]);
	for (int l = 1; l < LEVELS; l++)
		add(p, levels[l], levels[l - 1]);
	for (int l = 0; l < LEVELS; l++) {
		const size_t height = levels[l].height, width = levels[l].width;
		x = take(p, height, width, WIDTH);
		convolve(p, x, levels[l], leak);
		convolve(p, (struct conv_image){out, height, width, NANODET_OUT, NANODET_OUT}, x, 1);
		out = out ? out + height * width * NANODET_OUT : NULL;
	}
}

static const struct conv_image picture = {NULL, NANODET_SIDE, NANODET_SIDE, 3, 3};

/* What a pass takes, of images and for a convolution. */
static struct pass count(const struct nanodet *n)
{
	struct pass p = {.next = n->convs};

	run(&p, picture, NULL);
	return p;
}

size_t nanodet_scratch(const struct nanodet *n)
{
	const struct pass p = count(n);

	return p.slab.used + p.most;
}

void nanodet_forward(const struct nanodet *n, float *out, float *in, float *scratch)
{
	struct pass p = {.next = n->convs, .slab.at = scratch, .scratch = scratch + count(n).slab.used};
	struct conv_image x = picture;

	x.data = in;
	run(&p, x, out);
}
