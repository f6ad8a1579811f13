/* A scene that is asked, looked at and labelled by programs and by a page: refer-serve. formats/serve.md has
 * what is asked and what comes back, in HTTP and in lines of JSON alike. */
#pragma once

#include "base/err.h"
#include "base/jsontext.h"
#include "base/report.h"
#include "cmd/ask/asking.h"
#include "cmd/ask/reply.h"
#include "cmd/masks/pointing.h"

#include <cjson/cJSON.h>
#include <pthread.h>

struct serving_options {
	const char *run;    /* the folder */
	char *encoder;	    /* NULL: the usual one */
	const char *labels; /* file of what is named; NULL: RUN/labels.jsonl */
	const char *viewer; /* folder of the viewer's modules; NULL: the usual one */
	double least;	    /* a question less likely to mean anything is refused */
	long long splats;   /* Gaussians in the viewer at most */
};

struct serving;

/* Work for the one thread that has the scene. */
struct serving_job {
	int (*run)(struct serving *s, void *data, struct err *e);
	void *data;
	const char *question; /* that it will ask: those that wait together are encoded together; NULL */
	struct err *e;
	int result, is_done;
	struct serving_job *next;
};

/* A conversation, by the name that its program gave it. */
enum { SERVING_TALKS = 32, SERVING_TALK_NAME = 64 };
struct serving_talk {
	char name[SERVING_TALK_NAME + 1];
	long used; /* when: the one that was used least lately is forgotten */
	struct talk talk;
};

/* Answers to questions that were asked outside of conversations, until the scene changes. */
enum { SERVING_ANSWERS = 1024 };
struct serving_cached {
	char *key, *bytes; /* the question and from where; NULL: none */
	size_t length;
};

struct serving {
	const struct serving_options *options;
	const struct report *to;
	char *viewer, *labels, *scene_path; /* viewer is NULL where there is none */
	struct asking_options asking_options;
	struct cameras cameras; /* of the scene */

	pthread_t thread; /* that has what follows */
	int threads;	  /* of OpenMP, there */
	struct asking *asking;
	long revision;	 /* how often it was read */
	char **labelled; /* (labelled_count) names of what was labelled */
	size_t labelled_count;
	long used;
	struct serving_talk talks[SERVING_TALKS];

	pthread_mutex_t lock; /* of the jobs that wait for it */
	pthread_cond_t come, done;
	struct serving_job *first;
	struct serving_cached answers[SERVING_ANSWERS];
	int is_ending, is_started;

	pthread_mutex_t labelling; /* who has this labels, alone */
	int can_click;		   /* regions are there: */
	struct pointing pointing;
	char *weights;	  /* NULL: there are none, and nothing can be labelled */
	pthread_t looker; /* of serving_labels_look, while */
	int is_looking;
};

/* Opens the folder, where the models may be missing as long as nothing has a name. *s is zeroed before, and
 * options and the report stay the caller's. Returns 0, or -1 with *e set; serving_close after either. */
int serving_open(
	struct serving *s, const struct serving_options *options, const struct report *to, struct err *e);
void serving_close(struct serving *s);

/* Has the thread do it, and waits. Returns what job->run does. */
int serving_do(struct serving *s, struct serving_job *job);

struct serving_reply {
	const char *type; /* of the bytes */
	char *bytes;	  /* free() them */
	size_t length;
};

enum { SERVING_READS, SERVING_WRITES };

/* Answers "ask", "pick", "label", "things", "splats", "view" or "mask", which the body says more of; of a
 * label what keeps it needs may_write. From any thread. Returns 0, or -1 with *e set: ERR_CHECK where what is
 * asked for is not there. */
int serving_answer(struct serving *s, const char *what, const cJSON *body, int may_write,
	struct serving_reply *to, struct err *e);

/* The stream's text becomes the reply's bytes. */
struct serving_text {
	FILE *out;
	char *bytes;
	size_t length;
};
int serving_text_open(struct serving_text *t, struct err *e);
int serving_text_end(struct serving_text *t, int bad, struct serving_reply *to, struct err *e);

/* The view of a member, or -1 with *e. */
int serving_view(const struct serving *s, const cJSON *body, const char *key, size_t *view, struct err *e);
/* The thing of that name; ASKING_NONE. */
size_t serving_thing(const struct lifted *l, const char *name);
/* {"view","height","width","counts"}: COCO's run lengths as a list. */
void serving_put_mask(struct jsontext *to, const char *view, const struct rle *mask);

/* Each of them as serving_answer. */
int serving_ask(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e);
int serving_pick(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e);
int serving_things(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e);
int serving_splats(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e);
int serving_picture(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e);
int serving_mask(struct serving *s, const cJSON *body, struct serving_reply *to, struct err *e);
int serving_label(
	struct serving *s, const cJSON *body, int may_write, struct serving_reply *to, struct err *e);

/* What a request for a label says. */
struct serving_label {
	const char *name, *remove, *rename;
	size_t view;	    /* of the first place */
	const cJSON *views; /* whose masks are wanted; NULL: that view's */
	struct rle outline; /* in that view; runs are NULL where regions are meant */
};

/* "request: key 'KEY' WHY", ERR_FORMAT. Always -1. */
int serving_faulty(struct err *e, const char *key, const char *why);
/* What is meant, from then on: the outline of *l, or s->pointing's regions. The next are of that: its mask in
 * a view, whose *area is 0 where it is not seen, and the reply with those of l->views. With the labelling.
 * Each returns 0, or -1 with *e set. */
int serving_take_place(struct serving *s, const cJSON *body, struct serving_label *l, struct err *e);
int serving_find_mask(struct serving *s, const struct serving_label *l, size_t view, struct rle *mask,
	size_t *area, struct err *e);
int serving_preview(
	struct serving *s, const struct serving_label *l, struct serving_reply *to, struct err *e);

/* What labels need of the folder, once; serving_labels_close after it. */
int serving_labels_open(struct serving *s, struct err *e);
/* Lifts labels that are newer than the model of them, which another program wrote; with the thread. */
int serving_labels_refresh(struct serving *s, struct err *e);
/* Begins to look at all views, so that no click has to wait for that. */
void serving_labels_look(struct serving *s);
void serving_labels_close(struct serving *s);

/* The whole of it in HTTP. */
struct serving_http {
	const char *address; /* a number: 127.0.0.1 */
	int port;	     /* 0: a free one */
};

/* Serves until SIGINT or SIGTERM. Prints the page's address, with the token that may write, to `out` when it
 * can be asked. Returns 0, or -1 with *e set. */
int serving_http(struct serving *s, const struct serving_http *at, FILE *out, struct err *e);

/* Lines of JSON from stdin, each with "do", to lines on `out`. Who starts it may write. */
int serving_lines(struct serving *s, FILE *out, struct err *e);

/* The answer to a key: 1, and a copy of it, 0 where it is not kept, -1 with *e. From any thread. */
int serving_recall(struct serving *s, const char *key, struct serving_reply *to, struct err *e);
/* Keeps it in the place of another; for the thread that has the scene. Where memory is out it is not kept. */
void serving_remember(struct serving *s, const char *key, const struct serving_reply *reply);
/* All of them; with the lock. */
void serving_forget(struct serving *s);
