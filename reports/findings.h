/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lists of findings (see finding.h) of a report or a judgement. Failures are sorted by their most
 * specific cause: a wrong kernel fails its own checks, then those of gradients, of whole runs and
 * of orders of convergence, so that the first failure names the cause. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "finding.h"

/* Findings that are not checks, in the order in which they follow the checks: rank, and name of the
 * group. */
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

/* The only failure of a report without findings. */
#define FINDINGS_NOTHING "Nothing was checked"

/* Starts as {0}; free with findings_free. `failed` is set if memory runs out; results made from the
 * list are then NULL. */
struct findings {
    struct finding *list;
    size_t count;
    bool failed;
};

/* Adds a finding and copies its strings; NULL stands for "". A finding with the rank of an area
 * gets the name of the area as its group. */
void findings_add(struct findings *to, struct finding finding);
void findings_free(struct findings *findings);

/* Adds all findings of results (see verdict.h). Results that cannot be read, or that contain no
 * finding, are a failure of the harness. */
void findings_of_report(struct findings *to, const json_t *results);
/* Add the findings of documents of `sphproof verify` and `sphproof judge`. */
void findings_of_verify(struct findings *to, const json_t *document);
void findings_of_judge(struct findings *to, const json_t *document);

/* The failures, most specific first: [{"area", "name", "detail", "command"}]. A check ("check",
 * with the name "group: check" and its "subject") is listed once, with the figure that exceeds its
 * bound most; its other failures are counted. New reference; NULL: no memory. */
json_t *findings_failures(const struct findings *findings);

/* JUnit XML of the findings that `of`, one of the functions above, adds for a document: a suite per
 * group, a test case per finding, except for those with status NONE. A finding that neither passes
 * nor fails is skipped. Malloced; NULL: no memory. */
char *findings_junit(void (*of)(struct findings *to, const json_t *document),
                     const json_t *document);
