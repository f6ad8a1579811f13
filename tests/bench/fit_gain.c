/* A picture with another exposure: fit_gain GAIN IN OUT multiplies it, and limits it to what a PNG holds. */
#include "formats/images/png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
	struct err e;
	uint8_t *rgb;
	int height, width;

	if (argc != 4 || image_read_rgb(argv[2], &rgb, &height, &width, &e)) {
		fprintf(stderr, "fit_gain: %s\n", argc == 4 ? e.message : "usage: fit_gain GAIN IN OUT");
		return 3;
	}
	const double gain = atof(argv[1]);
	for (size_t i = 0; i < 3 * (size_t)height * (size_t)width; i++)
		rgb[i] = (uint8_t)fmin(255, gain * rgb[i] + 0.5);
	const int bad = png_write(argv[3], rgb, height, width, 3, &e);
	if (bad)
		fprintf(stderr, "fit_gain: %s\n", e.message);
	free(rgb);
	return bad ? 3 : 0;
}
