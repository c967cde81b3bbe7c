/* SPDX-License-Identifier: GPL-3.0-or-later
 * JUnit XML, as every command writes it. Of a report: a suite for the runs, one for the orders of
 * convergence, one for each group of checks, one for the deliberate faults and one for those of the
 * world around. */
#ifndef SPHPROOF_JUNIT_H
#define SPHPROOF_JUNIT_H

#include <jansson.h>
#include <stddef.h>

#include "buffer.h"

/* A suite begins as {0}. Lack of memory shows in junit_take. */
struct junit_suite {
    struct buffer cases;
    size_t tests, failures, skipped;
};

void junit_begin(struct buffer *to);
/* status: "pass", "ok", "skip", "known", "smoke", "undetermined"; any other is a failure. The
 * message is that of a case that does not pass. seconds < 0: not measured. */
void junit_case(struct junit_suite *suite, const char *class, const char *name, double seconds,
                const char *status, const char *message);
/* Writes the suite, unless it is empty, and empties it. */
void junit_suite_end(struct buffer *to, const char *name, struct junit_suite *suite);
/* The whole document, malloced; NULL: no memory. */
char *junit_take(struct buffer *to);

/* results: with its verdict. Malloced; NULL: no memory. */
char *junit_text(const json_t *results);

/* The findings of judge's document as one suite. Malloced; NULL: no memory. */
char *junit_judge_text(const json_t *document);

#endif
