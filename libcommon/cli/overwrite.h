/* Outputs that would take the place of an input, or of each other, are refused before any work. cmd/ only;
 * cli.h includes it. */
#pragma once

struct cli;

enum cli_use { CLI_READS, CLI_WRITES };

/* A file that a tool reads or writes, or a folder of them, that is no option. */
struct cli_file {
	const char *name; /* as messages call it; NULL ends a list */
	const char *path; /* "-" is stdin or stdout; NULL: not given */
	enum cli_use use;
	const char *parts; /* NULL: a file. The files of a folder that are used: "cameras.json|*.safetensors".
			    * A part that is a folder stands for the files that it has */
};

/* The folders that several tools read, as words of cli_refuse_overwrite's lists. */
#define CLI_SCENE_PARTS "splats.safetensors|cameras.json|motion.safetensors"
#define CLI_WEIGHTS_PARTS "*.safetensors"
#define CLI_SCENE "scene:" CLI_SCENE_PARTS
#define CLI_WEIGHTS "weights:" CLI_WEIGHTS_PARTS

/* Exits with a usage error where an output is an input, another output, or among the files of a folder that
 * is read or written, whatever the names: symbolic and hard links are seen through, stdin and stdout count
 * where they are regular files, and an output need not exist. Two inputs may be one file, but not both stdin.
 *
 * `reads` and `writes` are words with a blank between: the long name of an option ("output" is -o), or in
 * capitals the operand; after a colon the parts of a folder. `more` (may be NULL) are other files. */
void cli_refuse_overwrite(
	const struct cli *c, const char *reads, const char *writes, const struct cli_file *more);
