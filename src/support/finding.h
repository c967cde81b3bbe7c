/* SPDX-License-Identifier: GPL-3.0-or-later
 * A finding: the result of a check, a gate, a run or anything else that is judged. One struct
 * serves all of them, so that there is one verdict, one order of reporting failures, one JUnit file
 * and one exit status. */
#pragma once

/* Only FAIL counts as a failure, and only PASS and FAIL are verdicts. NONE: not requested. KNOWN:
 * fails, as its case announces. SMOKE: passes, but is so coarse that it only shows that nothing is
 * broken. UNDETERMINED: the interval is wider than the bound allows to judge. SKIP: could not be
 * measured. */
enum finding_status {
    FINDING_NONE,
    FINDING_PASS,
    FINDING_FAIL,
    FINDING_KNOWN,
    FINDING_SMOKE,
    FINDING_UNDETERMINED,
    FINDING_SKIP,
};
/* Names of the statuses in results; ends with NULL. */
extern const char *const finding_words[];

struct finding {
    const char *group;   /* group of a check, or the area of another finding ("gate", "run" ...) */
    const char *what;    /* a check, a case, a file */
    const char *subject; /* its figure or gate, and where */
    double value, bound, floor; /* NaN: none */
    double seconds;             /* NaN: not measured */
    enum finding_status status;
    int rank;                   /* failures with the lowest rank are reported first, see check.h */
    const char *reason;         /* why it does not pass; "" or NULL: see finding_excess */
    const char *command, *plot; /* command that reproduces it, and its plot; or NULL */
};

/* PASS if value <= bound and the noise is small enough to tell, floor <= bound; NaN fails. */
enum finding_status finding_judge(double value, double bound, double floor);

/* value/bound, a measure of how close a figure is to failing; infinite for NaN, and for a positive
 * value with bound 0. */
double finding_ratio(double value, double bound);

/* Sets *beyond to the part of a figure that fails: its value, or its floor if the value alone would
 * pass. Returns its distance from the bound in units of the bound. */
double finding_excess(const struct finding *finding, double *beyond);
