/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the passes over ranges of a line: each range is computed once with any number of threads,
 * widths with and without a root, ghosts, and the capacity of arrays. */
#include "test.h"

#include <stdatomic.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#ifdef _OPENMP
#include <omp.h>
#endif

#include "line/line.h"
#include "line/pass.h"
#include "sample_simulation.h"

/* --- passes ----------------------------------------------------------------------------------- */

enum { RANGES_MOST = 80 };

static atomic_int visits[RANGES_MOST], by_thread[4];

static void visit(struct simulation *simulation, struct range *range, struct tally *tally)
{
    const ptrdiff_t b = range - line_of(simulation)->ranges;
    visits[b]++;
    by_thread[tally->thread]++;
    if (range->first < tally->without_root) tally->without_root = range->first;
    if (range->reach > tally->reach) tally->reach = range->reach;
    tally->short_of_ghosts |= range->len == 63;
    tally->crossings += 1;
    tally->rate = fmax(tally->rate, (double)range->reach / 8);
    tally->pairs += (uint64_t)range->reach;
}

/* With fewer than 32 ranges, or with one thread, one thread computes all ranges. The result is the
 * same. */
TEST(every_range_is_computed_once)
{
    for (int size = 1; size <= 3; size++)
        for (ptrdiff_t count = 1; count <= RANGES_MOST;
             count += count == 31 || count == 32 ? 1 : 10)
            for (int last = 0; last < 2; last++) {
                struct range ranges[RANGES_MOST];
                struct line line = {.ranges = ranges, .range_count = count};
                struct simulation s = {.workspace = &line, .team = {.size = size, .most = 3}};
                uint64_t pairs = 0;
                for (ptrdiff_t b = 0; b < count; b++) {
                    visits[b] = 0;
                    ranges[b] = (struct range){.first = 1000 - (last ? b : -b), .len = 64};
                    ranges[b].reach = 1 + (7 * b) % 11;
                    pairs += (uint64_t)ranges[b].reach;
                }
                ranges[last ? count - 1 : 0].len = 63, ranges[last ? 0 : count - 1].reach = 50;
                pairs = 0;
                for (ptrdiff_t b = 0; b < count; b++) pairs += (uint64_t)ranges[b].reach;
                for (int t = 0; t < 4; t++) by_thread[t] = 0;
                const struct tally found = pass_all(&s, visit);
                for (ptrdiff_t b = 0; b < count; b++) assert_int_equal(visits[b], 1);
                assert_int_equal(found.without_root, last ? 1001 - count : 1000);
                assert_true(found.reach == 50 && found.short_of_ghosts && found.pairs == pairs);
                assert_true(found.crossings == (double)count && found.rate == 50. / 8);
#ifdef _OPENMP
                const int workers = count >= 32 ? size : 1;
#else
                const int workers = 1;
#endif
                for (int t = 0; t < 4; t++) assert_int_equal(by_thread[t] > 0, t < workers);
                ranges[last ? count - 1 : 0].len = 64;
                assert_false(pass_all(&s, visit).short_of_ghosts);
            }
}

/* --- widths ----------------------------------------------------------------------------------- */

static struct range *range_of(const struct simulation *simulation, ptrdiff_t i)
{
    struct range *range = line_of(simulation)->ranges;
    while (i >= range->first + range->len) range++;
    return range;
}

/* Moves particle i + 1 to the position of particle i: with this kernel neither has a root then. */
static void coincide(struct simulation *s, ptrdiff_t i)
{
    s->particles.x[0][i + 1] = s->particles.x[0][i];
}

/* The first particle without a root is named, whichever thread finds it. */
TEST(first_particle_without_a_root_is_named)
{
    static const ptrdiff_t places[][2] = {{0, 0},   {62, 62},   {64, 64},   {2559, 2559},
                                          {70, 68}, {2200, 67}, {67, 2200}, {1300, 1200}};
    for (size_t k = 0; k < sizeof places / sizeof *places; k++)
        for (int size = 1; size <= 2; size++) {
            struct simulation *s = sample_simulation(2561);
            struct error error;
            char said[160];
            s->team.size = s->team.most = size;
            coincide(s, places[k][0]);
            coincide(s, places[k][1]);
            const ptrdiff_t first = places[k][0] < places[k][1] ? places[k][0] : places[k][1];
            assert_int_equal(widths_find(s, true, 0, &error), STATUS_BROKE_DOWN);
            snprintf(said, sizeof said,
                     "broke down at t = 0: smoothing length (no root was found) of particle %zu at "
                     "x = %.9g is %.9g",
                     s->particles.id[first], s->particles.x[0][first], s->particles.h[first]);
            assert_string_equal(error.message, said);
            simulation_destroy(s);
        }
}

/* A reach that is too large is lowered in every eighth step, with Newton's method and with
 * predicted widths; a reach that is too small is raised in every step. */
TEST(reaches_are_lowered_every_eighth_step)
{
    for (int newton = 0; newton < 2; newton++)
        for (uint64_t step = 0; step < 18; step++) {
            struct simulation *s = sample_simulation(200);
            struct error error;
            struct line *line = line_of(s);
            ptrdiff_t needed[4];
            s->cost.steps = 8;
            assert_int_equal(widths_find(s, newton, 0, &error), STATUS_OK);
            for (int b = 0; b < 4; b++) needed[b] = line->ranges[b].reach;
            const ptrdiff_t most = line->reach;
            s->cost.steps = step;
            line->ranges[0].reach += 3, line->ranges[2].reach = 1;
            assert_int_equal(widths_find(s, newton, 0, &error), STATUS_OK);
            for (int b = 0; b < 4; b++)
                assert_int_equal(line->ranges[b].reach, needed[b] + (b == 0 && step % 8 ? 3 : 0));
            assert_int_equal(line->reach, step % 8 ? needed[0] + 3 : most);
            simulation_destroy(s);
        }
}

/* Newton's method sets both h and 1/h. At a predicted width, density is the sum at that width, and
 * the pressure is corrected along the adiabat for the prediction's error. */
TEST(state_after_sums)
{
    struct simulation *s = sample_simulation(200);
    const struct particles *a = &s->particles;
    struct error error;
    double h[200], rho[200];
    assert_int_equal(widths_find(s, true, 0, &error), STATUS_OK);
    assert_int_equal(widths_find(s, true, 0, &error), STATUS_OK);
    for (ptrdiff_t i = 0; i < 200; i++) {
        h[i] = a->h[i], rho[i] = a->rho[i];
        near_relative(a->h_inverse[i] * a->h[i], 1, 1e-8);
        near_relative(a->P[i], 0.4 * a->rho[i] * a->U[i] / a->m[i], 1e-14);
    }
    s->scheme.h_tolerance = 1e-2, s->dt = 1; /* Newton's method corrects no P, whatever its error */
    for (ptrdiff_t i = 0; i < 200; i++) a->h[i] *= 1.004;
    assert_int_equal(widths_find(s, true, 0, &error), STATUS_OK);
    for (ptrdiff_t i = 0; i < 200; i++)
        near_relative(a->P[i], 0.4 * a->rho[i] * a->U[i] / a->m[i], 1e-14);
    const double follow = s->scheme.integrator->follow;
    assert_true(follow == 1.5);
    for (int off = 0; off < 2; off++) {
        for (ptrdiff_t i = 0; i < 200; i++)
            a->h_inverse_found[i] = a->h_inverse_old[i] = (off ? 0.99 : 1) / h[i];
        assert_int_equal(widths_find(s, false, 0, &error), STATUS_OK);
        for (ptrdiff_t i = 0; i < 200; i++) {
            const double missed = a->h[i] * a->h_inverse[i] - 1;
            near_relative(a->rho[i], rho[i], off ? 0.01 : 1e-8);
            near_relative(a->P[i],
                          0.4 * a->rho[i] * a->U[i] / a->m[i] * (1 - follow * 0.4 * missed), 1e-14);
            near_relative(a->h_inverse[i], (off ? 0.99 : 1) / h[i], 1e-14);
        }
    }
    simulation_destroy(s);
}

/* If kernels are wider than the box there are enough ghosts, and ranges with final results are not
 * computed again; the message about a predicted width that is too large names its particle. */
TEST(ghosts_suffice_for_wide_kernels)
{
    struct simulation *s = sample_simulation(20);
    struct error error;
    char said[120];
    const uint64_t passes = line_of(s)->density_passes;
    for (ptrdiff_t i = 0; i < 20; i++) s->particles.h_inverse_found[i] = 1 / 0.2;
    s->particles.h_inverse_found[3] = s->particles.h_inverse_old[3] = 1 / 2.02;
    assert_int_equal(widths_find(s, false, 0, &error), STATUS_OK);
    assert_int_equal(line_of(s)->density_passes, passes + 1);
    assert_in_range(line_of(s)->reach, 40, 45);
    assert_int_equal(range_of(s, 3)->done, passes + 1);
    simulation_destroy(s);
    /* ghosts double until there are more than 64 + (2 eta + 2) n; the message names the first of
     * the widest particles */
    static const struct {
        double eta;
        ptrdiff_t at, also, filled;
    } rows[] = {{1.5, 3, 3, 256}, {0.6, 0, 19, 256}, {0.6 - 2.5e-7, 19, 19, 128}, {0.6, 1, 6, 256}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        s = sample_simulation(20);
        const struct particles *a = &s->particles;
        const ptrdiff_t at = rows[k].at, also = rows[k].also;
        s->scheme.eta = rows[k].eta;
        line_of(s)->ghosts_filled = 8, line_of(s)->reach = 1;
        for (ptrdiff_t i = 0; i < 20; i++)
            a->h_inverse_found[i] = a->h_inverse_old[i] = i == at || i == also ? 1e-9 : 1;
        assert_int_equal(widths_find(s, false, 0, &error), STATUS_BROKE_DOWN);
        snprintf(said, sizeof said, "smoothing length of particle %zu at x = %.9g is 1e+09",
                 a->id[at], a->x[0][at]);
        assert_non_null(strstr(error.message, said));
        assert_int_equal(line_of(s)->ghosts_filled, rows[k].filled);
        simulation_destroy(s);
    }
}

/* The number of ghosts is at least 8, the reach + 2 and the number before; it doubles while it is
 * too small for the widths. */
TEST(ghosts_are_kept_filled)
{
    static const struct {
        ptrdiff_t filled, reach, then;
    } rows[] = {{0, 1, 8}, {7, 1, 8}, {8, 1, 8}, {9, 1, 9}, {9, 7, 9}, {9, 8, 10}, {0, 20, 22}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct simulation *s = sample_simulation(200);
        struct error error;
        struct line *line = line_of(s);
        line->ghosts_filled = rows[k].filled, line->reach = rows[k].reach;
        s->particles.P[-1] = 77;
        assert_int_equal(widths_find(s, true, 0.25, &error), STATUS_OK);
        assert_int_equal(line->ghosts_filled, rows[k].then);
        assert_true(line->predict_ratio == 0.25 && s->particles.P[-1] == s->particles.P[199]);
        for (ptrdiff_t i = 0; i < 200; i++) s->particles.h_inverse_found[i] = 1. / 0.06;
        for (ptrdiff_t i = 0; i < 200; i++) s->particles.h_inverse_old[i] = 1. / 0.06;
        assert_int_equal(widths_find(s, false, 0, &error), STATUS_OK);
        assert_in_range(line->reach, 11, 13);
        const ptrdiff_t from = rows[k].then;
        assert_int_equal(line->ghosts_filled, from > 13 ? from : 2 * from);
        simulation_destroy(s);
    }
}

/* --- capacity --------------------------------------------------------------------------------- */

/* There is capacity for eight times the reach plus 8 ghosts; ghosts are filled again when their
 * arrays move. */
TEST(capacity_for_eight_times_the_reach)
{
    for (ptrdiff_t reach = 5; reach < 12; reach++) {
        struct simulation *s = sample_simulation(100);
        struct error error;
        struct line *line = line_of(s);
        assert_true(s->particles.ghosts == 64 && line->reach < 5);
        const ptrdiff_t filled = line->ghosts_filled;
        line->reach = reach;
        s->particles.x[0][-reach] = s->particles.P[-reach] = 77;
        assert_int_equal(line_sums.reserve(s, &error), STATUS_OK);
        const bool grown = 8 * reach + 8 > 64;
        assert_int_equal(s->particles.ghosts, grown ? 8 * reach + 8 : 64);
        assert_int_equal(line->ghosts_filled, grown ? reach + 2 : filled);
        const struct particles *a = &s->particles;
        for (ptrdiff_t k = 1; grown && k <= reach + 1; k++) {
            near_relative(a->x[0][-k], a->x[0][100 - k] - 1, 1e-14);
            assert_true(a->m[-k] == a->m[100 - k] && a->m[99 + k] == a->m[k - 1]);
            assert_true(a->P[-k] == a->P[100 - k] && a->P[99 + k] == a->P[k - 1]);
        }
        if (!grown) assert_true(a->x[0][-reach] == 77 && a->P[-reach] == 77);
        assert_true(line->scratch_size >= loop_force_scratch(8 * reach));
        simulation_destroy(s);
    }
}

/* --- the passes over pairs -------------------------------------------------------------------- */

static struct {
    ptrdiff_t first, len, D, thread;
    const double *scratch;
} asked[RANGES_MOST];

static int this_thread(void)
{
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

static double asked_force(const struct loops *loops, const struct particles *particles,
                          ptrdiff_t first, int len, ptrdiff_t D, double *scratch)
{
    (void)loops, (void)particles;
    scratch[loop_force_scratch(D) - 1] = 1;
    asked[first / BATCH_MAX].first = first, asked[first / BATCH_MAX].len = len;
    asked[first / BATCH_MAX].D = D, asked[first / BATCH_MAX].scratch = scratch;
    asked[first / BATCH_MAX].thread = this_thread();
    return first / BATCH_MAX == 5 ? 9 : 1;
}

static void asked_matrix(const struct kernel *kernel, const struct particles *particles,
                         ptrdiff_t first, int len, ptrdiff_t D)
{
    (void)particles;
    assert_non_null(kernel->w);
    asked[first / BATCH_MAX].first = first, asked[first / BATCH_MAX].len = len;
    asked[first / BATCH_MAX].D = D;
}

/* Forces of each range use its own reach and its thread's work arrays; pairs are counted twice in
 * the sums and once in the forces. */
TEST(forces_of_every_range)
{
    for (int way = 0; way < 8; way++) {
        struct simulation *s = sample_simulation(34 * BATCH_MAX + 5);
        struct line *line = line_of(s);
        struct error error;
        uint64_t pairs = 0;
        double rate = 0;
        s->team.most = s->team.size = way & 1 ? 2 : 1;
        s->plan.alpha = way & 4, s->scheme.alpha_max = 2;
        line->scratch_size = 0; /* too small for two threads */
        line->loops.force = asked_force;
        s->scheme.viscosity = VISCOSITY_TIME_DEPENDENT;
        line->loops.matrix = way & 2 ? asked_matrix : NULL;
        line->ranges[3].reach = line->reach += 2;
        for (ptrdiff_t i = 0; i < s->particles.n; i++)
            s->particles.dalpha[i] = 77, s->particles.div_v[i] = -1;
        s->cost.pair_interactions = 1000;
        assert_int_equal(forces_sum(s, &rate, &error), STATUS_OK);
#ifdef __GLIBC__
        assert_true(malloc_usable_size(line->scratch) >=
                    line->scratch_size * (size_t)s->team.most * sizeof(double));
#endif
        assert_true(rate == 9 && line->scratch_size >= loop_force_scratch(line->reach));
        for (ptrdiff_t b = 0; b < line->range_count; b++) {
            const struct range *range = &line->ranges[b];
            assert_true(asked[b].first == range->first && asked[b].len == range->len);
            assert_true(asked[b].D == range->force_reach);
            assert_int_equal(range->force_reach, reach_of_pairs(s, range));
            assert_true(asked[b].scratch ==
                        line->scratch + (ptrdiff_t)line->scratch_size * asked[b].thread);
            pairs +=
                (uint64_t)(range->len * ((way & 2 ? 4 : 2) * range->reach + range->force_reach));
        }
        assert_int_equal(s->cost.pair_interactions, 1000 + pairs);
        for (ptrdiff_t i = 0; i < s->particles.n; i++)
            assert_true((s->particles.dalpha[i] != 77) == (s->plan.alpha));
        simulation_destroy(s);
    }
}

/* Images of matrix results are filled up to the largest reach plus one. */
TEST(matrices_of_every_range)
{
    for (int slope = 0; slope < 2; slope++) {
        struct simulation *s = sample_simulation(200);
        struct line *line = line_of(s);
        const struct particles *a = &s->particles;
        line->loops.matrix = asked_matrix;
        s->plan.slope = slope;
        line->ranges[1].reach = 5, line->reach = 7;
        for (ptrdiff_t i = -20; i < 220; i++)
            a->g[i] = a->dv[i] = i < 0 || i >= 200 ? -77 : (double)i + 1;
        forces_matrix(s);
        for (ptrdiff_t b = 0; b < line->range_count; b++)
            assert_true(asked[b].first == line->ranges[b].first &&
                        asked[b].len == line->ranges[b].len && asked[b].D == line->ranges[b].reach);
        for (ptrdiff_t k = 1; k <= 20; k++) {
            assert_true(a->g[-k] == (k <= 8 ? a->g[200 - k] : -77));
            assert_true(a->g[199 + k] == (k <= 8 ? a->g[k - 1] : -77));
            assert_true(a->dv[-k] == (slope && k <= 8 ? a->dv[200 - k] : -77));
            assert_true(a->dv[199 + k] == (slope && k <= 8 ? a->dv[k - 1] : -77));
        }
        simulation_destroy(s);
    }
}
