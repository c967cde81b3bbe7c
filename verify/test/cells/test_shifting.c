/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests shifting=fluxes and closed in 2D and 3D: mass, momentum and total energy are conserved to
 * round-off, uniform fields stay uniform, particles spread, a restored run continues to the last
 * bit, and schemes that exclude shifting are refused. The check clouds/rates compares the rates
 * with the oracle's. */
#include "test.h"

#include "byte_buffer.h"
#include "draw.h"
#include "keyed.h"
#include "sample_lattice.h"
#include "sample_simulation.h"
#include "solver.h"

static const char *member = "fluxes";

/* The default scheme with shifting, and one more key. */
static enum status scheme_with(int dim, const char *key, struct scheme *scheme, struct error *error)
{
    static char words[4][40] = {"", "kernel=wendland_c2", "eta=2.6"};
    char *const list[] = {words[0], words[1], words[2], words[3]};
    struct settings settings;
    settings_init(&settings);
    snprintf(words[0], sizeof words[0], "shifting=%s", member);
    snprintf(words[3], sizeof words[3], "%s", key ? key : "alpha_u=0.4");
    const enum status status = settings_apply(&settings, 4, list, error);
    return status ? status : settings_scheme(&settings, dim, scheme, error);
}

/* A lattice of side^dim particles, each displaced by up to `jitter` spacings; mass, velocity and
 * specific energy differ from particle to particle in proportion to `spread`. */
static struct setup setup_of(int dim, size_t side, double jitter, double spread)
{
    struct scheme scheme;
    struct error error = {0};
    if (scheme_with(dim, NULL, &scheme, &error)) fail_msg("%s", error.message);
    const struct setup setup = lattice_of(dim, side, 0, &scheme);
    for (size_t i = 0; i < setup.n; i++) {
        for (int a = 0; a < dim; a++) {
            x[a][i] += draw(-jitter, jitter) / (double)side;
            v[a][i] = 0.3 * a + spread * draw(-1, 1);
        }
        m[i] *= 1 + spread * draw(-1, 1);
        u[i] = 1.9 * (1 + spread * draw(-1, 1));
    }
    return setup;
}

TEST(keeps_mass_momentum_and_energy)
{
    for (uint64_t k = 0; k < 8; k++) {
        const int dim = k % 2 ? 3 : 2;
        draw_state = 41 + k;
        member = k % 4 < 2 ? "closed" : "fluxes";
        struct setup setup = setup_of(dim, dim == 2 ? 26 : 9, 0.3, 0.2);
        const bool walled = k >= 6;
        if (walled) setup.boundary[1] = BOUNDARY_REFLECTING;
        struct simulation *simulation = simulation_of(&setup);
        struct conservation before, after;
        struct snapshot s;
        conservation_sums(simulation, &before);
        run_until(simulation, dim == 2 ? 0.15 : 0.1, NULL);
        conservation_sums(simulation, &after);
        simulation_snapshot(simulation, &s);
        near_relative(after.mass, before.mass, 1e-14);
        near_relative(after.energy, before.energy, 1e-13);
        for (int a = 0; a < dim; a++)
            if (!walled || a != 1)
                near_below(fabs(after.momentum[a] - before.momentum[a]),
                           1e-13 * after.momentum_scale);
        size_t changed = 0;
        for (size_t i = 0; i < s.n; i++) {
            changed += fabs(s.m[i] / m[s.id[i]] - 1) > 1e-4;
            near_relative(s.rho[i] * s.volume[i], s.m[i], 1e-13);
        }
        assert_true(changed > s.n / 2);
        simulation_destroy(simulation);
    }
}

/* Exchange alone conserves kinetic and internal energy, and keeps uniform velocity and specific
 * energy uniform. */
TEST(exchange_keeps_both_energies)
{
    for (int k = 0; k < 6; k++) {
        const int dim = k % 2 ? 3 : 2;
        const bool uniform = k >= 4;
        draw_state = 7 + (uint64_t)k;
        member = k % 4 < 2 ? "closed" : "fluxes";
        struct setup setup = setup_of(dim, dim == 2 ? 24 : 9, 0.3, 0.2);
        for (size_t i = 0; uniform && i < setup.n; i++) {
            u[i] = 1.9;
            for (int a = 0; a < dim; a++) v[a][i] = 0.3 * a - 0.7;
        }
        struct simulation *simulation = simulation_of(&setup);
        const struct particles *a = &simulation->particles;
        double mass = 0, energy = 0, kinetic = 0, scale = 0, energy_scale = 0;
        for (ptrdiff_t i = 0; i < a->n; i++) {
            double of_velocity = 0, change = 0;
            for (int b = 0; b < dim; b++) {
                of_velocity += 0.5 * a->v[b][i] * a->v[b][i];
                change += a->v[b][i] * a->dp_shift[b][i];
                if (uniform)
                    near_below(fabs(a->dp_shift[b][i] - a->v[b][i] * a->dm[i]),
                               1e-13 * (double)dim / (double)a->n);
            }
            if (uniform)
                near_below(fabs(a->de_shift[i] - (1.9 + of_velocity) * a->dm[i]),
                           1e-13 * (double)dim / (double)a->n);
            mass += a->dm[i];
            energy += a->de_shift[i];
            kinetic += change - of_velocity * a->dm[i];
            scale += fabs(a->dm[i]);
            energy_scale += fabs(a->de_shift[i]);
        }
        assert_true(scale > 1e-3);
        near_below(fabs(mass), 1e-13 * scale);
        near_below(fabs(energy), 1e-13 * energy_scale);
        near_below(fabs(kinetic), 1e-13 * energy_scale);
        simulation_destroy(simulation);
    }
}

/* Rates seen by a moving observer: dm is the same, dp and dE gain b dm and b . dp + b^2 dm/2. */
TEST(rates_are_galilean_invariant)
{
    static double of[5][N];
    static const double b[3] = {0.9, -1.7, 0.4};
    draw_state = 3;
    member = "closed";
    const struct setup setup = setup_of(3, 9, 0.3, 0.2);
    struct simulation *still = simulation_of(&setup);
    const struct particles *s = &still->particles;
    for (ptrdiff_t i = 0; i < s->n; i++) {
        const size_t id = s->id[i];
        for (int a = 0; a < 3; a++) of[a][id] = s->dp_shift[a][i];
        of[3][id] = s->de_shift[i], of[4][id] = s->dm[i];
    }
    for (size_t i = 0; i < setup.n; i++)
        for (int a = 0; a < 3; a++) v[a][i] += b[a];
    struct simulation *moving = simulation_of(&setup);
    const struct particles *t = &moving->particles;
    for (ptrdiff_t i = 0; i < t->n; i++) {
        const size_t id = t->id[i];
        double energy = of[3][id];
        near_below(fabs(t->dm[i] - of[4][id]), 1e-14);
        for (int a = 0; a < 3; a++) {
            energy += b[a] * of[a][id] + 0.5 * b[a] * b[a] * of[4][id];
            near_below(fabs(t->dp_shift[a][i] - of[a][id] - b[a] * of[4][id]), 1e-14);
        }
        near_below(fabs(t->de_shift[i] - energy), 1e-13);
    }
    simulation_destroy(still);
    simulation_destroy(moving);
}

/* The rms shift over the speed of sound. */
static double disorder(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    double sum = 0;
    for (ptrdiff_t i = 0; i < a->n; i++)
        for (int b = 0; b < a->dim; b++) sum += pow(a->shift[b][i] / a->c[i], 2);
    return sqrt(sum / (double)a->n);
}

/* In gas at rest nothing shifts on a lattice; off it particles spread, no faster than allowed. */
TEST(spreads_particles)
{
    for (int dim = 2; dim <= 3; dim++) {
        draw_state = 5;
        struct setup setup = setup_of(dim, dim == 2 ? 24 : 9, 0, 0);
        struct simulation *simulation = simulation_of(&setup);
        near_below(disorder(simulation), 1e-13);
        simulation_destroy(simulation);
        setup = setup_of(dim, dim == 2 ? 24 : 9, 0.3, 0);
        simulation = simulation_of(&setup);
        const double before = disorder(simulation);
        assert_true(before > 0.01 && before < 0.1 + 1e-9);
        run_until(simulation, 1, NULL);
        near_below(disorder(simulation), 0.25 * before);
        simulation_destroy(simulation);
    }
}

/* A second evaluation of the same state adds its shift to 0.7 of the first shift. */
TEST(remembers_its_last_shift)
{
    for (int dim = 2; dim <= 3; dim++) {
        draw_state = 31;
        const struct setup setup = setup_of(dim, dim == 2 ? 24 : 9, 0.02, 0);
        struct simulation *simulation = simulation_of(&setup);
        const struct particles *a = &simulation->particles;
        double first[3][N], most = 0;
        for (int b = 0; b < dim; b++) memcpy(first[b], a->shift[b], (size_t)a->n * sizeof(double));
        simulation->plan.sums->matrix(simulation);
        for (ptrdiff_t i = 0; i < a->n; i++)
            for (int b = 0; b < dim; b++) {
                near_below(fabs(a->shift[b][i] - 1.7 * first[b][i]), 1e-13 * a->c[i]);
                most = fmax(most, fabs(first[b][i]) / a->c[i]);
            }
        assert_true(most > 1e-3 && most < 0.1 / 1.7 / sqrt(dim)); /* none is at its limit */
        simulation_destroy(simulation);
    }
}

/* rms force per volume of gas at rest at a pressure of 1, that is, the gradient of a constant. Both
 * kinds of gas have the same volumes, which uniform pressure needs. */
static double of_constant(int dim, const char *kind)
{
    double sum = 0;
    member = kind;
    draw_state = 23;
    struct setup setup = setup_of(dim, dim == 2 ? 24 : 9, 0.02, 0);
    for (int once = 0; once < 2; once++) {
        struct simulation *simulation = simulation_of(&setup);
        const struct particles *a = &simulation->particles;
        for (ptrdiff_t i = 0; i < a->n; i++) {
            u[a->id[i]] = a->V[i] / (0.4 * a->m[i]);
            for (int b = 0; once && b < dim; b++) sum += pow(a->F[b][i] / a->V[i], 2);
        }
        simulation_destroy(simulation);
    }
    return sqrt(sum / (double)setup.n);
}

TEST(closed_gradient_of_a_constant_is_small)
{
    for (int dim = 2; dim <= 3; dim++) {
        const double ratio = of_constant(dim, "closed") / of_constant(dim, "fluxes");
        assert_true(ratio < 0.2);
    }
}

static struct byte_buffer bag;

static bool keep_the_third(void *context, double time, uint64_t steps)
{
    struct serialiser out = {.bytes = buffer_put, .context = &bag};
    (void)time;
    if (steps == 3) simulation_serialise(context, &out);
    assert_false(out.failed);
    return true;
}

TEST(restored_run_continues_to_the_last_bit)
{
    draw_state = 17;
    member = "closed";
    const struct setup setup = setup_of(2, 24, 0.3, 0.2);
    struct simulation *kept = simulation_of(&setup), *restored = simulation_of(&setup);
    struct serialiser back = {.bytes = buffer_take, .context = &bag, .back = true};
    run_until(kept, 0.12, keep_the_third);
    simulation_serialise(restored, &back);
    assert_true(!back.failed && restored->time > 0 && restored->time < 0.12);
    run_until(restored, 0.12, NULL);
    assert_true(same_state(kept, restored));
    simulation_destroy(kept);
    simulation_destroy(restored);
}

TEST(schemes_that_exclude_shifting)
{
    static const char *const keys[] = {"integrator=rk2",        "steps=local",
                                       "energy=internal",       "formulation=lagrangian",
                                       "volume_element=energy", "gradient=standard"};
    struct scheme scheme;
    struct error error = {0};
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        char start[80];
        member = k % 2 ? "closed" : "fluxes";
        snprintf(start, sizeof start, "shifting=%s and %s exclude each other: ", member, keys[k]);
        assert_int_equal(scheme_with(2, keys[k], &scheme, &error), STATUS_BAD_INPUT);
        if (strncmp(error.message, start, strlen(start)) != 0) fail_msg("%s", error.message);
    }
    for (int k = 0; k < 3; k++) {
        struct simulation *simulation = NULL;
        struct setup setup = setup_of(2, 8, 0, 0);
        if (k == 0) setup.boundary[1] = BOUNDARY_OPEN;
        if (k == 1) setup.boundary[0] = BOUNDARY_FIXED;
        if (k == 2) setup.gravity[1] = -0.5;
        assert_int_equal(simulation_create(&setup, &simulation, &error), STATUS_BAD_INPUT);
        if (!strstr(error.message, "shifting=closed and ")) fail_msg("%s", error.message);
        setup.scheme.shifting = SHIFTING_NONE;
        if (k == 2) { /* a scheme without shifting has no arrays for it */
            simulation = simulation_of(&setup);
            struct rates rates;
            simulation_rates(simulation, &rates);
            assert_true(!rates.shift.mass && !(simulation->particles.uses & USE_SHIFT));
            simulation_destroy(simulation);
        }
    }
}
