/* SPDX-License-Identifier: GPL-3.0-or-later
 * Snapshots of any code against the exact solution of a case: the same errors and norms as of a
 * run, with everything that had to be assumed and the evidence for it. */
#pragma once

#include <jansson.h>

#include "conventions.h"
#include "judge_start.h"
#include "run.h"
#include "snapshot_file.h"

enum { JUDGE_SNAPSHOTS_MAX = 64 };

/* What is asked. */
struct judge_request {
    const char *case_name;                 /* NULL: the file's; with left and right: of its box */
    const struct run_settings *asked;      /* the case with its keys; NULL: by its name alone */
    const char *left, *right;              /* "rho v P"; NULL: the case's */
    struct snapshot_value gamma, x0, time; /* where the user says them */
    const char *box;                       /* as snapshot_take_box reads it; NULL: the file's */
    const char *boundary;                  /* periodic, open or reflecting; NULL: found */
    bool window;                           /* between ends[] along x */
    double ends[2], radius;                /* radius > 0: a disc or ball about the middle */
    int kernel;                            /* place in kernel_family.members; -1: found */
    struct width_meaning width;
    bool allow_far; /* what is foreign passes */
    struct snapshot_options options;
};

/* A snapshot and what was found. Free with judge_free. */
struct judged {
    const char *path;
    struct snapshot_file file; /* P, u and h completed */
    struct conventions conventions;
    struct run run;
    struct run_result result;
    struct conservation sums;  /* of the gas; no momentum where walls or gravity push */
    struct conservation start; /* of the case at t = 0 in the same box; mass 0: not known */
    double case_n; /* as many particles as the case's own box would have of the same spacing */
    int case_dim;  /* in which it is written */
    double slab;  /* a plane's gas in layers in 3D: how thick they are together, and what masses are
                     divided by to be those of the plane; 0: as many dimensions as the case */
    bool altered; /* another initial state than the case's */
    bool boxed;   /* the gas fills a box that is known, and has no other ends */
    double transverse; /* rms of velocities across x, by volume, in the window; NaN in 1D */
    double wrong;      /* worst median error of a field over the range of its exact values */
    enum field wrong_field;
    bool far;          /* from this case's solution */
    bool foreign;      /* far from this case's solution, of another gas, or a damaged start */
    bool passes;       /* not foreign, or that was allowed */
    bool silent;       /* nothing is known of the case at this time, and that was not allowed */
    double case_gamma; /* where the user named the case and the file has another gamma; else 0 */
    struct judge_start of_start; /* of t = 0 */
    char meant[64]; /* the case of ours that it fits, where it is far from the one asked for */
    char verdict[1000];
};

/* A snapshot that is far from its case is compared with our other cases as well. STATUS_BAD_INPUT:
 * what the file holds and what would help. */
enum status judge_snapshot(const char *path, const struct judge_request *request,
                           struct judged *judged, struct error *error);
void judge_free(struct judged *judged);

/* ---- steps of it ---- */

/* judge_snapshot without a word about other cases; glance: without looking for the kernel. */
enum status judge_as(const char *path, const struct judge_request *request, bool glance,
                     struct judged *judged, struct error *error);

/* Gamma, time, box and place of the case in it: resolves judged->run. */
enum status judge_place(const struct judge_request *request, struct judged *judged,
                        double period[3], struct error *error);

/* Adds what the particles of a snapshot conserve, each moved by `shift`, as a run counts it: no
 * momentum where walls or gravity push. */
void judge_sum(const struct prepared *problem, const struct snapshot *snapshot,
               const double shift[3], struct conservation *sums);

/* ---- several ---- */

/* How much a conserved quantity differs between the first and the last of several snapshots of one
 * run (of several runs: of most particles); false: there are no two of as many particles at
 * different times. */
bool judge_drift(const struct judged *judged, size_t n, struct trace_drift *drift, size_t pair[2]);

/* The largest differences of all snapshots between these two from the first, {"mass", "momentum",
 * "angular_momentum" (null in 1D), "energy", what run_add_motion adds, "between": two files}; where
 * there are no two, from the case's initial state to judge_main; null where that is not known
 * either. *trace: what they were taken from, begins anew. New reference. */
json_t *judge_conservation(const struct judged *judged, size_t n, struct trace *trace);

/* The snapshot that gates look at: of most particles, of these the last. */
const struct judged *judge_main(const struct judged *judged, size_t n);

/* Orders of L1 against n^(1/d), of all fields, from the last snapshot of each n: [{"field", "norm",
 * "order", "low", "high", "pairwise"}], [] where there are no two different n. New reference. */
json_t *judge_orders(const struct judged *judged, size_t n);

/* Gates: what is asked ("density_l1=2e-3,order.density>=0.9"; NULL: nothing) and, of_case, the
 * case's own bounds at this many particles, its orders where there are enough of them, and
 * conservation. [{"name", "relation": "<=" or ">=", "value", "bound", "status", "source"}], of
 * orders also "low" and "high", of what does not simply pass or fail "why". status: one of
 * finding_words; an order whose interval reaches across its bound is undetermined. New reference.
 * STATUS_BAD_INPUT: nothing is called so, or the case's gates do not hold for this snapshot. */
#define JUDGE_ASKED "--gate" /* the source of what is asked */
enum status judge_gates(const char *asked, bool of_case, const struct judged *judged, size_t n,
                        json_t **gates, struct error *error);

/* What the command says of one snapshot alone. New reference; NULL: no memory. */
json_t *judge_one_json(const struct judged *judged, bool profiles);

/* The document of the command, without its head, and what terminal, page, JUnit and exit status
 * show. "findings": [{"name", "status", "message"}], one of each snapshot (is it the case's
 * solution?) and of each gate, of which one that was asked for and cannot be told fails, and one
 * that fails where nothing could be compared; "status" and "headline" follow from them. With
 * profiles it is what page.h draws. New reference; NULL: no memory. */
json_t *judge_json(const struct judged *judged, size_t n, json_t *gates, bool profiles);

/* A tube with ends: two gases that meet once, in a box that is open or has walls there, as
 * textbooks draw it. The exact solution is that of an endless tube, until waves come back from an
 * end.
 *
 * Are there ends? So the user says (--boundary), or the gas at both ends of [ends[0], ends[1]] is
 * as undisturbed as the two gases were, where waves of a mirrored tube would have come by. Notes
 * what was found. settings: gases, gamma and time. */
bool judge_tube_ends(const struct judge_request *request, struct judged *judged,
                     const struct settings *settings, const double ends[2]);

/* Where errors are measured: as the user says, else from end to end but for what waves that came
 * back may have reached. box: so long that a mirrored tube beyond the ends cannot be felt. Both are
 * pairs along x. STATUS_BAD_INPUT: waves may have reached everything. */
enum status judge_tube_place(const struct judge_request *request, struct judged *judged,
                             const struct settings *settings, double x0, const double ends[2],
                             double window[2], double box[2], struct error *error);
