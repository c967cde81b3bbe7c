/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphproof/rates.h"

#include <stdlib.h>
#include <string.h>

#include "library.h"
#include "rate_table.h"

static void put(double *to, const double *from, size_t n)
{
    if (to) memcpy(to, from, n * sizeof *to);
}

enum sphproof_status sphproof_rates_evaluate(const struct sphproof_setup *theirs,
                                             const struct sphproof_rates *rates,
                                             struct sphproof_error *error)
{
    struct setup setup;
    struct error ours;
    struct rate_table table = {0};
    double *rest = calloc(theirs->n, sizeof *rest);
    if (!rest)
        return library_fail(error, STATUS_ENVIRONMENT, "no memory for %zu particles", theirs->n);
    enum sphproof_status status = library_setup(theirs, true, rest, &setup, error);
    if (!status) status = library_pass(rate_table_make(&table, &setup, &ours), &ours, error);
    if (!status) {
        put(rates->h, table.h, table.n);
        put(rates->rho, table.rho, table.n);
        put(rates->P, table.P, table.n);
        put(rates->dU, table.dU, table.n);
        for (size_t i = 0; rates->neighbours && i < table.n; i++)
            rates->neighbours[i] = table.described[i].neighbours;
        for (int a = 0; a < setup.dim; a++) put(rates->force[a], table.force[a], table.n);
    }
    rate_table_free(&table);
    free(rest);
    return status;
}
