#include "lift/seen.h"

#include "base/mem.h"
#include "lift/marks.h"

int seen_make(struct seen *s, const float *weight, size_t gaussians, struct err *e)
{
	uint32_t count = 1;

	*s = (struct seen){.marks = marks_make(gaussians, e),
		.before = mem_alloc(gaussians / 64 + 1, sizeof *s->before, "views", e)};
	if (!s->marks || !s->before)
		return -1;
	for (size_t i = 0; i < gaussians; i++) {
		if (i % 64 == 0)
			s->before[i / 64] = count;
		if (!(weight[i] > 0))
			continue;
		marks_add(s->marks, i);
		count++;
	}
	s->weight = mem_alloc(count, sizeof *s->weight, "views", e);
	if (!s->weight)
		return -1;
	s->weight[0] = 0;
	count = 1;
	for (size_t i = 0; i < gaussians; i++)
		if (weight[i] > 0)
			s->weight[count++] = weight[i];
	return 0;
}

void seen_free(struct seen *s)
{
	mem_free_all(s->marks, s->before, s->weight);
	*s = (struct seen){0};
}

void seen_add(const struct seen *s, size_t gaussians, double *sum)
{
	if (!s->marks)
		return;
	const float *next = s->weight + 1;

	for (size_t word = 0; word <= gaussians / 64; word++)
		for (uint64_t left = s->marks[word]; left; left &= left - 1)
			sum[word * 64 + (size_t)__builtin_ctzll(left)] += (double)*next++;
}
