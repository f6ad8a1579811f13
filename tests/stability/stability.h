/* The table of `make stability`: for each hard case the error of the fast path against a plain float64 twin.
 */
#ifndef STABILITY_H
#define STABILITY_H

/* A row: what was compared, its error, the most that the error may be, and what the program does there. An
 * error that is not finite, or above its bound, fails the run. */
void row(const char *name, const char *compared, double error, double bound, const char *does);

/* What the second column says where it depends on the case; good until the eighth next call. */
const char *compared(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* The rows, by part; is_quick leaves out those that take long or much memory. */
void splat_cases(int is_quick);
void model_cases(int is_quick);
void mask_cases(void);

#endif
