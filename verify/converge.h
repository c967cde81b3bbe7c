/* SPDX-License-Identifier: GPL-3.0-or-later
 * Convergence studies: one scheme over a ladder of resolutions; orders with their 95 % interval for
 * every field and norm, gates, functionals with Richardson extrapolation and GCI, and the floor
 * that the kernel's lattice sums set. */
#ifndef SPHPROOF_CONVERGE_H
#define SPHPROOF_CONVERGE_H

#include <jansson.h>

#include "order.h"
#include "run.h"
#include "suspicion.h"

struct converge_level {
    size_t n;
    double spacing; /* box/n: a length */
    double h;       /* mean smoothing length in the window, by volume */
    double errors[FIELDS][NORMS], binned_density_l1;
    double cpu_s;
    struct run_functional functionals[RUN_FUNCTIONALS_MAX];
};

enum converge_gate { GATE_NONE, GATE_PASS, GATE_FAIL };

struct converge_order {
    struct order_fit fit;
    enum converge_gate status;
    struct order_gate gate;    /* bound: at the ladder's finest level; see converge_execute */
    char why[ORDER_GATE_TEXT]; /* the condition that fails */
};

struct converge_result {
    struct settings settings; /* resolved, at the finest level */
    struct scheme scheme;
    size_t level_count, functional_count;
    struct converge_level levels[CASE_LADDER_MAX];
    struct converge_order orders[FIELDS][NORMS];
    struct order_extrapolation functionals[RUN_FUNCTIONALS_MAX]; /* of the three finest */
    double floor_density, floor_gradient; /* lattice sums of kernel and eta, relative */
    bool floor_explains;                  /* a failed order is of the size of the floor */
    char suspicion[SUSPICION_TEXT];       /* "" if nothing is too good to be true */
    bool passed;                          /* no gate failed, nothing is suspicious */
};

/* ladder: count >= 4 rising numbers of particles. The gates are the case's; a bound belongs to the
 * case's own finest level and is raised as the least order allows where the ladder ends before it.
 * progress (may be NULL) gets the work done and the whole, in n^2. STATUS_BROKE_DOWN names the
 * level; result then holds the levels before it. */
typedef void converge_progress(void *context, double done, double total);
enum status converge_execute(const struct run_settings *settings, const size_t *ladder,
                             size_t count, struct converge_result *result,
                             converge_progress *progress, void *context, struct error *error);

/* Arrays "levels", "orders" and "functionals" of a result document are extended by this study;
 * varied (may be NULL) goes with each entry as "settings". */
void converge_add_json(const struct converge_result *result, json_t *varied, json_t *document);

#endif
