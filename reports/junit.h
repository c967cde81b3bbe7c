/* SPDX-License-Identifier: GPL-3.0-or-later
 * The results as JUnit XML: a suite for the runs, one for the orders of convergence, one for each
 * group of checks, one for the deliberate faults and one for those of the world around. */
#ifndef SPHPROOF_JUNIT_H
#define SPHPROOF_JUNIT_H

#include <jansson.h>

/* results: with its verdict. Malloced; NULL: no memory. */
char *junit_text(const json_t *results);

/* The findings of judge's document as one suite. Malloced; NULL: no memory. */
char *junit_judge_text(const json_t *document);

#endif
