/* SPDX-License-Identifier: GPL-3.0-or-later
 * Metrics: every figure of a result document of any kind, with a path that is the same in every
 * document (entries of lists are named by their subject, not by their index), its kind, and its
 * noise. Diff, history and baseline are made of them. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "status.h"

enum metric_kind {
    METRIC_ERROR,   /* less is better; noise is relative */
    METRIC_CHECK,   /* less is better, factors below 3 are noise; the check has its own status */
    METRIC_ORDER,   /* more is better; noise is absolute */
    METRIC_PART,    /* less is better, but its whole is judged instead: never a fault */
    METRIC_EXACT,   /* closer to `exact` is better; noise is relative to the distance */
    METRIC_COUNT,   /* amount of work: less is better, never a fault; noise is relative */
    METRIC_TIMING,  /* less is better, never a fault; noise is a ratio */
    METRIC_STATUS,  /* a word */
    METRIC_NEUTRAL, /* no direction is better: every change is reported */
};

struct metric {
    char *path; /* studies[sod, default].levels[198].errors.density.l1 */
    enum metric_kind kind;
    double value;               /* NaN for a word */
    double noise, floor, exact; /* values below the floor are equal */
    char *word;                 /* for METRIC_STATUS, else NULL */
    double rank;                /* rank of the check it belongs to; infinite: none */
    size_t number;              /* position in the document */
    bool headline;              /* kept in the history */
};

struct metrics {
    struct metric *list; /* sorted by path, each once */
    size_t count;
    bool failed;       /* no memory */
    char trouble[400]; /* "", or the first figure without a rule, which is not in the list */
};

/* Collects all metrics of a document. Indistinguishable entries of a list become one metric with
 * the worst value, and their number in its path. STATUS_ENVIRONMENT: no memory. */
enum status metric_collect(const json_t *document, struct metrics *metrics, struct error *error);
void metric_free(struct metrics *metrics);

enum metric_verdict {
    VERDICT_SAME,
    VERDICT_BETTER,
    VERDICT_WORSE,
    VERDICT_INCOMPARABLE, /* changed, and no direction is better */
    VERDICT_VANISHED,     /* only the old document has it */
    VERDICT_NEW,          /* only the new one has it */
};
enum { METRIC_VERDICTS = VERDICT_NEW + 1 };
extern const char *const metric_verdicts[METRIC_VERDICTS];

/* Judges the change of a metric; old or new may be NULL. *amount: how much worse it is, relative to
 * the old value (absolute for an order); infinite if a word or a finite number was lost; 0 unless
 * it is worse. *fault: true if this change can fail a comparison with a threshold. */
enum metric_verdict metric_judge(const struct metric *old, const struct metric *new, double *amount,
                                 bool *fault);

/* True if a is worse than b, both of one kind; false for kinds without a direction. */
bool metric_worse(const struct metric *a, const struct metric *b);

struct metric_rule {
    /* Words separated by blanks. inside: members of which one is on the path to the figure, "" for
     * any path. names: of the figure; "*x" matches names that end in x, "x*" those that begin with
     * x. The first matching rule applies. */
    const char *inside, *names;
    enum { RULE_FIGURE, RULE_LEFT_OUT } use; /* left out: context, or judged elsewhere */
    enum metric_kind kind;
    double noise, floor;
};

/* The rule for this member of the object at path; NULL: none. */
const struct metric_rule *metric_rule(const char *path, const char *name);

/* True if one of these names, separated by blanks, is a component of the path outside brackets. */
bool metric_passes(const char *path, const char *names);
