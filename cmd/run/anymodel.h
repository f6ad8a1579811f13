/* A model of any kind, told by the file: trained (formats/scene/model.md), lifted (formats/scene/lifted.md),
 * or what was selected for each sentence (formats/scene/selection.md). */
#pragma once

#include "answer/responses.h"
#include "base/err.h"
#include "formats/scene/model.h"
#include "formats/encoders/parser_weights.h"
#include "formats/scene/scene.h"
#include "formats/scene/selection.h"
#include "formats/scene/text.h"
#include "formats/records/boxes.h"
#include "lift/extent.h"
#include "lift/lifted_model.h"
#include "places/track.h"

struct anymodel {
	int is_lifted, is_selection; /* neither: trained */
	struct model trained;
	struct lifted lifted;
	struct selection selection;
	struct origin origin;	       /* the scene and the encoder that it was made with */
	struct parser_weights weights; /* of the sentences' parser, for a lifted model: the default ones */
	struct tracks tracks;	       /* of anymodel_track; no times: the scene is still */
	struct extent *extents;	       /* (objects) of a lifted model, of anymodel_place; else NULL */
	uint64_t *poses;	       /* (objects) what anymodel_follow found these by; NULL */
};

/* ERR_FORMAT where the file is malformed, or of another kind. */
int anymodel_read(struct anymodel *m, const char *path, struct err *e);
void anymodel_free(struct anymodel *m);

/* ERR_FORMAT where it is not of this scene; the name is for messages. */
int anymodel_check_scene(
	const struct anymodel *m, const char *model, const struct scene *scene, struct err *e);

/* Where each lifted object is, in the frame of the splats: m->extents. Returns 0, or -1 with *e set. */
int anymodel_place(struct anymodel *m, const struct scene *scene, struct err *e);
/* The same where the scene has moved to another time: what rests is not looked for again. Of a scene that is
 * still, nothing. */
int anymodel_follow(struct anymodel *m, const struct scene *scene, struct err *e);
/* Which way each goes, of a scene that moves, whatever time it is moved to: m->tracks. Likewise. */
int anymodel_track(struct anymodel *m, const struct scene *scene, struct err *e);
/* The boxes of an object in the world, means + offset, with the score `sure`; without names. */
struct box_record anymodel_box(const struct extent *x, const double offset[3], double sure);

struct anymodel_ask {
	const struct scene *scene;
	const struct text *text;
	const char *model_path, *text_path; /* for messages */
	const size_t *which;		    /* (count) the sentences */
	size_t count;
	int wants_calibration; /* of trained models, and the next are of lifted ones: see answer/responses.h
				*/
	unsigned parts;
	double least;
	int wants_parts;
	const struct viewpoint
		*from; /* where all sentences are said; NULL: each of the view that it names, if any */
	struct parser_memo *memo; /* of who asks the same again; NULL: nobody */
};

/* What the model answers to sentences. ERR_FORMAT where it is not of this scene, or the text does not fit or
 * is of another encoder, or a selection has none of a sentence. */
int anymodel_answer(
	const struct anymodel *m, const struct anymodel_ask *q, struct responses *a, struct err *e);
