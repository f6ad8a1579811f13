/* A stream that is read from memory in place of by system calls: for a library that seeks to every line it
 * looks at, as libwordnet does in its files. */
#ifndef BASE_MAPPED_STREAM_H
#define BASE_MAPPED_STREAM_H

#include <stdio.h>

/* Replaces an input stream of a regular file by one of the same bytes, at its beginning, that maps the file.
 * The mapping lasts as long as the process. Where that cannot be, the stream stays as it is. */
void mapped_stream_take(FILE **stream);

#endif
