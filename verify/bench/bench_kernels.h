/* SPDX-License-Identifier: GPL-3.0-or-later
 * Times a pair of particles for every kernel: in the solver's loops and steps (1D) and sums (2D and
 * 3D) and in every gradient operator in 1D, 2D and 3D; specialised, generic, and the same
 * arithmetic without a search. */
#pragma once

#include <jansson.h>

#include "bench.h"
#include "sweep.h"
#include "table.h"

struct bench_cost {
    double ns_per_pair, spread; /* NaN: does not apply */
};

struct bench_kernel_row {
    const char *kernel, *what; /* what: "density", "step ia", an operator's name ... */
    bool on_cloud; /* a gradient operator on a cloud of points, else a part of the solver */
    int dim;
    double pairs; /* per particle */
    double ns_per_particle;
    size_t whole; /* row of the evaluation that contains this part */
    double share; /* fraction of its time; NaN: not a part */
    struct bench_cost specialised, generic, limit;
    double error; /* operators: rms of |gradient error| h/max|f|, smooth field, jittered cloud */
};

struct bench_kernels {
    size_t count;
    struct bench_kernel_row *rows;
};

/* sweep: the kernels (its only key may be kernel; no key: all). Call bench_kernels_free even after
 * a failure. */
enum status bench_kernels_measure(const struct sweep *sweep, const struct bench_rules *rules,
                                  struct bench_kernels *result, struct error *error);
void bench_kernels_free(struct bench_kernels *result);

/* Array "kernels" of a result document. */
void bench_kernels_add_json(const struct bench_kernels *result, json_t *document);
void bench_kernels_print(const struct bench_kernels *result, const struct table_style *style);
