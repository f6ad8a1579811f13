/* What ends a tool early. */
#pragma once

/* From now on a signal that ends the tool removes its temporary files first. What is ignored, by nohup say,
 * stays so. At the limit of a file's size writes fail, as on a full disk, and the tool says so. A mapped file
 * that cannot be read, or is cut short meanwhile, is an error: "tool: file: reason", status 4. */

#include <signal.h>

void signals_catch(const char *tool);

/* Ends by a signal that let the work at hand be saved first. cmd/ only. */

/* From now on the first SIGINT or SIGTERM only sets what this returns, to its number, and a second one acts
 * as before. A signal that was ignored stays so. */
const volatile sig_atomic_t *cli_stop_catch(void);

/* Ends the process by the signal that was caught, as a shell sees it: with the status 130 or 143. Without one
 * it returns. */
void cli_stop_end(void);
