#include "splat/splats.h"

#include "base/mem.h"

#include <stdlib.h>

int splats_alloc(struct splats *s, size_t n, int sh_coefficients, struct err *e)
{
	*s = (struct splats){.n = n, .sh_coefficients = sh_coefficients};
	s->means = mem_alloc(n, 3 * sizeof(float), "means", e);
	s->scales = mem_alloc(n, 3 * sizeof(float), "scales", e);
	s->quats = mem_alloc(n, 4 * sizeof(float), "quats", e);
	s->opacities = mem_alloc(n, sizeof(float), "opacities", e);
	s->sh = mem_alloc(n, 3 * (size_t)sh_coefficients * sizeof(float), "sh", e);
	if (s->means && s->scales && s->quats && s->opacities && s->sh)
		return 0;
	splats_free(s);
	return -1;
}

void splats_free(struct splats *s)
{
	free(s->means);
	free(s->scales);
	free(s->quats);
	free(s->opacities);
	free(s->sh);
	*s = (struct splats){0};
}
