/* A long short-term memory over sequences, in one direction (Hochreiter and Schmidhuber 1997, with the forget
 * gates of Gers and others 2000), with torch.nn.LSTM as the model of details but one bias. With H units, of
 * each row x_t in turn:
 *
 *   (i f g o) = W x_t + R^T h_{t-1} + b          four parts of H each
 *   c_t = sigmoid(f) c_{t-1} + sigmoid(i) tanh(g)
 *   h_t = sigmoid(o) tanh(c_t)                    h_{-1} = c_{-1} = 0
 *
 * Every sum is taken in one order: results do not depend on the number of threads, nor on which sequences are
 * handed over together. */
#pragma once

#include <stddef.h>

struct lstm {
	size_t in, units;
	float *input;	  /* W (4H,in) */
	float *recurrent; /* R (H,4H): a row for each unit of h, as a step reads it */
	float *bias;	  /* b (4H) */
};

/* Sequences that lie one after the other: sequence s has rows start[s] to start[s + 1]. */
struct lstm_sequences {
	const int *start; /* (count + 1), from 0 on */
	int count;
	int is_reversed; /* each is read from its last row to its first */
};

/* What a run leaves behind for the way back. */
struct lstm_memory {
	float *gates;  /* (rows,4H): the gates' values; lstm_backward leaves their gradients */
	float *cell;   /* (rows,H): c */
	float *before; /* (rows,H): h of the row that was read before, 0 at the beginning */
};

/* out: h, rows `stride` floats apart; x (rows,in). */
void lstm_forward(const struct lstm *w, const struct lstm_sequences *s, const float *x,
	const struct lstm_memory *m, float *out, size_t stride);

/* Floats that lstm_backward needs besides. */
size_t lstm_scratch(const struct lstm *w, int sequences);

/* The gradients of lstm_forward, given dout (rows of H, `stride` floats apart) and what it left in m: those
 * of the weights are added to dw, that of x (rows,in) to dx. */
void lstm_backward(const struct lstm *w, const struct lstm *dw, const struct lstm_sequences *s,
	const float *x, const struct lstm_memory *m, const float *dout, size_t stride, float *dx,
	float *scratch);
