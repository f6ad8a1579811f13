/* Completion of command lines by bash and zsh: a script for a tool, made of its table of options. The build
 * asks each tool for its own, by --completion=bash or --completion=zsh, which --help does not list. cmd/
 * only: these print to stdout. */
#pragma once

#include "cli/cli.h"

#include <stddef.h>

/* Of a tool and all its options, rows (n), the common ones among them. An option's argument is one of its
 * choices, or a file where it is called by a word in capitals (a folder: DIR), else it is not completed.
 * Operands are files. */
void completion_bash(const struct cli_tool *tool, const struct cli_option *const *rows, size_t n);
void completion_zsh(const struct cli_tool *tool, const struct cli_option *const *rows, size_t n);
