/* SPDX-License-Identifier: GPL-3.0-or-later
 * A finding: what a check, a gate, a run or anything else that is judged has come to. There is one
 * kind of it, so that there is one verdict, one order in which failures are told, one JUnit file
 * and one exit status. */
#pragma once

/* Only FAIL fails anything, and only PASS and FAIL are judged. NONE: nothing was asked. KNOWN:
 * fails, as its case says that it does. SMOKE: passes, but too coarsely to say more than that
 * nothing is broken. UNDETERMINED: nobody can tell, as an interval is wider than what it is held
 * to. SKIP: could not be measured. */
enum finding_status {
    FINDING_NONE,
    FINDING_PASS,
    FINDING_FAIL,
    FINDING_KNOWN,
    FINDING_SMOKE,
    FINDING_UNDETERMINED,
    FINDING_SKIP,
};
/* As results write them; ends with NULL. */
extern const char *const finding_words[];

struct finding {
    const char *group;          /* of a check, or the area of what is none ("gate", "run" ...) */
    const char *what;           /* a check, a case, a file */
    const char *subject;        /* which figure or gate of it, and where */
    double value, bound, floor; /* NaN: there is none */
    double seconds;             /* NaN: not measured */
    enum finding_status status;
    int rank;                   /* of failures the one of least rank is told first, see check.h */
    const char *reason;         /* why it does not pass; "" or NULL: see finding_excess */
    const char *command, *plot; /* what shows it again, and where it is drawn; or NULL */
};

/* PASS where value <= bound and the noise below the value allows to say so, floor <= bound; a NaN
 * fails. */
enum finding_status finding_judge(double value, double bound, double floor);

/* value/bound, the measure of how near a figure is to failing; infinite for a NaN, and for what is
 * beyond a bound of 0. */
double finding_ratio(double value, double bound);

/* What fails of a figure: *beyond is its value, or its floor where the value alone would pass.
 * Returns how far that is beyond the bound, in units of it. */
double finding_excess(const struct finding *finding, double *beyond);
