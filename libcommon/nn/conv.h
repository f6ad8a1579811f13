/* Layers of a convolutional network, forward only, on float images whose channels lie together: pixel (y,x)
 * has its channels from data + (y width + x) stride on. An image may be some channels of a wider one, which
 * then is the concatenation of its parts.
 *
 * A convolution is a product of matrices (nn/linear.h): a row for each pixel of the result, of what is under
 * the kernel there. So its bytes do not depend on the number of threads. Kernels: they cannot fail. */
#pragma once

#include <stddef.h>

struct conv_image {
	float *data;
	size_t height, width, channels;
	size_t stride; /* floats from a pixel to the next, at least channels */
};

struct conv {
	size_t side, step;    /* of the kernel, 1 or 3; from a pixel of the result to the next */
	size_t in, out;	      /* channels */
	float *weight, *bias; /* (side,side,in,out), rows of the kernel first; (out) */
};

/* What `size` pixels become by steps of `step`, with (side - 1) / 2 pixels of zeros around them. */
static inline size_t conv_size(size_t size, size_t step)
{
	return (size - 1) / step + 1;
}

/* Floats of scratch for a result of so many pixels. */
static inline size_t conv_scratch(const struct conv *c, size_t pixels)
{
	return c->side == 1 ? 0 : pixels * c->side * c->side * c->in;
}

/* out = f(c(in)), f(x) = x above 0 and `leak` x below it; 1: f(x) = x. Steps of a kernel of side 1 are 1. */
void conv_forward(
	const struct conv *c, struct conv_image out, struct conv_image in, float leak, float *scratch);

/* The largest of 3 x 3 pixels, or of those of them that there are, by steps of 2. */
void conv_largest(struct conv_image out, struct conv_image in);

/* out += in at the size of out, linear between the centres of pixels. */
void conv_add_resized(struct conv_image out, struct conv_image in);
