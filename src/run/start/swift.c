/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 for SWIFT: GADGET's layout, but SmoothingLength is twice the kernel's standard deviation.
 * SWIFT expects one unit system, periodic boxes, and InternalEnergy instead of entropy. */
#include <math.h>

#include "measure.h"
#include "start_format.h"

extern const struct snapshot_writer writer_hdf5;

static enum status two_sigma(const struct run_result *result, double *factor, struct error *error)
{
    const struct kernel *kernel = &result->scheme.kernel;
    struct pieces pieces;
    struct measure_moments moments;
    if (pieces_find(&pieces, kernel, result->problem.domain.dim, &pieces_terms_usual, error))
        return error->status;
    measure_moments(&pieces, &moments);
    pieces_free(&pieces);
    *factor = 2 * sqrt(moments.second);
    return STATUS_OK;
}

const struct start_format start_swift = {
    .member = {"swift", "HDF5 for SWIFT; h is twice the kernel's standard deviation",
               "Schaller et al. 2024"},
    .writer = &writer_hdf5,
    .gamma = "configure --with-adiabatic-index: 5/3, 7/5, 4/3 or 2",
    .dimension = "configure --with-hydro-dimension",
    .boundary = "InitialConditions: periodic 1, or 0 where it is open",
    .no_walls = true,
    .t_end = "TimeIntegration: time_end",
    .width = two_sigma,
};
