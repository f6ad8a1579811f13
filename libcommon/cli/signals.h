/* What ends a tool early. */
#pragma once

/* From now on a signal that ends the tool removes its temporary files first. What is ignored, by nohup say,
 * stays so. At the limit of a file's size writes fail, as on a full disk, and the tool says so. A mapped file
 * that cannot be read, or is cut short meanwhile, is an error as others: "tool: file: reason" and status 4.
 */
void signals_catch(const char *tool);
