/* SPDX-License-Identifier: GPL-3.0-or-later
 * Targets for coverage-guided fuzzing. For any bytes a target must return within a second of CPU
 * time, without a crash, a leak or a broken promise (FUZZ_PROMISE). Built with -Dfuzzer=true
 * (clang) they are run by libFuzzer, otherwise by replay.c. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "run.h"
#include "status.h"

/* Each target file defines this function. */
void fuzz_one(const uint8_t *bytes, size_t size);

/* The path of a file with these bytes; it is the same file each time. */
const char *fuzz_file(const uint8_t *bytes, size_t size);

/* The same for libraries that need a path in a folder; the file is removed when the process
 * ends. */
const char *fuzz_named_file(const uint8_t *bytes, size_t size);

/* Returns a NUL-terminated copy, which the caller frees. */
char *fuzz_text(const uint8_t *bytes, size_t size);

/* A refusal must be bad input, with a message in valid UTF-8: no escape sequence of a hostile file
 * reaches the terminal. */
void fuzz_refused(enum status status, const struct error *error);

/* Prepares a run with few particles up to its first step. */
void fuzz_plan(const struct run_settings *settings);

/* Aborts with the text of a promise that does not hold. */
#define FUZZ_PROMISE(holds) ((holds) ? (void)0 : fuzz_broken(__FILE__, __LINE__, #holds))
_Noreturn void fuzz_broken(const char *file, int line, const char *promise);

/* Unless NULL, *fuzz_was_broken becomes 1 when a promise is broken. It is memory shared with the
 * parent process: printed text would not do, because an input may contain the same words. */
extern volatile int *fuzz_was_broken;
