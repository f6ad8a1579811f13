/* librefersplat: ask a lifted scene in which things are, from another program.
 *
 * Every function that can fail returns a status; refersplat_message then says why, in one line. Strings are
 * UTF-8. What a function hands out belongs to the handle and is good until the call that is named beside it,
 * refersplat_load or refersplat_free. A handle is for one thread at a time; several handles do not disturb
 * each other. librefersplat(3) has two programs that use it. */
#ifndef REFERSPLAT_H
#define REFERSPLAT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined __GNUC__
#define REFERSPLAT_API __attribute__((visibility("default")))
#else
#define REFERSPLAT_API
#endif

struct refersplat;

/* The programs' exit statuses. */
enum refersplat_status {
	REFERSPLAT_OK = 0,
	REFERSPLAT_NONE = 1,   /* there is nothing: no object of that number, no answer */
	REFERSPLAT_USAGE = 2,  /* an argument is wrong */
	REFERSPLAT_FORMAT = 3, /* a file is malformed, or files do not belong together */
	REFERSPLAT_SYSTEM = 4, /* a file cannot be read, or memory is out */
};

struct refersplat_object {
	const char *name;
	double confidence;	  /* 0 to 1: how well the object's masks agree with what was lifted of them */
	size_t count;		  /* its Gaussians; 0: it has none, and its boxes are zero */
	const int32_t *gaussians; /* (count) numbers in the scene, rising */
	double low[3], high[3];	  /* the box along the world's axes */
	double centre[3], size[3], quat[4]; /* the turned box; w, x, y, z of its axes */
};

struct refersplat_view {
	const char *name;
	int width, height;
};

struct refersplat_answer {
	size_t count;		     /* objects that are meant */
	const int *objects;	     /* (count) their numbers, likeliest first */
	const double *probabilities; /* (count) that each is meant */
	double probability;	     /* that the question means anything that is here */
	const char *reason;	     /* why nothing is meant; "" where something is */
};

/* NULL where memory is out. */
REFERSPLAT_API struct refersplat *refersplat_new(void);
REFERSPLAT_API void refersplat_free(struct refersplat *r); /* NULL is fine */

/* Why the last call that failed did, or "". Good until the next call. */
REFERSPLAT_API const char *refersplat_message(const struct refersplat *r);

/* A scene folder of gs-import(1), a model of refer-lift(1), and an encoder's folder; NULL: where
 * refersplat-encoder puts it. What was loaded before is released. */
REFERSPLAT_API int refersplat_load(
	struct refersplat *r, const char *scene, const char *model, const char *encoder);

/* A camera of the scene's world that is not one of its views, from any file of one camera that gs-import
 * reads; in place of the camera that was loaded before. It is then a view like the others. */
REFERSPLAT_API int refersplat_load_camera(struct refersplat *r, const char *file);

/* Object or view i from 0 on; REFERSPLAT_NONE past the last. Of views the loaded camera is the last. Good
 * until the next refersplat_load_camera. */
REFERSPLAT_API int refersplat_get_object(struct refersplat *r, size_t i, struct refersplat_object *object);
REFERSPLAT_API int refersplat_get_view(struct refersplat *r, size_t i, struct refersplat_view *view);

/* A sentence taken apart: *json is a line of JSON, formats/records/parses.md. Good until the next
 * refersplat_parse. */
REFERSPLAT_API int refersplat_parse(struct refersplat *r, const char *sentence, const char **json);

/* What a question means, as seen from a view, or NULL: from between the training views. REFERSPLAT_NONE where
 * it means nothing that is here; *answer is set then too, with a reason. Good until the next
 * refersplat_ask. */
REFERSPLAT_API int refersplat_ask(
	struct refersplat *r, const char *question, const char *view, struct refersplat_answer *answer);

/* The mask of objects (count) in a view: mask (height, width) gets 1 where they are seen, else 0. */
REFERSPLAT_API int refersplat_mask(
	struct refersplat *r, const char *view, const int *objects, size_t count, unsigned char *mask);

#ifdef __cplusplus
}
#endif

#endif
