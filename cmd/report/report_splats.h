/* The Gaussians that a viewer shows: those of each lifted object side by side, and the rest. */
#ifndef CMD_REPORT_REPORT_SPLATS_H
#define CMD_REPORT_REPORT_SPLATS_H

#include "base/err.h"
#include "cmd/report/report_run.h"

#include <stddef.h>
#include <stdint.h>

/* Gaussians of less opacity are not shown: an eye hardly sees them, and they are many. */
#define REPORT_LEAST_OPACITY 0.03f

struct report_splats {
	size_t groups;	/* the rest, then each object of the lifted model */
	size_t *counts; /* (groups) */
	size_t n;	/* that are shown */
	uint8_t *bytes; /* (32,n): all first bytes of .splat (formats/splats/splat.md), then all second ones,
			   ... */
};

/* At most r->options->splats of them, those that cover most. Lengths keep 15 bits in positions and 7 in
 * sizes, as what is 0 packs well. Returns 0, or -1 with *e set; report_splats_free after either. */
int report_splats_make(struct report_splats *s, const struct report_run *r, struct err *e);
void report_splats_free(struct report_splats *s);

#endif
