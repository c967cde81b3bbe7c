/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lattices and quasi-random points of the whole box, worked out a second time. */
#include "test.h"

#include <gsl/gsl_qrng.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

#include "gas.h"
#include "initial_fill.h"
#include "lattice.h"
#include "made_digits.h"
#include "near.h"

TEST(the_whole_box_is_laid)
{
    for (int dim = 2; dim <= 3; dim++) {
        static char *keys[] = {"n=64", "lattice=random", "seed=3"};
        const struct prepared p = {.problem = &gas_problem, .domain = {dim, {-1, 0, 1}, {1, 3, 2}}};
        for (int random = 0; random < 2; random++) {
            keys[1] = random ? "lattice=random" : "lattice=hexagonal";
            const struct settings settings = gas_settings(3, keys);
            struct lattice_plan plan;
            struct initial initial;
            struct error error = {0};
            assert_int_equal(initial_fill(&p, &settings, &initial, &error), STATUS_OK);
            assert_int_equal(lattice_plan_make(&plan, &p.domain,
                                               random ? LATTICE_RANDOM : LATTICE_HEXAGONAL, 64,
                                               &error),
                             STATUS_OK);
            double y[3][100], shift[3];
            double *const x[] = {y[0], y[1], y[2]};
            assert_true(plan.n == initial.n && plan.n < 100);
            gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
            gsl_qrng *sequence = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dim);
            gsl_rng_set(rng, 3);
            for (int d = 0; d < 3; d++) shift[d] = gsl_rng_uniform(rng);
            if (!random) assert_int_equal(lattice_points(&plan, 3, x, &error), STATUS_OK);
            for (size_t i = 0; i < plan.n; i++) {
                double part[3], place[3] = {0};
                gsl_qrng_get(sequence, part);
                for (int d = 0; d < dim; d++) {
                    part[d] = made_digits(part[d], d, 3) + shift[d];
                    if (random)
                        y[d][i] = p.domain.lo[d] +
                                  (p.domain.hi[d] - p.domain.lo[d]) * (part[d] - floor(part[d]));
                    near_absolute(initial.x[d][i] + 9, y[d][i] + 9, 1e-14);
                    place[d] = initial.x[d][i];
                }
                near_relative(initial.m[i], 6. / (double)plan.n * gas_density(place), 1e-14);
            }
            gsl_qrng_free(sequence);
            gsl_rng_free(rng);
            initial_free(&initial);
        }
    }
}

/* In a box of their own shape each point has as many others at the smallest distance as it should,
 * which the density gives; no cell is another one's. */
TEST(crystals)
{
    static const struct {
        enum lattice kind;
        int dim, nearest;
        size_t n, cells[3];
        double side[3], distance; /* of the box; of neighbours, n and volume being what they are */
    } rows[] = {
        {LATTICE_UNIFORM, 1, 2, 5, {5, 1, 1}, {5}, 1},
        {LATTICE_SQUARE, 2, 4, 12, {4, 3, 1}, {4, 3}, 1},
        {LATTICE_CUBIC, 3, 6, 60, {3, 4, 5}, {3, 4, 5}, 1},
        {LATTICE_JITTERED, 3, 6, 60, {3, 4, 5}, {3, 4, 5}, 1},
        {LATTICE_HEXAGONAL, 2, 6, 30, {5, 3, 1}, {5, 5.196152422706632}, 1},
        {LATTICE_HEXAGONAL, 3, 12, 144, {4, 3, 3}, {4, 5.196152422706632, 4.898979485566356}, 1},
        {LATTICE_FCC, 3, 12, 144, {3, 4, 3}, {3, 4, 3}, M_SQRT1_2},
        {LATTICE_BCC, 3, 8, 72, {3, 4, 3}, {3, 4, 3}, 0.8660254037844386},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        enum { MOST = 200 };
        const int dim = rows[k].dim;
        struct domain box = {dim, {-1, 2, 0.5}, {0}};
        struct lattice_plan plan;
        struct error error = {0};
        double y[3][MOST];
        double *const x[] = {y[0], y[1], y[2]};
        for (int d = 0; d < 3; d++) box.hi[d] = box.lo[d] + rows[k].side[d];
        assert_int_equal(lattice_plan_make(&plan, &box, rows[k].kind, rows[k].n, &error),
                         STATUS_OK);
        assert_int_equal(plan.n, rows[k].n);
        for (int d = 0; d < 3; d++) assert_int_equal(plan.cells[d], rows[k].cells[d]);
        assert_int_equal(lattice_points(&plan, 1, x, &error), STATUS_OK);
        for (size_t i = 0; i < plan.n; i++) {
            int nearest = 0;
            for (int d = 0; d < dim; d++) assert_true(y[d][i] > box.lo[d] && y[d][i] < box.hi[d]);
            for (size_t j = 0; j < plan.n; j++) {
                double square = 0;
                for (int d = 0; d < dim; d++)
                    square += pow(remainder(y[d][i] - y[d][j], rows[k].side[d]), 2);
                if (j == i) continue;
                const double away = sqrt(square) / rows[k].distance;
                assert_true(away > 1 - 1e-12);
                nearest += away < 1 + 1e-12;
            }
            assert_int_equal(nearest, rows[k].nearest);
        }
        /* the first cell stands in the corner, a half or a quarter in */
        const double part =
            rows[k].n == rows[k].cells[0] * rows[k].cells[1] * rows[k].cells[2] ? 0.5 : 0.25;
        for (int d = 0; d < dim; d++)
            near_relative(y[d][0] - box.lo[d], part * rows[k].side[d] / (double)rows[k].cells[d],
                          1e-14);
    }
}

/* Asked directly, too: in fewer dimensions there is no such crystal, and no point of it. */
TEST(crystals_have_their_dimensions)
{
    static const struct {
        enum lattice kind;
        int least;
    } rows[] = {{LATTICE_UNIFORM, 1},   {LATTICE_CLUSTERED, 1}, {LATTICE_COINCIDENT, 1},
                {LATTICE_SQUARE, 2},    {LATTICE_CUBIC, 2},     {LATTICE_JITTERED, 2},
                {LATTICE_HEXAGONAL, 2}, {LATTICE_FCC, 3},       {LATTICE_BCC, 3}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int dim = 1; dim <= rows[k].least; dim++) {
            const struct domain box = {dim, {0}, {1, 1, 1}};
            struct lattice_plan plan;
            struct error error = {0};
            assert_int_equal(lattice_plan_make(&plan, &box, rows[k].kind, 8, &error),
                             dim < rows[k].least ? STATUS_BAD_INPUT : STATUS_OK);
            if (dim < rows[k].least) assert_non_null(strstr(error.message, "has no form in"));
        }
}

/* As many cells as fit best: 2.5 of them, and a little more or less. */
TEST(cells_that_fit)
{
    for (int more = -1; more <= 1; more += 2) {
        const double fit = 2.5 * (1 + more * 2e-7);
        const struct domain box = {2, {0, 0}, {1, 10 / (fit * fit)}};
        struct lattice_plan plan;
        struct error error;
        assert_int_equal(lattice_plan_make(&plan, &box, LATTICE_SQUARE, 10, &error), STATUS_OK);
        assert_int_equal(plan.cells[0], more > 0 ? 3 : 2);
        assert_int_equal(plan.cells[1], 4);
    }
}

/* So many quasi-random points that some come as near to an end as to a millionth: all are in. */
TEST(sobol_points_stay_inside)
{
    enum { N = (1 << 20) + 1 };
    const struct domain box = {2, {-1, 3}, {1, 4}};
    struct lattice_plan plan;
    struct error error;
    double *y = malloc(2 * N * sizeof *y);
    double *const x[] = {y, y + N, NULL};
    assert_int_equal(lattice_plan_make(&plan, &box, LATTICE_RANDOM, N, &error), STATUS_OK);
    assert_int_equal(lattice_points(&plan, 7, x, &error), STATUS_OK);
    for (int d = 0; d < 2; d++) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (int i = 0; i < N; i++) lo = fmin(lo, x[d][i]), hi = fmax(hi, x[d][i]);
        const double side = box.hi[d] - box.lo[d];
        assert_true(lo >= box.lo[d] && lo < box.lo[d] + 1e-6 * side);
        assert_true(hi < box.hi[d] && hi > box.hi[d] - 1e-6 * side);
    }
    free(y);
}

/* The first seed's points are Sobol's, moved as one. Those of another seed are no such image of
 * them, and as even: no two of 255 points are in the same of 256 equal parts of an axis. */
TEST(seeds_have_arrangements_of_their_own)
{
    enum { N = 256, SEEDS = 6 };
    static double x[SEEDS][3][N];
    const struct domain box = {3, {0, 0, 0}, {1, 1, 1}};
    struct lattice_plan plan;
    struct error error;
    assert_int_equal(lattice_plan_make(&plan, &box, LATTICE_RANDOM, N, &error), STATUS_OK);
    gsl_qrng *sobol = gsl_qrng_alloc(gsl_qrng_sobol, 3);
    for (int s = 0; s < SEEDS; s++) {
        double *const to[] = {x[s][0], x[s][1], x[s][2]};
        assert_int_equal(lattice_points(&plan, (unsigned long)s + 1, to, &error), STATUS_OK);
        for (int d = 0; d < 3; d++) {
            double lowest = 1; /* of the places in their parts, which all share */
            bool taken[N] = {false};
            for (int i = 0; i < N - 1; i++) lowest = fmin(lowest, fmod(x[s][d][i] * N, 1));
            for (int i = 0; i < N - 1; i++) {
                const double moved = x[s][d][i] * N - lowest + 1e-9;
                const int part = (int)floor(moved);
                assert_true(part >= 0 && part < N && !taken[part]);
                taken[part] = true;
            }
        }
    }
    for (int i = 0; i < N; i++) {
        double point[3];
        gsl_qrng_get(sobol, point);
        for (int d = 0; d < 3; d++) {
            const double shift = x[0][d][i] - point[d] - (x[0][d][0] - 0.5);
            near_below(fabs(shift - round(shift)), 1e-14);
        }
    }
    for (int s = 0; s < SEEDS; s++)
        for (int other = 0; other < s; other++)
            for (int d = 0; d < 3; d++) {
                int differing = 0;
                for (int i = 1; i < N; i++) {
                    const double own = x[s][d][i] - x[s][d][0],
                                 theirs = x[other][d][i] - x[other][d][0];
                    differing += fabs(own - theirs - round(own - theirs)) > 1e-6;
                }
                assert_true(differing > N / 4);
            }
    gsl_qrng_free(sobol);
}
