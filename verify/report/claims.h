/* SPDX-License-Identifier: GPL-3.0-or-later
 * Measures claims about schemes: one figure of runs with two sets of keys on the same case, and
 * which is nearer to the exact value, for several kernels and viscosities. */
#pragma once

#include <jansson.h>
#include <stdbool.h>

#include "pool.h"
#include "run.h"

/* A run with these keys. claim_run_add adds it to a pool, which the run must outlive. */
struct claim_run {
    char keys[256];
    struct run run;
    size_t job;
};
enum status claim_run_add(struct claim_run *of, const char *case_name, struct pool *pool,
                          struct error *error);

struct claims {
    struct claim_run *runs; /* two for each row of each claim, in order */
    size_t count;
};

/* Adds the runs to a pool; claims, initialised with {0}, must outlive it. */
enum status claims_plan(struct claims *claims, bool nightly, struct pool *pool,
                        struct error *error);

/* After the pool has run: [{"name", "claim", "verdict", "rows": [{"label", "figure", "without",
 * "with", "verdict", "reproduce"}]}], errors relative to exact values that are not 0. New
 * reference. */
json_t *claims_judge(const struct claims *claims, const struct pool *pool);

void claims_free(struct claims *claims);

/* The claim that Wendland functions keep particles from pairing because their Fourier transforms
 * are nowhere negative (Dehnen & Aly 2012), measured: disordered gas comes to rest with every
 * kernel, from few neighbours to many, in 2D and 3D, and particles in pairs are counted. */
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
