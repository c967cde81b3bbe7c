/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stress_part.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>

#include "riemann.h"

enum { TUBES = 60, TUBES_QUICK = 10, LABEL = 12, KEYS = 160 };

static double log_uniform(gsl_rng *rng, double low, double high)
{
    return low * pow(high / low, gsl_rng_uniform(rng));
}

/* Time until waves from the tube at the ends of the periodic box, which travel half a unit of
 * length, reach the window; a lower limit if they meet others. */
static double free_time(const struct riemann_state *left, const struct riemann_state *right)
{
    struct riemann_solution tube, mirror;
    if (riemann_solve(1.4, left, right, &tube) || riemann_solve(1.4, right, left, &mirror))
        return 0;
    double speed = fmax(fabs(mirror.left_head), fabs(mirror.right_head));
    speed = fmax(speed, fmax(fabs(tube.left_head), fabs(tube.right_head)));
    return isnan(speed) || mirror.vacuum || tube.vacuum ? 0 : 0.4 / speed;
}

static double draw_state(gsl_rng *rng, double rho, double P, struct riemann_state *state)
{
    const double c = sqrt(1.4 * P / rho);
    *state = (struct riemann_state){rho, c * (3 * gsl_rng_uniform(rng) - 1.5), P};
    return c;
}

/* Draws a tube; false if waves would reach its window. */
static bool draw(gsl_rng *rng, char keys[KEYS])
{
    struct riemann_state left, right;
    const double rho = log_uniform(rng, 0.05, 10), P = log_uniform(rng, 0.01, 10);
    const double rho_ratio = log_uniform(rng, 1e-3, 1e3), P_ratio = log_uniform(rng, 1e-5, 1e5);
    const double c_left = draw_state(rng, rho, P, &left);
    const double c_right = draw_state(rng, rho * rho_ratio, P * P_ratio, &right);
    const unsigned long n = 60 + gsl_rng_uniform_int(rng, 180);
    if (right.v - left.v > 4 * (c_left + c_right)) return false;
    const double time = free_time(&left, &right);
    snprintf(keys, KEYS, "left=%.5g %.5g %.5g;right=%.5g %.5g %.5g;n=%lu;t_end=%.4g", left.rho,
             left.v, left.P, right.rho, right.v, right.P, n, time);
    return time > 0;
}

const struct stress_entry *stress_tubes(void)
{
    static struct stress_entry entries[TUBES + 1];
    static char labels[TUBES][LABEL], keys[TUBES][KEYS];
    if (entries[0].label) return entries;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < TUBES; k++) {
        while (!draw(rng, keys[k]))
            ;
        snprintf(labels[k], LABEL, "%d", k + 1);
        entries[k] = (struct stress_entry){labels[k], keys[k], k >= TUBES_QUICK};
    }
    gsl_rng_free(rng);
    return entries;
}
