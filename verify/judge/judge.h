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

/* The options of a judgement. */
struct judge_request {
    const char *case_name;                 /* NULL: the case that the file names */
    const struct run_settings *asked;      /* the case with its keys; NULL: by its name alone */
    const char *left, *right;              /* "rho v P"; NULL: the case's */
    struct snapshot_value gamma, x0, time; /* given by the user */
    const char *box;                       /* as snapshot_take_box reads it; NULL: the file's */
    const char *boundary;                  /* periodic, open or reflecting; NULL: found */
    bool window;                           /* between ends[] along x */
    double ends[2], radius;                /* radius > 0: a disc or ball about the middle */
    int kernel; /* index in kernel_family.members; -1: found from the snapshot */
    struct width_meaning width;
    bool allow_far; /* a foreign snapshot passes */
    struct snapshot_options options;
};

/* A snapshot and the results. Free with judge_free. */
struct judged {
    const char *path;
    struct snapshot_file file; /* P, u and h completed */
    struct conventions conventions;
    struct run run;
    struct run_result result;
    struct conservation sums;  /* of the gas; no momentum where walls or gravity push */
    struct conservation start; /* of the case at t = 0 in the same box; mass 0: unknown */
    double case_n;             /* number of particles in the case's own box at the same spacing */
    int case_dim;              /* dimension of the case file */
    double slab;  /* thickness of a planar flow given as layers in 3D; the file's masses are divided
                     by it. 0: the file has as many dimensions as the case */
    bool altered; /* the initial state or gravity is not the case's */
    bool boxed;   /* the gas fills a known box without open ends */
    double transverse; /* rms of velocities across x, by volume, in the window; NaN in 1D */
    double wrong;      /* worst median error of a field over the range of its exact values */
    enum field wrong_field;
    bool far;          /* far from this case's solution */
    bool foreign;      /* far from this case's solution, of another gas, or a damaged start */
    bool passes;       /* not foreign, or allowed to be */
    bool silent;       /* the case has no exact value at this time, and that was not allowed */
    double case_gamma; /* gamma of the case named by the user, if the file's differs; else 0 */
    struct judge_start of_start; /* comparison at t = 0 */
    char meant[64]; /* our case that the snapshot fits, if it is far from the one asked for */
    char verdict[1000];
};

/* Judges one snapshot. A snapshot far from its case is also compared with our other cases.
 * STATUS_BAD_INPUT: the message says what the file contains and what would help. */
enum status judge_snapshot(const char *path, const struct judge_request *request,
                           struct judged *judged, struct error *error);
void judge_free(struct judged *judged);

/* ---- steps of judge_snapshot ---- */

/* judge_snapshot without other cases; glance: without identifying the kernel. */
enum status judge_as(const char *path, const struct judge_request *request, bool glance,
                     struct judged *judged, struct error *error);

/* Finds gamma, time, box and the case's position in the box; fills judged->run. */
enum status judge_geometry(const struct judge_request *request, struct judged *judged,
                           double period[3], struct error *error);

/* STATUS_BAD_INPUT: no particle lies in the window. */
enum status judge_check_window(const struct judged *judged, struct error *error);

/* Adds the conserved sums of a snapshot's particles, each moved by `shift`, as a run counts them:
 * no momentum where walls or gravity act. */
void judge_sum(const struct prepared *problem, const struct snapshot *snapshot,
               const double shift[3], struct conservation *sums);

/* ---- several snapshots ---- */

/* Differences of the conserved sums between the first and the last of several snapshots of one run
 * (of several runs: the one with most particles). False if no two snapshots have as many particles,
 * one problem and different times. */
bool judge_drift(const struct judged *judged, size_t n, struct trace_drift *drift, size_t pair[2]);

/* The largest differences from the first snapshot over all snapshots between these two, {"mass",
 * "momentum", "angular_momentum" (null in 1D), "energy", the members of run_add_motion, "between":
 * two files}. Without two such snapshots: from the case's initial state to judge_main; null if that
 * is unknown as well. *trace: initialised here; the sums used. New reference. */
json_t *judge_conservation(const struct judged *judged, size_t n, struct trace *trace);

/* The snapshot that gates judge: the last one of those with most particles. */
const struct judged *judge_main(const struct judged *judged, size_t n);

/* True for keys of which a flow depends: of its initial state, and gravity. */
bool judge_key_of_problem(enum setting key);

/* True if the last snapshots of each n are of one problem (case, dimension, gamma, gravity, initial
 * states) and at one time, without which there are no orders. Otherwise `why` names the difference
 * and two files. */
enum { JUDGE_WHY = 420 };
bool judge_one_ladder(const struct judged *judged, size_t n, char why[JUDGE_WHY]);

/* Orders of L1 against n^(1/d) for all fields, from the last snapshot of each n: [{"field", "norm",
 * "order", "low", "high", "pairwise"}], [] without two different n of one problem. New reference.
 */
json_t *judge_orders(const struct judged *judged, size_t n);

/* Judges the gates of the command line ("density_l1=2e-3,order.density>=0.9"; NULL: none) and, if
 * of_case, the case's own bounds scaled to this number of particles, its orders if there are enough
 * levels, and conservation. [{"name", "relation": "<=" or ">=", "value", "bound", "status",
 * "source"}]; orders also have "low" and "high", and gates that do not simply pass or fail have
 * "why". status: one of finding_words; an order whose interval contains its bound is undetermined.
 * New reference. STATUS_BAD_INPUT: an unknown name, or the case's gates do not apply to this
 * snapshot. */
#define JUDGE_ASKED "--gate" /* "source" of gates of the command line */
enum status judge_gates(const char *asked, bool of_case, const struct judged *judged, size_t n,
                        json_t **gates, struct error *error);

/* The results for one snapshot. New reference; NULL: no memory. */
json_t *judge_one_json(const struct judged *judged, bool profiles);

/* The document of the command, without its head; terminal, page, JUnit and exit status are made
 * from it. "findings": [{"name", "status", "message"}], one for each snapshot (is it the case's
 * solution?) and each gate; a gate of the command line that cannot be decided fails, and one
 * finding fails if nothing could be compared. "status" and "headline" follow from the findings.
 * With profiles it contains what page.h draws. New reference; NULL: no memory. */
json_t *judge_json(const struct judged *judged, size_t n, json_t *gates, bool profiles);

/* A shock tube with ends: two gases in contact, in a box with open ends or walls, as textbooks draw
 * it. The exact solution is that of an endless tube, valid until waves return from an end.
 *
 * Are there ends? Either the user says so (--boundary), or the gas at both ends of [ends[0],
 * ends[1]] is still undisturbed where waves of a mirrored tube would have passed. Notes the result
 * in judged. settings: gases, gamma and time. */
bool judge_tube_ends(const struct judge_request *request, struct judged *judged,
                     const struct settings *settings, const double ends[2]);

/* Finds where errors are measured: in the user's window, else from end to end without what
 * returning waves may have reached. box: long enough that a mirrored tube beyond the ends has no
 * influence. Both are pairs along x. STATUS_BAD_INPUT: waves may have reached everything. */
enum status judge_tube_window(const struct judge_request *request, struct judged *judged,
                              const struct settings *settings, double x0, const double ends[2],
                              double window[2], double box[2], struct error *error);
