/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the workspace of the sums in 2D and 3D: the search for roots, saved and restored states,
 * the messages about widths and positions for which neighbours cannot be found, and the memory that
 * each scheme needs. */
#include "test.h"

#include "byte_buffer.h"
#include "sample_lattice.h"
#include "solver.h"
#include "width.h"

#include "grid.h"

static double guess[N];

/* The displaced lattice with unequal masses. */
static struct setup setup_of(int dim, size_t side, const struct scheme *scheme)
{
    const struct setup setup = lattice_of(dim, side, 0.2, scheme);
    for (size_t i = 0; i < setup.n; i++) m[i] *= 1 + 0.1 * sin(2. * (double)i);
    return setup;
}

/* The search for a root increases its reach by a factor of 1.5 at most 63 times. */
TEST(search_widens_63_times)
{
    struct error error;
    for (int dim = 2; dim <= 3; dim++) {
        const struct scheme scheme = plain_scheme();
        struct setup setup = setup_of(dim, dim == 2 ? 8 : 5, &scheme);
        for (int a = 0; a < dim; a++) setup.boundary[a] = BOUNDARY_OPEN;
        struct simulation *simulation = simulation_of(&setup);
        struct snapshot s;
        double h[N];
        simulation_snapshot(simulation, &s);
        for (size_t i = 0; i < s.n; i++) h[s.id[i]] = s.h[i];
        simulation_destroy(simulation);
        setup.rho = guess;
        for (int beyond = 0; beyond < 2; beyond++) {
            const double furthest = 1.1 * pow(1.5, 63) * (beyond ? 1 + 1e-7 : 1 - 1e-7);
            for (size_t i = 0; i < setup.n; i++)
                guess[i] = m[i] * pow(scheme.eta * furthest / h[i], dim);
            simulation = NULL;
            const enum status status = simulation_create(&setup, &simulation, &error);
            assert_int_equal(status, beyond ? STATUS_BROKE_DOWN : STATUS_OK);
            if (status)
                assert_non_null(strstr(error.message, "smoothing length (no root was found) of "
                                                      "particle 0 at x = "));
            else
                simulation_snapshot(simulation, &s);
            for (size_t i = 0; !status && i < s.n; i++) near_relative(s.h[i], h[s.id[i]], 1e-10);
            simulation_destroy(simulation);
        }
    }
}

static bool ten_steps(void *context, double time, uint64_t steps)
{
    const uint64_t *from = context;
    (void)time;
    return steps < *from + 10;
}

/* A state that is saved and restored continues to the last bit, inactive particles included, and is
 * sorted at the same steps. */
TEST(restored_state_continues)
{
    static struct byte_buffer kept;
    for (int kind = 0; kind < 3; kind++) { /* inactive particles; predicted widths; all moving */
        struct scheme scheme = plain_scheme();
        const bool moving = kind == 2;
        if (kind == 1) {
            scheme.integrator =
                (const struct integrator *)family_find(&integrator_family, "predicted_midpoint");
            scheme.h_method = H_PREDICTED;
        }
        const struct setup setup = long_box_of(&scheme);
        u[0] = 3;
        for (size_t i = 0; moving && i < setup.n; i++) v[0][i] = 1.5, v[1][i] = 0.7;
        struct simulation *first = simulation_of(&setup), *second = simulation_of(&setup);
        uint64_t from = moving ? 30 : 0; /* after one more sort */
        assert_int_equal(simulation_run(first, 1, ten_steps, &from, NULL), STATUS_OK);
        struct serialiser out = {.bytes = buffer_put, .context = &kept},
                          back = {.bytes = buffer_take, .context = &kept, .back = true};
        kept.used = kept.read = 0;
        simulation_serialise(first, &out);
        assert_false(out.failed);
        simulation_serialise(second, &back);
        assert_false(back.failed);
        assert_int_equal(kept.read, kept.used);
        for (from += 10; from < 80; from += 10) {
            struct snapshot s, t;
            struct simulation_cost cost[2];
            assert_int_equal(simulation_run(first, 1, ten_steps, &from, NULL), STATUS_OK);
            assert_int_equal(simulation_run(second, 1, ten_steps, &from, NULL), STATUS_OK);
            simulation_snapshot(first, &s);
            simulation_snapshot(second, &t);
            simulation_cost(first, &cost[0]);
            simulation_cost(second, &cost[1]);
            assert_true(cost[0].skipped_particle_updates > 0);
            assert_true(cost[0].skipped_particle_updates == cost[1].skipped_particle_updates);
            assert_memory_equal(s.id, t.id, s.n * sizeof *s.id);
            for (int a = 0; a < 2; a++) assert_memory_equal(s.x[a], t.x[a], s.n * sizeof(double));
            assert_memory_equal(s.h, t.h, s.n * sizeof(double));
            assert_memory_equal(s.rho, t.rho, s.n * sizeof(double));
        }
        simulation_destroy(first);
        simulation_destroy(second);
    }
}

static void count_neighbours(void *context, size_t particle, const struct description *of)
{
    size_t *counts = context;
    (void)particle;
    counts[of->neighbours > 1]++;
    assert_true(isnan(of->angle) == (of->neighbours <= 1));
    assert_true(of->condition >= 1 && of->condition < 5);
}

/* The description of inactive particles, in a box whose far end no signal has reached. */
TEST(description_of_inactive_particles)
{
    struct scheme scheme = plain_scheme();
    scheme.gradient = GRADIENT_IA;
    for (int dim = 2; dim <= 3; dim++) {
        const size_t side = dim == 2 ? 8 : 5;
        struct setup setup = setup_of(dim, side, &scheme);
        setup.n = dim == 2 ? 128 * side : 40 * side * side;
        setup.skip = true;
        setup.hi[dim - 1] = (double)setup.n / pow((double)side, dim);
        for (size_t i = 0, at = 0; i < setup.n; at = ++i) {
            m[i] = pow((double)side, -dim), u[i] = i == 0 ? 2 : 1;
            for (int a = 0; a < dim; a++, at /= side) {
                const size_t k = a < dim - 1 ? at % side : at;
                x[a][i] = ((double)k + 0.5) / (double)side, v[a][i] = 0;
            }
        }
        struct simulation *simulation = simulation_of(&setup);
        assert_int_equal(simulation_run(simulation, 0.05, NULL, NULL, NULL), STATUS_OK);
        size_t counts[2] = {0};
        description_each(simulation, count_neighbours, counts);
        assert_true(counts[0] > setup.n / 8 && counts[1] > setup.n / 8);
        assert_int_equal(counts[1], simulation->sleep.awake_count);
        const struct description_sums sums = description_sum(simulation);
        assert_true(sums.angle_max >= sums.angle_mean && sums.condition_max >= 1);
        simulation_destroy(simulation);
    }
}

/* Smoothing lengths too wide for the box are bad input at the start. */
TEST(width_too_large_for_the_box)
{
    struct simulation *simulation = NULL;
    struct error error;
    for (int dim = 2; dim <= 3; dim++) {
        struct scheme scheme = plain_scheme();
        struct setup setup = setup_of(dim, 4, &scheme);
        setup.scheme.eta = 2.4;
        assert_int_equal(simulation_create(&setup, &simulation, &error), STATUS_BAD_INPUT);
        assert_non_null(strstr(error.message, "particle "));
        assert_non_null(strstr(error.message, " reaches as far as 0.75, beyond half the box (0.5): "
                                              "more particles or a smaller eta are needed"));
        assert_null(simulation);
        /* only periodic sides count, and of these the narrowest */
        setup.hi[1] = 4;
        for (size_t i = 0; i < setup.n; i++) x[1][i] *= 4;
        setup.boundary[0] = setup.boundary[2] = BOUNDARY_REFLECTING;
        simulation = simulation_of(&setup);
        simulation_destroy(simulation);
        simulation = NULL;
    }
}

/* In an open box one particle is so heavy that all others together have too little mass around
 * it. */
TEST(mass_too_large_for_a_root)
{
    for (int dim = 2; dim <= 3; dim++) {
        struct simulation *simulation = NULL;
        struct error error = {0};
        struct scheme scheme = plain_scheme();
        struct setup setup = setup_of(dim, 4, &scheme);
        for (int a = 0; a < dim; a++) setup.boundary[a] = BOUNDARY_OPEN;
        m[5] *= 1000;
        assert_int_equal(simulation_create(&setup, &simulation, &error), STATUS_BROKE_DOWN);
        assert_null(simulation);
        char said[120];
        snprintf(said, sizeof said,
                 "broke down at t = 0: smoothing length (no root was found) of particle 5 at x = "
                 "%.9g, y = %.9g",
                 x[0][5], x[1][5]);
        if (strncmp(error.message, said, strlen(said))) fail_msg("%s", error.message);
    }
}

/* Widths that grow too wide later are a breakdown, which names the particle that reaches
 * furthest. */
TEST(width_grows_too_large)
{
    for (int predicted = 0; predicted < 2; predicted++) {
        struct scheme scheme = plain_scheme();
        if (predicted) {
            scheme.integrator =
                (const struct integrator *)family_find(&integrator_family, "predicted_midpoint");
            scheme.h_method = H_PREDICTED;
        }
        struct setup setup = setup_of(2, 6, &scheme);
        setup.scheme.eta = 2.2;
        for (size_t i = 0; i < setup.n; i++) {
            u[i] = 1e-3;
            for (int a = 0; a < 2; a++) v[a][i] = sin(2 * M_PI * x[a][i]);
        }
        struct simulation *simulation = simulation_of(&setup);
        struct error error = {0};
        assert_int_equal(simulation_run(simulation, 1, NULL, NULL, &error), STATUS_BROKE_DOWN);
        struct snapshot s;
        struct simulation_cost cost;
        simulation_snapshot(simulation, &s);
        simulation_cost(simulation, &cost);
        assert_true(cost.steps > 0);
        size_t particle = N, widest = 0;
        double time, at[2], radius;
        char rest[200];
        if (sscanf(error.message,
                   "broke down at t = %lf: smoothing length of particle %zu at x = %lf, y = %lf is "
                   "%lf, %199[^\n]",
                   &time, &particle, &at[0], &at[1], &radius, rest) != 6)
            fail_msg("%s", error.message);
        assert_string_equal(
            rest, "beyond half the box (0.5): more particles or a smaller eta are needed");
        assert_true(radius > 0.5);
        near_relative(time, s.time, 1e-8);
        for (size_t i = 0; i < s.n; i++)
            if (s.h[i] > s.h[widest]) widest = i;
        assert_int_equal(particle, s.id[widest]);
        simulation_destroy(simulation);
    }
}

/* The message about a position that is not a number names the particle and the value. */
TEST(position_that_is_not_a_number)
{
    for (int dim = 2; dim <= 3; dim++)
        for (int a = 0; a < dim; a++)
            for (int last = 0; last < 2; last++) {
                const struct scheme scheme = plain_scheme();
                const struct setup setup = setup_of(dim, 5, &scheme);
                struct simulation *simulation = simulation_of(&setup);
                struct particles *p = &simulation->particles;
                const size_t i = last ? setup.n - 1 : 0;
                struct error error = {0};
                char text[64];
                p->x[a][i] = last ? -HUGE_VAL : HUGE_VAL;
                assert_int_equal(cells_sums.arrange(simulation, &error), STATUS_BROKE_DOWN);
                snprintf(text, sizeof text, "position of particle %zu at", p->id[i]);
                assert_non_null(strstr(error.message, text));
                snprintf(text, sizeof text, " is %sinf", last ? "-" : "");
                assert_non_null(strstr(error.message, text));
                simulation_destroy(simulation);
            }
}

/* Doubles per particle: the workspace's own arrays, and the record of its longest pass, rounded up
 * to a multiple of 4; if pairs are many or expensive, also twice the reactions of pairs that other
 * particles compute, and a flag. */
static void expect_bytes(int dim, const struct scheme *scheme, int arrays, int record)
{
    for (int sleep = 0; sleep < 2;
         sleep++) { /* a particle that may be inactive has 1/h, two disturbances and a flag */
        const struct setup setup = {
            .dim = dim, .scheme = *scheme, .n = 1000, .threads = 1, .skip = sleep};
        struct simulation simulation = {.scheme = *scheme, .plan = plan_of_setup(&setup)};
        const double lists = grid_bytes(dim, 1, width_neighbours(dim, scheme->eta * 1.1));
        const double found = cells_sums.bytes(&simulation, 1000) / 1000 - lists;
        const bool halves = scheme->eta > 3 || scheme->viscosity == VISCOSITY_PROJECTED;
        const double reactions = halves ? 2 * 8. * (dim + 2) + 1 : 0;
        near_absolute(found, 8. * arrays + 1 + 25. * sleep + 8. * record + reactions, 1e-9);
    }
}

/* Arrays: radius, two sums; two sums of U; condition, matrix, slope, switch, share, factor.
 * Records: position, v, 1/h, V, P, c. Comments give the fields added and the sizes in 2D and 3D. */
TEST(bytes_per_particle)
{
    for (int dim = 2; dim <= 3; dim++) {
        const bool plane = dim == 2;
        struct scheme scheme = plain_scheme();
        scheme.viscosity = VISCOSITY_NONE;
        expect_bytes(dim, &scheme, 3, plane ? 8 : 12); /* 8, 10 */
        scheme.viscosity = VISCOSITY_CONSTANT;
        expect_bytes(dim, &scheme, 3, 12); /* m, rho: 10, 12 */
        scheme.volume_element = VOLUME_ENERGY;
        expect_bytes(dim, &scheme, 5, 12);
        scheme.formulation = FORMULATION_LAGRANGIAN;
        expect_bytes(dim, &scheme, 5, 16); /* b, grad_h, Z: 13, 15 */
        scheme.alpha_u = 1;
        expect_bytes(dim, &scheme, 5, 16); /* u: 14, 16 */
        scheme.viscosity = VISCOSITY_TIME_DEPENDENT;
        expect_bytes(dim, &scheme, 5, plane ? 16 : 20); /* alpha: 15, 17 */
        scheme.gradient = GRADIENT_IA;
        expect_bytes(dim, &scheme, plane ? 9 : 12, plane ? 20 : 24); /* matrix: 18, 23 */
        scheme.viscosity = VISCOSITY_CULLEN_DEHNEN;
        expect_bytes(dim, &scheme, plane ? 15 : 23, plane ? 20 : 24);
        scheme.gradient = GRADIENT_BLENDED;
        expect_bytes(dim, &scheme, plane ? 16 : 24, plane ? 20 : 24); /* share: 19, 24 */
        scheme.balsara = BALSARA_ON;
        expect_bytes(dim, &scheme, plane ? 17 : 25, plane ? 20 : 28); /* factor: 20, 25 */
        scheme.viscosity = VISCOSITY_PROJECTED;
        expect_bytes(dim, &scheme, plane ? 15 : 23, plane ? 28 : 40); /* slope, P: 26, 39 */
        scheme.alpha_u = 0;
        expect_bytes(dim, &scheme, plane ? 15 : 23, plane ? 28 : 40); /* 25, 38 */
        scheme = plain_scheme();
        scheme.eta = 3.6;
        expect_bytes(dim, &scheme, 3, 12);
    }
}
