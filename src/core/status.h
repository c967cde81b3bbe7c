/* SPDX-License-Identifier: GPL-3.0-or-later
 * One list of outcomes: the exit status of the program, a name for messages and results. */
#ifndef SPHPROOF_STATUS_H
#define SPHPROOF_STATUS_H

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

/* What went wrong, for a person: filled where a function returns anything but STATUS_OK. */
struct error {
    enum status status;
    char message[512];
};

/* Makes one line of valid UTF-8 of text that a stranger wrote: what cannot be printed becomes '?'.
 * No escape sequence shall reach a terminal, and JSON takes nothing else. */
void status_clean(char *text);

/* Formats the message, sets the status and returns it: `return error_set(error, STATUS_X, ...)`.
 * error may be NULL (the message is dropped). The message is cleaned. */
enum status error_set(struct error *error, enum status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
