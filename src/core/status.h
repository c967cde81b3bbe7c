/* SPDX-License-Identifier: GPL-3.0-or-later
 * One list of outcomes: exit status of the program, name for messages and results. */
#ifndef SPHPROOF_STATUS_H
#define SPHPROOF_STATUS_H

#include <stddef.h>

#define STATUS_LIST(STATUS)                                                                        \
    STATUS(OK, 0, "ok")                                                                            \
    STATUS(CHECK_FAILED, 1, "a check or a gate failed; the run itself was sound")                  \
    STATUS(BAD_INPUT, 2, "bad usage or bad input")                                                 \
    STATUS(BROKE_DOWN, 3, "a simulation broke down")                                               \
    STATUS(ENVIRONMENT, 4, "no space, no memory, cannot write, a tool is missing")

enum status {
#define STATUS(name, code, text) STATUS_##name = code,
    STATUS_LIST(STATUS)
#undef STATUS
};

/* An error message for the user; set if a function returns anything but STATUS_OK. */
struct error {
    enum status status;
    char message[512];
};

/* Length in bytes of the UTF-8 character at text if it is printable, otherwise 0. Reads no further
 * than the first byte that cannot belong to it. */
size_t status_printable(const char *text);

/* Turns untrusted text into one line of valid UTF-8: unprintable characters become '?'. This keeps
 * escape sequences from terminals, and JSON requires it. */
void status_clean(char *text);

/* Formats and cleans the message, sets the status and returns it: `return error_set(error,
 * STATUS_X, ...)`. error may be NULL. */
enum status error_set(struct error *error, enum status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
