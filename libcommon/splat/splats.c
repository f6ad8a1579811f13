#include "splat/splats.h"

#include "base/mem.h"

int splats_alloc(struct splats *s, size_t n, int sh_coefficients, struct err *e)
{
	*s = (struct splats){.n = n, .sh_coefficients = sh_coefficients, .near = SPLATS_NEAR};
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
	mem_free_all(s->means, s->scales, s->quats, s->opacities, s->sh);
	*s = (struct splats){0};
}

void splats_keep_means(struct splats *s)
{
	mem_free_all(s->scales, s->quats, s->opacities, s->sh);
	*s = (struct splats){.n = s->n, .near = s->near, .means = s->means};
}

int splats_keep(struct splats *to, const struct splats *from, const char *kept, struct err *e)
{
	const size_t colours = 3 * (size_t)from->sh_coefficients;
	size_t n = 0, at = 0;

	*to = (struct splats){0};
	for (size_t i = 0; i < from->n; i++)
		n += kept[i] != 0;
	if (splats_alloc(to, n, from->sh_coefficients, e))
		return -1;
	to->near = from->near;
	for (size_t i = 0; i < from->n; i++) {
		if (!kept[i])
			continue;
		memcpy(to->means + 3 * at, from->means + 3 * i, 3 * sizeof *to->means);
		memcpy(to->scales + 3 * at, from->scales + 3 * i, 3 * sizeof *to->scales);
		memcpy(to->quats + 4 * at, from->quats + 4 * i, 4 * sizeof *to->quats);
		memcpy(to->sh + colours * at, from->sh + colours * i, colours * sizeof *to->sh);
		to->opacities[at++] = from->opacities[i];
	}
	return 0;
}
