/* A file of splats in memory, by the reader of one format, as anysplats_read_like calls it. */
#pragma once

#include "base/mem.h"
#include "formats/splats/anysplats.h"

static inline int read_as(
	anysplats_reader *read, struct splats *s, double offset[3], struct file_map *map, struct err *e)
{
	struct rows_report report = {0};

	*s = (struct splats){0};
	const int bad = read(s, offset, &report, "f", map, e);
	if (bad)
		splats_free(s);
	free(report.dropped);
	file_unmap(map);
	return bad;
}
