/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the loop over time steps with an integrator and sums that do nothing, so that every number
 * is known: what it calls, when a run stops or breaks down, what its clocks show, and what is saved
 * and restored. */
#include "test.h"

#include <time.h>

#include "byte_buffer.h"
#include "line/line.h"
#include "sample_simulation.h"
#include "solver.h"

/* --- steps ------------------------------------------------------------------------------------ */

static struct {
    int steps, sleep_updates, synchronised, signals, switched, widths, looked;
    double dt, switch_dt, time;
    bool fail, stop;
} seen;

static enum status still_step(struct simulation *simulation, double dt, struct error *error)
{
    (void)simulation;
    seen.steps++;
    seen.dt = dt;
    return seen.fail ? error_set(error, STATUS_BROKE_DOWN, "as was wished") : STATUS_OK;
}

static void still_synchronise(struct simulation *simulation)
{
    (void)simulation;
    seen.synchronised++;
}

static double still_signal(struct simulation *simulation)
{
    seen.signals++;
    for (ptrdiff_t i = 0; i < simulation->particles.n; i++)
        simulation->particles.signal[i] = i == 7 ? 1e6 : 1;
    /* beyond the particles */
    simulation->particles.signal[simulation->particles.n] = 1e30;
    return simulation->scheme.cfl / 0.125;
}

static void still_sleep(struct simulation *simulation)
{
    (void)simulation;
    seen.sleep_updates++;
}

static void still_switch(struct simulation *simulation, double dt)
{
    (void)simulation;
    seen.switched++;
    seen.switch_dt = dt;
}

static enum status still_widths(struct simulation *simulation, bool newton, double ratio,
                                struct error *error)
{
    (void)simulation, (void)ratio, (void)error;
    assert_true(newton);
    seen.widths++;
    return STATUS_OK;
}

static bool look(void *context, double time, uint64_t steps)
{
    struct simulation *simulation = context;
    seen.looked++;
    seen.time = time;
    assert_true(time == simulation->time && steps == simulation->cost.steps);
    return !seen.stop;
}

static const struct integrator still = {
    .step = still_step, .synchronise = still_synchronise, .ends_evaluated = true};
static struct sums still_sums;

/* A simulation whose particles do not move, with steps of 1/8 until t = 1. */
static struct simulation *standing(void)
{
    struct simulation *s = sample_simulation(40);
    still_sums = *s->plan.sums;
    still_sums.signal = still_signal;
    still_sums.apply_switch = still_switch;
    still_sums.widths = still_widths;
    still_sums.sleep_update = still_sleep;
    s->plan.sums = &still_sums;
    s->scheme.integrator = &still;
    s->dt = s->time_step = s->largest_dt = 0.125;
    s->dt_before = 0.0625;
    memset(&seen, 0, sizeof seen);
    return s;
}

TEST(what_a_run_calls)
{
    struct error error;
    for (int way = 0; way < 16; way++) {
        struct simulation *s = standing();
        struct integrator integrator = still;
        struct simulation_cost cost;
        s->plan.jump = way & 1, s->plan.signal_pass = way & 2;
        integrator.ends_evaluated = way & 4;
        if (way & 8) integrator.synchronise = NULL;
        s->scheme.integrator = &integrator;
        s->sleep.awake_count = 31;
        s->team.most = s->team.size = way & 1 ? 2 : 1;
        s->dt = 0.0625, s->largest_dt = 0;
        s->wall_start -= 1000, s->cpu_start -= 2000;
        assert_int_equal(simulation_run(s, 1, way & 8 ? NULL : look, s, &error), STATUS_OK);
        assert_true(s->time == 1 && s->dt == 0.125 && s->dt_before == 0.125 && seen.dt == 0.125);
        assert_true(s->largest_dt == 0.125);
        assert_int_equal(seen.steps, 8);
        assert_int_equal(seen.sleep_updates, 8);
        assert_true(s->team.most == 1 ? s->team.begun == 0 : s->team.begun > 0);
        assert_int_equal(seen.switched, way & 1 ? 8 : 0);
        assert_true(seen.switch_dt == (way & 1 ? 0.125 : 0));
        assert_int_equal(seen.signals, way & 2 ? 7 : 0);
        assert_int_equal(seen.widths, way & 4 ? 0 : 1);
        assert_int_equal(seen.synchronised, way & 8 ? 0 : 1);
        assert_int_equal(seen.looked, way & 8 ? 0 : 8);
        simulation_cost(s, &cost);
        assert_true(cost.steps == 8 && cost.particle_updates == 8 * 31);
        assert_int_equal(cost.skipped_particle_updates, 8 * 9);
        near_inside(cost.wall_s, 1000, 1100);
        near_inside(cost.cpu_s, 2000, 2100);
        simulation_destroy(s);
    }
}

static enum status slow_step(struct simulation *simulation, double dt, struct error *error)
{
    (void)simulation, (void)dt, (void)error;
    nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
    return STATUS_OK;
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + (double)time.tv_nsec / 1e9;
}

/* Eight steps take two milliseconds each by this clock; fractions of a second count. */
TEST(clocks_show_seconds)
{
    const struct integrator slow = {.step = slow_step, .ends_evaluated = true};
    const double before = now();
    struct simulation *s = standing();
    struct error error;
    s->scheme.integrator = &slow;
    assert_int_equal(simulation_run(s, 1, NULL, NULL, &error), STATUS_OK);
    near_inside(s->cost.wall_s, 0.016, now() - before);
    simulation_destroy(s);
}

/* A run that is stopped, or whose step fails, is synchronised and goes no further. */
TEST(a_run_that_stops)
{
    struct error error;
    for (int fail = 0; fail < 2; fail++) {
        struct simulation *s = standing();
        struct integrator integrator = still;
        integrator.ends_evaluated = false;
        s->scheme.integrator = &integrator;
        seen.fail = fail, seen.stop = !fail;
        s->team.begun = 5;
        assert_int_equal(simulation_run(s, 1, look, s, &error),
                         fail ? STATUS_BROKE_DOWN : STATUS_OK);
        assert_true(s->team.begun == 0); /* team measures no time while the run is stopped */
        assert_true(s->time == (fail ? 0 : 0.125) && s->dt_before == 0.125 && s->dt == 0.125);
        assert_int_equal(seen.steps, 1);
        assert_int_equal(seen.looked, !fail);
        assert_int_equal(seen.synchronised, 1);
        assert_int_equal(seen.widths, !fail);
        assert_int_equal(s->cost.steps, !fail);
        simulation_destroy(s);
    }
}

/* --- breaking down ---------------------------------------------------------------------------- */

/* A step below 1e-9 of the longest one is too short, and so is one that does not change the time,
 * except for the last step. */
TEST(steps_that_collapse)
{
    static const struct {
        double time, dt, longest, end;
        bool broken;
    } rows[] = {
        {0, 0.125, 1.2499e8, 1, false},
        {0, 0.125, 1.2501e8, 1, true},
        {0, 0.125, 1.25e8, 1, true},
        {0, 0.125, 1.2501e8, 0.125, false},
        {0x1p53, 0.125, 1, 0x1.8p53, true},
        {0x1p40, 0.125, 1, 0x1p40 + 1, false},
        {0, NAN, 1, 1, true},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct simulation *s = standing();
        struct error error = {0};
        char said[200];
        s->time = rows[k].time, s->time_step = rows[k].dt, s->largest_dt = rows[k].longest;
        s->particles.h[7] = 2 * s->particles.h[6];
        for (ptrdiff_t i = 0; i < s->particles.n; i++) s->particles.signal[i] = i == 3 ? 1e9 : 1;
        const enum status status = simulation_run(s, rows[k].end, NULL, NULL, &error);
        assert_int_equal(status, rows[k].broken ? STATUS_BROKE_DOWN : STATUS_OK);
        assert_int_equal(seen.signals, rows[k].broken);
        assert_true(rows[k].broken ? seen.steps == 0 : seen.steps > 0);
        if (rows[k].broken) {
            snprintf(said, sizeof said,
                     "broke down at t = %.9g: collapsed time step of particle %zu at x = %.9g is "
                     "%.9g",
                     rows[k].time, s->particles.id[7], s->particles.x[0][7], rows[k].dt);
            assert_string_equal(error.message, said);
        }
        simulation_destroy(s);
    }
}

/* The particle that limits a step has the smallest h/signal. */
TEST(particle_that_limits_the_step)
{
    for (int last = 0; last < 40; last++) {
        struct simulation *s = standing();
        struct error error;
        char name[40];
        s->largest_dt = 1e12;
        for (ptrdiff_t i = 0; i < 40; i++) s->particles.h[i] = 1 + (double)i / 64;
        s->particles.h[last] = last == 7 ? 1e5 : 1e-7;
        if (last < 39 && last != 7 && last != 6)
            s->particles.h[last + 1] = 1e-7; /* not the first */
        assert_int_equal(simulation_run(s, 1, NULL, NULL, &error), STATUS_BROKE_DOWN);
        snprintf(name, sizeof name, "particle %zu ", s->particles.id[last]);
        assert_non_null(strstr(error.message, name));
        simulation_destroy(s);
    }
}

/* Too much work: more than 1e5 + 100 n pairs per particle for each of the longest steps to the
 * end. */
TEST(too_much_work)
{
    for (int beyond = 0; beyond < 2; beyond++) {
        struct simulation *s = standing();
        struct error error;
        const uint64_t most = (100000 + 100 * 40) * 40 * (uint64_t)(1 + 1 / 0.125);
        s->cost.pair_interactions = most + (uint64_t)beyond;
        assert_int_equal(simulation_run(s, 1, NULL, NULL, &error),
                         beyond ? STATUS_BROKE_DOWN : STATUS_OK);
        assert_int_equal(s->cost.steps, beyond ? 1 : 8);
        if (beyond)
            assert_string_equal(error.message,
                                "broke down at t = 0.125: more than 104000 pair interactions a "
                                "particle for each of the longest steps (0.125) to t_end");
        simulation_destroy(s);
    }
}

/* A gain or loss of half of the energy is detected at the end, and after every 128 steps if the
 * scheme does not integrate the energy. */
TEST(runaway_energy)
{
    for (int total = 0; total < 2; total++)
        for (int k = 0; k < 4; k++) {
            struct simulation *s = standing();
            struct error error;
            struct conservation sums;
            s->scheme.energy = total ? ENERGY_TOTAL : ENERGY_INTERNAL;
            conservation_sums(s, &sums);
            s->start_energy = sums.energy / (k == 0   ? 1.5000001
                                             : k == 1 ? 1.4999999
                                             : k == 2 ? 0.5000001
                                                      : 0.4999999);
            const bool broken = k == 0 || k == 3;
            s->cost.steps = 125;
            assert_int_equal(simulation_run(s, 1, NULL, NULL, &error),
                             broken ? STATUS_BROKE_DOWN : STATUS_OK);
            assert_int_equal(s->cost.steps, broken && !total ? 128 : 133);
            if (broken) {
                char said[200];
                snprintf(said, sizeof said,
                         "broke down at t = %s: total energy is %.9g, at the start it was %.9g",
                         total ? "1" : "0.375", sums.energy, s->start_energy);
                assert_string_equal(error.message, said);
            }
            simulation_destroy(s);
        }
}

/* A gain or loss of exactly half is allowed. */
TEST(half_of_the_energy)
{
    for (int k = 0; k < 4; k++) {
        static const double left[] = {0.5, 1.5, 0.4999999999, 1.5000000001};
        struct simulation *s = standing();
        struct error error;
        for (ptrdiff_t i = 0; i < 40; i++) s->particles.e[i] = s->particles.p[0][i] = 0;
        s->particles.e[3] = left[k];
        s->start_energy = 1;
        assert_int_equal(simulation_run(s, 1, NULL, NULL, &error),
                         k < 2 ? STATUS_OK : STATUS_BROKE_DOWN);
        simulation_destroy(s);
    }
}

/* --- saved and restored ----------------------------------------------------------------------- */

/* The clocks of a restored simulation continue from those of the saved one. */
TEST(clocks_go_on)
{
    static struct byte_buffer bag;
    struct simulation *kept = sample_simulation(40), *restored = sample_simulation(40);
    struct serialiser out = {.bytes = buffer_put, .context = &bag},
                      back = {.bytes = buffer_take, .context = &bag, .back = true};
    run_until(kept, 0.02, NULL);
    kept->wall_start -= 1e6, kept->cpu_start -= 2e6;
    const double wall = kept->wall_start, cpu = kept->cpu_start;
    simulation_serialise(kept, &out);
    assert_false(out.failed);
    assert_true(kept->wall_start == wall && kept->cpu_start == cpu);
    near_inside(kept->cost.wall_s, 1e6, 1e6 + 100);
    near_inside(kept->cost.cpu_s, 2e6, 2e6 + 100);
    simulation_serialise(restored, &back);
    assert_false(back.failed);
    assert_int_equal(bag.read, bag.used);
    assert_true(restored->cost.wall_s == kept->cost.wall_s);
    run_until(kept, 0.04, NULL);
    run_until(restored, 0.04, NULL);
    assert_true(same_state(kept, restored));
    near_inside(restored->cost.wall_s, 1e6, 1e6 + 100);
    near_inside(restored->cost.cpu_s, 2e6, 2e6 + 100);
    assert_int_equal(restored->cost.steps, kept->cost.steps);
    assert_true(restored->largest_dt == kept->largest_dt && restored->dt == kept->dt &&
                restored->dt_before == kept->dt_before &&
                restored->start_energy == kept->start_energy);
    simulation_destroy(kept);
    simulation_destroy(restored);
    simulation_destroy(NULL);
}

/* Saved state of the integrator, the sums and inactive particles. */
TEST(all_state_is_restored)
{
    static struct byte_buffer bag;
    bag.used = bag.read = 0;
    struct simulation *kept = sample_simulation(40), *restored = sample_simulation(40);
    struct serialiser out = {.bytes = buffer_put, .context = &bag},
                      back = {.bytes = buffer_take, .context = &bag, .back = true};
    const size_t keeps = kept->scheme.integrator->keeps;
    assert_true(keeps > 0 && kept->sleep.span_count == 1);
    memset(kept->integrator_state, 0x3f, keeps);
    kept->sleep.spans[0] = (struct span){3, 5};
    kept->sleep.on = true, kept->sleep.rate = 0.75, kept->sleep.awake_count = 5;
    kept->sleep.at_rest = !restored->sleep.at_rest;
    line_of(kept)->density_passes = 77, line_of(kept)->predict_ratio = 0.375;
    line_of(kept)->ghosts_filled = 13, line_of(kept)->reach = 9, line_of(kept)->range_count = 2;
    for (ptrdiff_t b = 0; b < 2; b++)
        line_of(kept)->ranges[b] = (struct range){b, 5, 6, 7, true, 8, 9 + (uint64_t)b};
    for (ptrdiff_t g = 0; g < 5; g++)
        line_of(kept)->groups.awake[g] = g != 3, line_of(kept)->groups.rate[g] = (double)g;
    simulation_serialise(kept, &out);
    simulation_serialise(restored, &back);
    assert_false(out.failed || back.failed);
    assert_int_equal(bag.read, bag.used);
    assert_memory_equal(restored->integrator_state, kept->integrator_state, keeps);
    assert_true(restored->sleep.spans[0].first == 3 && restored->sleep.spans[0].len == 5);
    assert_true(restored->sleep.on && restored->sleep.rate == 0.75 &&
                restored->sleep.awake_count == 5 && restored->sleep.at_rest == kept->sleep.at_rest);
    const struct line *line = line_of(restored), *of = line_of(kept);
    assert_int_equal(line->density_passes, 77);
    assert_true(line->predict_ratio == 0.375 && line->ghosts_filled == 13 && line->reach == 9);
    assert_int_equal(line->range_count, 2);
    assert_memory_equal(line->ranges, of->ranges, 2 * sizeof *line->ranges);
    assert_int_equal(line->groups.count, 5);
    assert_memory_equal(line->groups.awake, of->groups.awake, 5);
    assert_memory_equal(line->groups.rate, of->groups.rate, 5 * sizeof(double));
    simulation_destroy(kept);
    simulation_destroy(restored);
}
