/* Names of views, refs and objects. A view's name is also a file name (VIEW.safetensors, VIEW/REF.png), so it
 * is checked as one where it is read. Refs and objects are escaped in file names. */
#pragma once

#include "base/err.h"

enum name_kind {
	NAME_DATA, /* of a ref or object: not empty, UTF-8, no control character */
	NAME_VIEW, /* also no '/', and not '.' or '..' */
};

enum { NAME_FAULT = 64 };

/* Why `name` cannot be a name, in words that follow what it is called: "is empty", "is not UTF-8 at byte 3",
 * "has a control character at byte 1", "has a slash", "is '.' or '..'". NULL where it can; else `fault`.
 * Control characters are U+0000 to U+001F and U+007F to U+009F. */
const char *name_fault(const char *name, enum name_kind kind, char fault[NAME_FAULT]);

/* A copy in Unicode's composed form, NFC, or in its decomposed one, NFD, as macOS writes file names: names
 * that look the same are the same. What is not UTF-8 is copied as it is. free() it; NULL with *e. */
char *name_copy(const char *text, struct err *e);
char *name_decomposed(const char *text, struct err *e);

/* Whether programs of labels call so what is no thing: "background", "__ignore__", "Unlabeled". */
int name_is_nothing(const char *name);

/* utf8_plain of what a person typed or pasted, in place, without the blanks at its ends. */
char *name_trim(char *text);

/* Any text as a file name, such that different texts have different names: '/', '%', control characters,
 * bytes that are not UTF-8, and the dots of '.' and '..' are written as '%' and two capital hexadecimal
 * digits for each byte. free() it; NULL with *e set when memory is out. */
char *name_to_file(const char *text, struct err *e);

/* The text of which name_to_file made a file name, composed; what it would not have written stays. free() it;
 * NULL with *e set when memory is out. */
char *name_from_file(const char *file, struct err *e);

/* A view's name from a part of a photograph's path, composed: '/' becomes '_'; what a view's name cannot
 * have, and ',', which separates names in options, is written as above, but '%' stays. Different texts may
 * have one name. free() it; NULL with *e set when memory is out. */
char *name_to_view(const char *text, struct err *e);
