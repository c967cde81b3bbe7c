/* SPDX-License-Identifier: GPL-3.0-or-later
 * Random particles in a box, and what a problem measures of them. Include after test.h. */
#pragma once

#include "prepared.h"

enum { N = 300 }; /* arrays have one more element, which must not count */

/* Particles at random positions in a box, the first one at its centre. */
struct cloud {
    double x[3][N + 1], v[3][N + 1], m[N + 1], volume[N + 1];
    struct snapshot snapshot;
};

static inline void scatter(struct cloud *cloud, const struct prepared *p, double time)
{
    for (int i = 0; i <= N; i++) {
        for (int d = 0; d < 3; d++) {
            const double lo = p->domain.lo[d],
                         length = d < p->domain.dim ? domain_length(&p->domain, d) : 1;
            cloud->x[d][i] = lo + length * fmod((0.6180339887 + 0.1317 * d) * i + 0.5, 1);
            cloud->v[d][i] = sin(3.3 * i + d);
        }
        cloud->m[i] = 1 + 0.2 * cos(2.1 * i);
        cloud->volume[i] = 0.01 * (1 + 0.4 * sin(4.9 * i));
    }
    cloud->snapshot = (struct snapshot){.n = N,
                                        .x = {cloud->x[0], cloud->x[1], cloud->x[2]},
                                        .v = {cloud->v[0], cloud->v[1], cloud->v[2]},
                                        .m = cloud->m,
                                        .volume = cloud->volume,
                                        .time = time};
}

/* The values are equal, or both are NaN. */
static inline void same(double a, double b)
{
    if (!(a == b || (isnan(a) && isnan(b)))) fail_msg("%.17g is not %.17g", a, b);
}

static inline double measured(const struct prepared *p, const char *name, const struct snapshot *s)
{
    return prepared_functional(p, name)->measure(p, s);
}

static inline double exactly(const struct prepared *p, const char *name, double t)
{
    return prepared_functional(p, name)->exact(p, t);
}

/* The state at a distance r from the middle in the direction "2 -1 2", cut to the number of
 * dimensions; *n is the unit vector. The sample must set every value. */
static inline struct problem_state sampled(const struct prepared *p, double r, double t,
                                           double n[3])
{
    static const double way[3] = {2, -1, 2}, sizes[4] = {1, 2, 2.23606797749979, 3};
    struct problem_state state = {7, {7, 7, 7}, 7, 7};
    double x[3] = {9, 9, 9};
    for (int d = 0; d < 3; d++) {
        n[d] = d < p->domain.dim ? way[d] / sizes[p->domain.dim] : 0;
        if (d < p->domain.dim) x[d] = p->window.centre[d] + r * n[d];
    }
    p->problem->sample(p, x, t, &state);
    return state;
}

/* The last time at which the solution holds, to the last bit. */
static inline double last_time(const struct prepared *p)
{
    double lo = 0, hi = 100;
    assert_true(p->problem->holds(p, lo) && !p->problem->holds(p, hi));
    while (nextafter(lo, hi) < hi) {
        const double middle = lo + 0.5 * (hi - lo);
        *(p->problem->holds(p, middle) ? &lo : &hi) = middle;
    }
    return lo;
}

static inline void lasts_until(const struct prepared *p, double t)
{
    assert_true(p->problem->holds(p, t) && !p->problem->holds(p, t * (1 + 1e-14)));
}

static inline void refused_late(const struct prepared *p, double t, const char *format,
                                double longest, double more)
{
    struct error error = {0};
    char words[300];
    assert_int_equal(problem_check_time(p, t, &error), STATUS_BAD_INPUT);
    if (more > 0)
        snprintf(words, sizeof words, format, t, more, longest * (1 - 1e-3));
    else
        snprintf(words, sizeof words, format, t, longest * (1 - 1e-3));
    assert_string_equal(error.message, words);
}
