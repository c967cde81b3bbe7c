/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a figure is, by its name and where it stands: one table. A figure that no rule knows is none
 * that can be judged, and diff says so: a new figure needs a line here. */
#ifndef SPHPROOF_METRIC_RULE_H
#define SPHPROOF_METRIC_RULE_H

#include "metric.h"

struct metric_rule {
    /* inside: a name on the way to the figure, "" for anywhere. name: the figure's own; "*x" ends
     * in x, "x*" begins with x. The first rule that fits counts. */
    const char *inside, *name;
    enum { RULE_FIGURE, RULE_LEFT_OUT } use; /* left out: a context, or judged elsewhere */
    enum metric_kind kind;
    double noise, floor;
};

/* The rule for a member of the object at path; NULL: there is none. */
const struct metric_rule *metric_rule(const char *path, const char *name);

/* Is name one of the path's parts outside brackets? */
bool metric_passes(const char *path, const char *name);

#endif
