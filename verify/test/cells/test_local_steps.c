/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests steps=local: momentum and total energy are conserved, the order in time is 2, and bits
 * depend neither on threads nor on a resume. If all particles are on one level, steps are those of
 * steps=global. Neighbours are at most two levels apart. */
#include "test.h"

#include "byte_buffer.h"
#include "keyed.h"
#include "sample_lattice.h"
#include "sample_simulation.h"
#include "solver.h"

static uint64_t seed;

static double draw(double low, double high)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

/* The default scheme with these keys; in 3D with a narrow kernel, so that few particles may have
 * many levels. */
static struct scheme scheme_with(int dim, const char *keys)
{
    char words[200];
    snprintf(words, sizeof words, "%s%s", keys, dim == 3 ? " kernel=quadratic_spline eta=1.6" : "");
    return keyed_scheme(dim, words);
}

/* A lattice of side^dim particles in a periodic box, each displaced by up to `jitter` spacings,
 * with a hot ball in the middle: u rises by `heat`, within a spacing or (smooth) over the box. */
static struct setup setup_of(int dim, size_t side, double jitter, double heat, bool smooth,
                             const struct scheme *scheme)
{
    const struct setup setup = lattice_of(dim, side, 0, scheme);
    for (size_t i = 0; i < setup.n; i++) {
        double r2 = 0;
        for (int a = 0; a < dim; a++) {
            x[a][i] += draw(-jitter, jitter) / (double)side;
            v[a][i] = jitter * draw(-1, 1);
            r2 += (x[a][i] - 0.5) * (x[a][i] - 0.5);
        }
        m[i] *= 1 + jitter * draw(-1, 1);
        u[i] = smooth ? 1 + heat * exp(-r2 / 0.03) : sqrt(r2) < 0.15 ? 1 + heat : 1;
    }
    return setup;
}

/* Enforces blocks of local steps, which save too little work with so few particles. */
static struct simulation *blocks_of(const struct setup *setup)
{
    struct simulation *simulation = simulation_of(setup);
    simulation->steps.worth = 0.9;
    return simulation;
}

static const char *const schemes[] = {
    "steps=local",
    "steps=local alpha_u=0.5",
    "steps=local gradient=standard viscosity=constant kernel=cubic_spline",
    "steps=local gradient=blended viscosity=reconstructed balsara=on",
};
enum { SCHEMES = sizeof schemes / sizeof *schemes };

/* --- conservation ----------------------------------------------------------------------------- */

TEST(keeps_momentum_and_energy)
{
    static const double heat[SCHEMES] = {300, 1e4, 1e4, 300};
    uint64_t woken[2] = {0};
    for (size_t k = 0; k < 2 * SCHEMES; k++) {
        const int dim = k % 2 ? 3 : 2;
        seed = 31 + k;
        const struct scheme scheme = scheme_with(dim, schemes[k / 2]);
        const struct setup setup =
            setup_of(dim, dim == 2 ? 28 : 10, k / 2 % 2 ? 0.02 : 0.2, heat[k / 2], false, &scheme);
        struct simulation *simulation = blocks_of(&setup);
        struct conservation before, after;
        struct simulation_cost cost;
        conservation_sums(simulation, &before);
        run_until(simulation, 1 / sqrt(heat[k / 2]), NULL);
        conservation_sums(simulation, &after);
        simulation_cost(simulation, &cost);
        for (int a = 0; a < dim; a++)
            near_below(fabs(after.momentum[a] - before.momentum[a]), 1e-13 * after.momentum_scale);
        near_below(fabs(after.energy - before.energy), 1e-13 * before.energy);
        /* particles had different levels */
        assert_true(cost.skipped_particle_updates > cost.particle_updates / 10);
        assert_int_equal(cost.particle_updates + cost.skipped_particle_updates,
                         cost.steps * setup.n);
        woken[k % 2] += simulation->steps.woken;
        simulation_destroy(simulation);
    }
    assert_true(woken[0] > 0 && woken[1] > 0);
}

/* --- bits ------------------------------------------------------------------------------------- */

TEST(threads_do_not_matter)
{
    const struct scheme scheme = scheme_with(2, "steps=local");
    seed = 7;
    struct setup setup = setup_of(2, 32, 0.2, 300, false, &scheme);
    struct simulation *one = blocks_of(&setup);
    run_until(one, 0.016, NULL);
    for (int threads = 2; threads <= 3; threads++) {
        setup.threads = threads;
        struct simulation *more = blocks_of(&setup);
        run_until(more, 0.016, NULL);
        assert_true(same_state(one, more));
        simulation_destroy(more);
    }
    simulation_destroy(one);
}

TEST(one_level_is_global)
{
    for (size_t k = 0; k < SCHEMES; k++) {
        struct simulation *both[2];
        for (int local = 0; local < 2; local++) {
            char keys[200];
            snprintf(keys, sizeof keys, "%s%s", local ? "steps=local" : "steps=global",
                     strlen(schemes[k]) > 11 ? schemes[k] + 11 : "");
            const struct scheme scheme = scheme_with(2, keys);
            seed = 5;
            const struct setup setup = setup_of(2, 16, 0.02, 0, true, &scheme);
            both[local] = blocks_of(&setup);
            run_until(both[local], 0.2, NULL);
        }
        assert_int_equal(both[0]->cost.steps, both[1]->cost.steps);
        assert_true(both[0]->cost.steps > 4);
        assert_int_equal(both[1]->cost.skipped_particle_updates, 0);
        assert_true(same_state(both[0], both[1]));
        for (int local = 0; local < 2; local++) simulation_destroy(both[local]);
    }
}

static struct byte_buffer bag;
static int blocks;

static bool keep_the_fifth(void *context, double time, uint64_t steps)
{
    struct serialiser out = {.bytes = buffer_put, .context = &bag};
    (void)time, (void)steps;
    if (++blocks == 5) simulation_serialise(context, &out);
    assert_false(out.failed);
    return true;
}

TEST(restored_run_continues_to_the_last_bit)
{
    const struct scheme scheme = scheme_with(2, "steps=local alpha_u=0.5");
    seed = 11;
    const struct setup setup = setup_of(2, 24, 0.2, 300, false, &scheme);
    struct simulation *kept = blocks_of(&setup), *restored = blocks_of(&setup);
    struct serialiser back = {.bytes = buffer_take, .context = &bag, .back = true};
    run_until(kept, 0.06, keep_the_fifth);
    assert_true(blocks > 6);
    simulation_serialise(restored, &back);
    assert_true(!back.failed && restored->time > 0 && restored->steps.depth > 0);
    run_until(restored, 0.06, NULL);
    assert_true(same_state(kept, restored));
    simulation_destroy(kept);
    simulation_destroy(restored);
}

/* --- order in time ---------------------------------------------------------------------------- */

/* Root mean square difference of positions and velocities, by identity. */
static double difference(const struct simulation *a, const struct simulation *b)
{
    static double of[2][3][N];
    const struct simulation *const both[] = {a, b};
    double sum = 0;
    for (int s = 0; s < 2; s++) {
        const struct particles *p = &both[s]->particles;
        for (ptrdiff_t i = 0; i < p->n; i++)
            for (int k = 0; k < p->dim; k++)
                of[s][k][p->id[i]] = p->x[k][i] + p->p[k][i] * p->m_inverse[i];
    }
    for (ptrdiff_t i = 0; i < a->particles.n; i++)
        for (int k = 0; k < a->particles.dim; k++)
            sum += (of[0][k][i] - of[1][k][i]) * (of[0][k][i] - of[1][k][i]);
    return sqrt(sum / (double)a->particles.n);
}

/* A smooth hot spot, whose particles have time steps of three levels. */
static struct simulation *smooth_run(int dim, double cfl, enum time_steps steps)
{
    struct scheme scheme = scheme_with(dim, "steps=local");
    scheme.steps = steps;
    scheme.cfl = cfl;
    seed = 3;
    const struct setup setup = setup_of(dim, dim == 2 ? 28 : 9, 0, 100, true, &scheme);
    struct simulation *simulation = blocks_of(&setup);
    run_until(simulation, 0.06, NULL);
    return simulation;
}

TEST(second_order_in_time)
{
    struct simulation *exact = smooth_run(2, 0.01, STEPS_GLOBAL);
    double error[2];
    for (int k = 0; k < 2; k++) {
        struct simulation *run = smooth_run(2, k ? 0.08 : 0.16, STEPS_LOCAL);
        assert_true(run->cost.skipped_particle_updates > run->cost.particle_updates / 4);
        error[k] = difference(run, exact);
        simulation_destroy(run);
    }
    near_inside(log2(error[0] / error[1]), 1.6, 3);
    simulation_destroy(exact);
}

/* --- levels ----------------------------------------------------------------------------------- */

/* At every evaluation, neighbours of active particles differ by no more levels than allowed. */
static int too_coarse, looked;
static const struct sums *real;

static enum status look_at_levels(struct simulation *simulation, double *rate, struct error *error)
{
    const struct particles *a = &simulation->particles;
    const int level = simulation->steps.level;
    for (ptrdiff_t i = 0; level > STEPS_APART && i < a->n; i++)
        for (ptrdiff_t j = 0; a->level[i] == level && j < a->n; j++) {
            double r2 = 0;
            for (int k = 0; k < a->dim; k++) {
                const double d = a->x[k][i] - a->x[k][j], near = d - round(d);
                r2 += near * near;
            }
            const double reach = fmax(1 / a->h_inverse[i], 1 / a->h_inverse[j]);
            if (!(r2 < 0.999 * reach * reach)) continue;
            looked++;
            too_coarse += a->level[j] < level - STEPS_APART;
        }
    return real->forces(simulation, rate, error);
}

/* Cold gas beside blasts 10^4 times as hot becomes active before the blast arrives. */
TEST(levels_of_neighbours_differ_by_at_most_2)
{
    uint64_t woken = 0;
    for (int k = 0; k < 4; k++) {
        const int dim = k % 2 ? 3 : 2;
        const struct scheme scheme = scheme_with(dim, schemes[2]);
        seed = 17 + (uint64_t)k;
        const struct setup setup = setup_of(dim, dim == 2 ? 24 : 10, 0.2, 1e4, false, &scheme);
        struct simulation *simulation = blocks_of(&setup);
        real = simulation->plan.sums;
        struct sums looking = *real;
        looking.forces = look_at_levels;
        simulation->plan.sums = &looking;
        too_coarse = looked = 0;
        run_until(simulation, 8e-3, NULL);
        assert_true(looked > (dim == 2 ? 1000 : 0));
        woken += simulation->steps.woken;
        assert_int_equal(too_coarse, 0);
        simulation->plan.sums = real;
        simulation_destroy(simulation);
    }
    assert_true(woken > 0);
}

/* A pair that changes levels lacks the time between the ends of both levels' last contributions. */
TEST(pairs_that_change_levels_lose_nothing)
{
    enum { FINEST = 6 };
    struct simulation simulation = {.steps.clock = {.finest = FINEST, .end = 2 << FINEST}};
    struct steps_clock *clock = &simulation.steps.clock;
    long given[FINEST + 1] = {0};
    int unlike = 0;
    clock->tick = 0.25;
    for (clock->now = 1; clock->now < clock->end; clock->now++) {
        int level = 0;
        while (clock->now % (clock->end >> level) != clock->end >> level >> 1) level++;
        simulation.steps.level = level;
        if (level > 1) {
            double spans[STEPS_LEVELS];
            const int to = steps_woken_level(&simulation);
            const bool some = steps_uncovered(&simulation, spans);
            bool any = false;
            for (int l = 0; l < to; l++) {
                assert_true(spans[l] == 0.25 * (double)(given[to] - given[l]));
                any |= given[to] != given[l];
            }
            assert_int_equal(some, any);
            unlike += any;
        }
        given[level] = clock->now + (clock->end >> level >> 1);
    }
    assert_true(unlike > 10);
}

TEST(message_names_what_excludes_local_steps)
{
    static const char *const pairs[][2] = {
        {"integrator=leapfrog", "integrator=leapfrog"},
        {"h_method=newton", "h_method=newton"},
        {"formulation=lagrangian h_method=predicted", "formulation=lagrangian"},
        {"volume_element=energy viscosity=constant", "volume_element=energy"},
        {"viscosity=time_dependent", "viscosity=time_dependent"},
        {"viscosity=cullen_dehnen", "viscosity=cullen_dehnen"},
    };
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        struct scheme scheme = scheme_with(2, pairs[k][0]);
        struct error error = {0};
        char start[100];
        scheme.steps = STEPS_LOCAL;
        assert_int_equal(scheme_check(&scheme, 2, &error), STATUS_BAD_INPUT);
        snprintf(start, sizeof start, "steps=local and %s exclude each other: ", pairs[k][1]);
        assert_int_equal(strncmp(error.message, start, strlen(start)), 0);
    }
    struct scheme line = scheme_with(1, "steps=global");
    struct error error = {0};
    line.steps = STEPS_LOCAL;
    assert_int_equal(scheme_check(&line, 1, &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, "steps=local and dimension=1 exclude each other: it is for "
                                       "2 and 3 dimensions");
}
