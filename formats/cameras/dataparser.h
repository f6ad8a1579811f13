/* nerfstudio's dataparser_transforms.json: how the frame that it trains in came from that of its cameras.
 * formats/cameras/dataparser.md. */
#pragma once

#include "base/err.h"
#include "geom/camera.h"

/* What a person can do where cameras and splats are in two frames, for messages. */
#define DATAPARSER_WAY_OUT                                                                                   \
	"gsplat trains in the cameras' frame with --no-normalize-world-space, nerfstudio writes its own into dataparser_transforms.json, and moved splats need cameras that were moved with them"

/* The file, where it lies beside the splats or the cameras: free() it. NULL where there is none, and with *e
 * set where memory is out. */
char *dataparser_find(const char *splats, const char *cameras, struct err *e);

/* Moves cameras, which were read from the file `cameras`, into the frame that the file at path tells of.
 * Returns 0, or -1 with *e set. */
int dataparser_move(struct cameras *c, const char *path, const char *cameras, struct err *e);
