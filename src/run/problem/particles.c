/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles from a file, used as they are. Their later state is unknown, so that a run only reports
 * conservation and draws maps. (Any other problem may also read its particles from a file, and is
 * then judged by its own solution.) Without a file the particles get the state at t = 0 of a user's
 * reference. */
#include <math.h>

#include "initial.h"
#include "problem.h"

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    if (settings->file[0] || p->problem->user == USER_FUNCTION) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "an initial state of kind particles needs a file of them, file = "
                     "PARTICLES.csv in [initial], or a shared object that knows the state at t = "
                     "0, reference = ./mine.so in [case]");
}

/* Unknown even at the start, since a file gives no state between its particles. */
static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const double unknown = (double)NAN;
    (void)p, (void)x, (void)t;
    *state = (struct problem_state){unknown, {unknown, unknown, unknown}, unknown, unknown};
}

/* With a file, initial_create reads the particles instead. */
static enum status fill(const struct prepared *p, const struct settings *settings,
                        struct initial *initial, struct error *error)
{
    if (p->problem->user == USER_FUNCTION) return initial_fill(p, settings, initial, error);
    return error_set(error, STATUS_BAD_INPUT, "%s: no particles but those of a file",
                     p->problem->member.name);
}

#define ANY                                                                                        \
    {                                                                                              \
        .also = PROBLEM_END(OPEN) | PROBLEM_END(REFLECTING) | PROBLEM_END(FIXED)                   \
    }

const struct problem problem_particles = {
    .member = {"particles", "particles from a file, without an exact solution", ""},
    .reference = "none",
    .least_dim = 1,
    .most_dim = 3,
    .fieldless = true,
    .filed = true,
    .heavy = true,
    .ends = {ANY, ANY, ANY},
    .prepare = prepare,
    .sample = sample,
    .fill = fill,
};
