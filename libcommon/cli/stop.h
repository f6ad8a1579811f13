/* Ends by a signal that let the work at hand be saved first. cmd/ only. */
#pragma once

#include <signal.h>

/* From now on the first SIGINT or SIGTERM only sets what this returns, to its number, and a second one acts
 * as before. A signal that was ignored stays so. */
const volatile sig_atomic_t *cli_stop_catch(void);

/* Ends the process by the signal that was caught, as a shell sees it: with the status 130 or 143. Without one
 * it returns. */
void cli_stop_end(void);
