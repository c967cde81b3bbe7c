/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lists of findings (see finding.h): all that a report or a judgement has found. What fails is told
 * with the most specific cause first: a wrong kernel fails its own checks, then those of the
 * gradients made of it, of whole runs, of orders of convergence; read in this order the first
 * failure names it. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "finding.h"

/* What is no check, in the order in which it is told after all checks: its rank, and the name that
 * stands for its group. */
enum finding_area {
    AREA_DETECTION = 1000,
    AREA_SUSPICION,
    AREA_HARNESS,
    AREA_CONVERGENCE,
    AREA_GATE,
    AREA_BUDGET,
    AREA_STUDY,
    AREA_RUN,
    AREA_STRESS,
    AREA_FAULT,
    AREA_END,
};

/* What of a report failed where nothing else is in it. */
#define FINDINGS_NOTHING "Nothing was checked"

/* Begins as {0}; to be freed. No memory: failed is set, and what is made of the list is NULL. */
struct findings {
    struct finding *list;
    size_t count;
    bool failed;
};

/* Copies the texts; NULL stands for "". Its group is that of its area where it is of one. */
void findings_add(struct findings *to, struct finding finding);
void findings_free(struct findings *findings);

/* All that is judged in results as verdict.h describes them. What cannot be read is a failure of
 * the harness, and so is that nothing was judged at all. */
void findings_of_report(struct findings *to, const json_t *results);
/* Those of the documents of `sphproof verify` and `sphproof judge`. */
void findings_of_verify(struct findings *to, const json_t *document);
void findings_of_judge(struct findings *to, const json_t *document);

/* What fails, most specific first: [{"area", "name", "detail", "command"}]. A check ("check", of
 * name "group: check", with its "subject") is listed once, by the figure farthest beyond its bound;
 * the others are counted. New reference; NULL: no memory. */
json_t *findings_failures(const struct findings *findings);

/* JUnit XML of what `of`, one of the functions above, finds in a document: a suite for each group,
 * a test case for each finding but those of status NONE. What fails is a failure, what is neither
 * that nor passes is skipped. Malloced; NULL: no memory. */
char *findings_junit(void (*of)(struct findings *to, const json_t *document),
                     const json_t *document);
