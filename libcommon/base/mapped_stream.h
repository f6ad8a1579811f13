/* A stream that is read from memory in place of by system calls: for a library that seeks to every line it
 * looks at, as libwordnet does in its files. */
#pragma once

#include <stdio.h>

/* A stream of memory has a buffer too, which is filled anew after each seek: of about a line of WordNet's. */
enum { MAPPED_STREAM_BUFFER = 512 };

/* Replaces an input stream of a regular file by one of the same bytes, at its beginning, that maps the file.
 * The mapping lasts as long as the process, and the buffer has to last as long as the stream. Where that
 * cannot be, the stream stays as it is. */
void mapped_stream_take(FILE **stream, char buffer[MAPPED_STREAM_BUFFER]);
