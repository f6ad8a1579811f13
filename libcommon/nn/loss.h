/* Losses on plain arrays. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* Binary cross-entropy with logits (design section 4, L_bce): the mean over n pixels of
 *   max(z,0) + log(1 + exp(-|z|)),  z = -M where the mask is set, M where it is 0,
 * which no finite or infinite logit overflows. logits (n), mask (n) 0 or not 0. dlogits (n), or NULL, becomes
 * scale (sigmoid(M) - y) / n, without the cancellation of sigmoid(M) - 1. n = 0 gives 0. The sum is taken in
 * double, in blocks that depend on n only, added in order: the same bytes for any threads. */
double loss_bce(const float *logits, const uint8_t *mask, size_t n, float scale, float *dlogits);

/* log sum_i exp(x_i) of n > 0 numbers, without overflow. */
double loss_log_sum_exp(const float *x, size_t n);
/* Its two parts: sum_i exp(x_i - *most), *most being the largest. */
double loss_exp_sum(const float *x, size_t n, float *most);
