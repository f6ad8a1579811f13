/* The weights of text-parse, learnt from the project's own example sentences and from readings of others:
 * parse-train. formats/encoders/parser_weights.md, formats/records/readings.md. */
#ifndef CMD_TRAIN_PARSER_TRAINING_H
#define CMD_TRAIN_PARSER_TRAINING_H

#include "base/err.h"
#include "base/report.h"

struct parser_training_options {
	const char *examples;		/* the encoded example sentences */
	const char *marked;		/* people's sentences with marks; NULL: none */
	const char *marked_text;	/* their encoded sentences */
	const char *readings;		/* learn from these too; NULL: none */
	const char *readings_text;	/* their encoded sentences */
	const char *output;		/* weights, or parses where there are folds; "-" is stdout */
	const char *source;		/* what the weights say that they were learnt from */
	long long epochs, rounds, seed; /* the seed is that of the examples, too */
	long long members;		/* networks, whose scores are averaged */
	long long folds;		/* 0, or cross-validate in so many parts */
	int is_blind;			/* the network is not told what the grammar says */
};

/* Learns, and writes the weights; with folds the parses of the readings' sentences instead, each by weights
 * that saw no sentence of its part. Returns 0, or -1 with *e set. */
int parser_train(const struct parser_training_options *o, const struct report *to, struct err *e);

#endif
