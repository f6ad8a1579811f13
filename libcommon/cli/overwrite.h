/* Outputs that would take the place of an input, or of each other, are refused before any work. cmd/ only. */
#ifndef CLI_OVERWRITE_H
#define CLI_OVERWRITE_H

#include "cli/cli.h"

enum cli_use { CLI_READS, CLI_WRITES };

/* A file that a tool reads or writes, or a folder of them. */
struct cli_file {
	const char *name; /* as messages call it: "--text", "SCENE"; NULL ends a list */
	const char *path; /* "-" is stdin or stdout; NULL: not given */
	enum cli_use use;
	const char
		*parts; /* NULL: a file. The files of a folder that are used: "cameras.json|*.safetensors" */
};

#define CLI_SCENE_PARTS "splats.safetensors|cameras.json"
#define CLI_WEIGHTS_PARTS "*.safetensors"

/* Exits with a usage error where an output is an input, another output, or among the files of a folder that
 * is read or written, whatever the names: symbolic and hard links are seen through, stdin and stdout count
 * where they are regular files, and an output need not exist. Two inputs may be the same. */
void cli_refuse_overwrite(const struct cli *c, const struct cli_file *files);

#endif
