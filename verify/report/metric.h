/* SPDX-License-Identifier: GPL-3.0-or-later
 * Readings: every figure of a result document of any kind, each with a path that stays the same
 * from one document to the next (entries of lists are named by what they are about, not by their
 * place), what it is, and how far it may move without meaning anything. Diff, history and baseline
 * are made of them. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "status.h"

enum metric_kind {
    READING_ERROR,   /* less is better; noise is relative */
    READING_CHECK,   /* less is better, a factor of 3 means nothing; its own status judges it */
    READING_ORDER,   /* more is better; noise is absolute */
    READING_PART,    /* less is better, but what it is a part of is judged itself: never a fault */
    READING_EXACT,   /* nearer `exact` is better; noise is relative, of the distance */
    READING_COUNT,   /* of work: less is better, never a fault; noise is relative */
    READING_TIMING,  /* less is better, never a fault; noise is a ratio */
    READING_STATUS,  /* a word */
    READING_NEUTRAL, /* neither more nor less is better: any change must be looked at */
};

struct metric {
    char *path; /* studies[sod, default].levels[198].errors.density.l1 */
    enum metric_kind kind;
    double value;               /* NaN for a word */
    double noise, floor, exact; /* up to the floor all values are the same */
    char *word;                 /* of a STATUS, else NULL */
    double rank;                /* of the check that it is a figure of; infinite: of none */
    size_t number;              /* in the document */
    bool headline;              /* goes into the history */
};

struct metrics {
    struct metric *list; /* sorted by path, each once */
    size_t count, room;
    bool failed;       /* no memory */
    char trouble[400]; /* "", or the first figure that no rule covers, which is not in the list */
};

/* All metrics of a document. Entries of a list that nothing tells apart are one reading, the worst
 * of them, with their number in its path. STATUS_ENVIRONMENT: no memory. */
enum status metric_collect(const json_t *document, struct metrics *metrics, struct error *error);
void metric_free(struct metrics *metrics);

/* The reading at a path, or NULL. */
const struct metric *metric_find(const struct metrics *metrics, const char *path);

enum metric_verdict {
    VERDICT_SAME,
    VERDICT_BETTER,
    VERDICT_WORSE,
    VERDICT_INCOMPARABLE, /* it changed, and neither way is better */
    VERDICT_VANISHED,     /* only the old document has it */
    VERDICT_NEW,          /* only the new one has it */
};
enum { READING_VERDICTS = VERDICT_NEW + 1 };
extern const char *const metric_verdicts[READING_VERDICTS];

/* Judges how a metric has changed; either may be NULL if it is there on one side only. *amount: how
 * much worse it is, relative to the old value (for an order: absolute); infinite if a word or a
 * finite number got lost; 0 unless it is worse. *fault: can this change fail a comparison with a
 * threshold? */
enum metric_verdict metric_judge(const struct metric *old, const struct metric *new, double *amount,
                                 bool *fault);

/* Is a the worse one of two metrics of one kind? For those without better or worse: no. */
bool metric_worse(const struct metric *a, const struct metric *b);

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
