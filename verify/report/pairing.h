/* SPDX-License-Identifier: GPL-3.0-or-later
 * The claim that Wendland functions keep particles from pairing because their Fourier transforms
 * are nowhere negative (Dehnen & Aly 2012), measured: disordered gas comes to rest with every
 * kernel, from few neighbours to many, in 2D and 3D, and particles in pairs are counted. */
#pragma once

#include <jansson.h>
#include <stdbool.h>

#include "pool.h"
#include "run.h"

struct pairing {
    struct pairing_run *runs;
    size_t count;
};

/* Adds the runs to a pool; pairing, initialised with {0}, must outlive it. */
enum status pairing_plan(struct pairing *pairing, bool nightly, struct pool *pool,
                         struct error *error);

/* After the pool has run, one claim for each gradient: [{"name", "claim", "verdict", "bound",
 * "ladders": [{"kernel", "dim", "first_negative_kh", "predicted" (null: never), "neighbours",
 * "paired", "nearest" (lists; NaN if the run broke down), "verdict", "reproduce"}]}]. kernels:
 * documents of `sphproof kernel` with the theory of each. New reference. */
json_t *pairing_judge(const struct pairing *pairing, const struct pool *pool,
                      const json_t *kernels);

void pairing_free(struct pairing *pairing);
