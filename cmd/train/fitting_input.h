/* What gs-train learns from: photographs with their cameras, and the Gaussians that training begins with. */
#pragma once

#include "cmd/train/fitting.h"
#include "fit/parameters.h"
#include "fit/photograph.h"

struct fitting_input {
	const struct fitting_options *options;
	const struct report *to;
	char *path; /* of the cameras */
	struct cameras cameras;
	double offset[3];
	struct photograph *photographs; /* (cameras.n) those to learn from, those held out last, and then
					   those to test with */
	size_t learned, held_out, tested;
	const struct camera **seen; /* (learned) */
	struct fit_gaussians gaussians;
	double extent, size;
	uint32_t checksum; /* CRC-32 of all of it */
};

/* options and to are set, all else 0. Returns 0, or -1 with *e set; fitting_input_free after either. */
int fitting_input_read(struct fitting_input *f, struct err *e);
void fitting_input_free(struct fitting_input *f);

/* The name, for messages, of what the first Gaussians came from. */
const char *fitting_input_start(const struct fitting_input *f);
