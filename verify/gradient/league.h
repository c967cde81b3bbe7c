/* SPDX-License-Identifier: GPL-3.0-or-later
 * The league table of gradient operators: the polynomials for which each is exact, its convergence
 * on disordered points, what it conserves, and its cost. */
#pragma once

#include <jansson.h>

#include "status.h"

struct league_row {
    const char *name; /* of the operator */
    int dim;
    int degree_lattice, degree_disordered;  /* polynomials exact in the interior; -1: none */
    double order_lattice, order_disordered; /* of a smooth field's error in the spacing */
    double error;                           /* of that field on a jittered lattice, h/max|f| */
    double error_edge;                      /* error where the support is truncated */
    double condition;                       /* largest there */
    double momentum, angular;               /* defects: rate of change over sum of |terms| */
    double ns_per_point, ns_per_pair;       /* whole call, search included, one thread */
    double neighbours;                      /* neighbours per point in that timing */
};

/* Measures all operators in 1D, 2D and 3D (jitter 0.2, cubic_spline at eta 2, 2.4, 2.4); about a
 * second. *count rows, to be freed. STATUS_ENVIRONMENT: no memory. */
enum status league_measure(struct league_row **rows, size_t *count, struct error *error);

/* {"rows": [{"operator", "dim", ...}], "reproduce"}, flat rows as a report shows them; 1D angular
 * momentum is null. New reference, NULL: no memory. */
json_t *league_json(const struct league_row *rows, size_t count);
