/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes text snapshots with values that a test sets, and judges them. Include after test.h. */
#pragma once

#include "draw.h"
#include "judge.h"
#include "keyed.h"
#include "own_folder.h"

enum { N = 240 };

/* A snapshot as text, with only those columns that are set. */
struct planted {
    int dim;
    char head[200];
    bool has_u, has_P, has_h;
    double x[3][N], v[3][N], m[N], rho[N], u[N], P[N], h[N];
    int others; /* number of particles in the last rows that are not gas */
    int digits; /* of all but positions; 0: all */
};

static struct planted gas;

/* Gas at random positions in [lo, lo + (2, 1, 1)], at rest and in equilibrium. */
static inline void plant(int dim, double lo, const char *head)
{
    gas = (struct planted){.dim = dim, .has_u = true};
    snprintf(gas.head, sizeof gas.head, "%s", head);
    for (int i = 0; i < N; i++) {
        for (int d = 0; d < dim; d++) gas.x[d][i] = draw(lo, lo + (d ? 1 : 2));
        gas.m[i] = draw(1, 2) / N;
        gas.rho[i] = 1, gas.u[i] = 2.5, gas.P[i] = 1;
    }
    for (int d = 0; d < dim; d++) gas.x[d][0] = lo, gas.x[d][1] = lo + (d ? 1 : 2);
}

static inline char *put(const char *name)
{
    char *path = path_of(name);
    const int digits = gas.digits ? gas.digits : 17;
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fprintf(out, "%s", gas.head);
    for (int d = 0; d < gas.dim; d++) fprintf(out, "%c,v%c,", 'x' + d, 'x' + d);
    fprintf(out, "m%s%s%s,rho%s\n", gas.has_u ? ",u" : "", gas.has_P ? ",P" : "",
            gas.has_h ? ",h" : "", gas.others ? ",itype" : "");
    for (int i = 0; i < N; i++) {
        for (int d = 0; d < gas.dim; d++)
            fprintf(out, "%.17g,%.*g,", gas.x[d][i], digits, gas.v[d][i]);
        fprintf(out, "%.*g", digits, gas.m[i]);
        if (gas.has_u) fprintf(out, ",%.*g", digits, gas.u[i]);
        if (gas.has_P) fprintf(out, ",%.*g", digits, gas.P[i]);
        if (gas.has_h) fprintf(out, ",%.*g", digits, gas.h[i]);
        fprintf(out, gas.others ? ",%.*g,%d\n" : ",%.*g\n", digits, gas.rho[i],
                i < N - gas.others ? 1 : 2);
    }
    fclose(out);
    return path;
}

/* A request for a tube whose two gases are the same. */
static inline struct judge_request uniform_gas(void)
{
    return (struct judge_request){.case_name = "sod",
                                  .left = "1 0 1",
                                  .right = "1 0 1",
                                  .gamma = {true, 1.4},
                                  .time = {true, 0.1},
                                  .kernel = -1};
}

/* The caller frees it with judge_free. */
static inline struct judged judges(const struct judge_request *request)
{
    struct judged judged;
    struct error error = {0};
    if (judge_snapshot(put("a.csv"), request, &judged, &error)) fail_msg("%s", error.message);
    return judged;
}

static inline void refuses(const struct judge_request *request, const char *says)
{
    struct judged judged;
    struct error error = {0};
    const enum status status = judge_snapshot(put("a.csv"), request, &judged, &error);
    judge_free(&judged);
    if (status != STATUS_BAD_INPUT || !strstr(error.message, says))
        fail_msg("status %d, '%s' is not in: %s", (int)status, says, error.message);
}

static inline const struct snapshot_note *note(const struct judged *judged, const char *what)
{
    const struct snapshot_notes *notes = &judged->file.notes;
    for (size_t k = notes->count; k-- > 0;)
        if (strcmp(notes->note[k].what, what) == 0) return &notes->note[k];
    fail_msg("nothing is said about %s", what);
    return NULL;
}

__attribute__((unused)) static const char *const boxes[] = {"", "# box = 2\n", "# box = 2 1\n",
                                                            "# box = 2 1 1\n"};
