/* Sets that a phrase speaks of: what it leaves out, what it is one of, and of how many. */
#include "ask/constants.h"
#include "ask/meaning_private.h"

#include <math.h>
#include <string.h>

void meaning_judge_except(struct meaning *m, int phrase, int except)
{
	const size_t n = objects_of(m);
	const double *fit = fit_of(m, except), most = fmax(largest(fit, n), 1e-9);
	double *value = meaning_add_part(m, phrase, MEANING_EXCEPT, except), *there = there_of(m, phrase);

	for (size_t o = 0; o < n; o++) {
		value[o] = 1 - (1 - EXCEPT_LEAST) * m->known[except] * fit[o] / most;
		there[o] *= value[o];
	}
	meaning_take_part(m, &m->parts[m->part_count - 1]);
}

void meaning_judge_among(struct meaning *m, int phrase)
{
	const struct parse_list *among = &m->sentence->parse->phrases[phrase].among;
	const size_t n = objects_of(m);

	if (!among->n)
		return;
	double *value = meaning_add_part(m, phrase, MEANING_AMONG, -1), *there = there_of(m, phrase);
	for (size_t o = 0; o < n; o++) {
		double is = 0, is_there = 0;
		for (int k = 0; k < among->n; k++) {
			const int i = among->item[k];
			const double *fit = fit_of(m, i);
			is = fmax(is, m->known[i] * fit[o] / fmax(largest(fit, n), 1e-9));
			is_there = fmax(is_there, there_of(m, i)[o]);
		}
		value[o] = GROUP_ELSE + (1 - GROUP_ELSE) * fmin(is, 1);
		there[o] *= is_there;
	}
	meaning_take_part(m, &m->parts[m->part_count - 1]);
}
