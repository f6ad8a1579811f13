/* Training logs: how the losses went, JSON Lines. formats/records/trainlog.md. */
#pragma once

#include "base/err.h"
#include "base/file.h"
#include "train/train.h"

struct trainlog {
	const char *path;    /* NULL: no log */
	FILE *stream;	     /* a file, written line by line so that it can be watched */
	struct file_out out; /* or stdout, a device or a pipe */
};

/* Begins a log, or goes on with one: the lines of steps after `iteration` are cut off, as they will be
 * written again. path NULL makes a log that takes lines and writes none; "-" is stdout. */
int trainlog_open(struct trainlog *l, const char *path, long iteration, struct err *e);

enum { TRAINLOG_EVERY = 100 };

/* After each step: every TRAINLOG_EVERY steps a line of mean losses, and the state's sum begins anew. */
int trainlog_step(struct trainlog *l, struct train_state *t, struct err *e);

/* A line of gs-train: means over the steps since the last. */
int trainlog_put_fit(
	struct trainlog *l, long iteration, size_t gaussians, double loss, double psnr, struct err *e);

/* A line of gs-train's at an evaluation, over held-out views or, where there are none, those of training. */
int trainlog_put_judged(
	struct trainlog *l, long iteration, size_t gaussians, double psnr, double ssim, struct err *e);

/* Closes in any case, also a log that was not opened. */
int trainlog_close(struct trainlog *l, struct err *e);
