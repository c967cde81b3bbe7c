/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs of the default schemes with and without skips, on random blasts, tubes and pulses in gas at
 * rest or in motion as a whole, in 1D, 2D and 3D: the same figures, momentum and energy kept, and
 * something skipped each time. Times are short: no scheme has amplified anything yet. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "near.h"
#include "settings.h"
#include "simulation.h"

enum { MOST = 5000, FIELDS_SEEN = 9 };
enum kind { BLAST, TUBE, PULSE, KINDS };

static uint64_t drawn = 2385;

static double draw(double low, double high)
{
    drawn = drawn * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * ldexp((double)((drawn ^ drawn >> 29) >> 11), -53);
}

/* Of the scene drawn last: how far the hot gas reaches from its middle, in units of the box. */
static double width;
static double x[3][MOST], v[3][MOST], m[MOST], u[MOST];

/* What is compared of a run, by id, and what it keeps. */
struct end {
    double fields[FIELDS_SEEN][MOST];
    struct conservation sums;
    struct simulation_cost cost;
};
static struct end plain, skipping;

/* A lattice in a periodic box of `side` spacings across and `longer` along x, with hot gas in the
 * middle: its u is `hot` times that of the rest, or there is a smooth bump of a tenth. */
static struct scene draw_scene(int dim, enum kind kind, double hot, bool boosted)
{
    static const size_t sides[] = {1, 12, 8}, lengths[] = {400, 144, 60};
    const size_t side = sides[dim - 1], longer = lengths[dim - 1];
    const double spacing = 1 / (double)longer, middle = draw(0, 1);
    struct scene scene = {.dim = dim, .gamma = draw(1.2, 1.8), .m = m, .u = u, .threads = 1};
    double boost[3];
    scene.n = longer;
    for (int k = 0; k < dim; k++) {
        scene.hi[k] = k == 0 ? 1 : (double)side * spacing;
        scene.n *= k == 0 ? 1 : side;
        scene.x[k] = x[k], scene.v[k] = v[k];
        boost[k] = boosted ? draw(-2, 2) : 0;
    }
    assert_true(scene.n <= MOST);
    width = (dim == 3 ? draw(2, 3) : draw(3, 6)) * spacing;
    for (size_t i = 0; i < scene.n; i++) {
        size_t at = i;
        double r = 0;
        for (int k = 0; k < dim; at /= k == 0 ? longer : side, k++) {
            x[k][i] = ((double)(at % (k == 0 ? longer : side)) + 0.5) * spacing;
            v[k][i] = boost[k];
            const double d = x[k][i] - middle * scene.hi[k];
            const double apart = d - scene.hi[k] * round(d / scene.hi[k]);
            if (k == 0 || kind == BLAST) r = hypot(r, apart);
        }
        m[i] = pow(spacing, dim), u[i] = 1;
        if (kind == PULSE)
            u[i] += r < width ? 0.1 * pow(cos(0.5 * M_PI * r / width), 4) : 0;
        else if (r < width)
            u[i] = hot;
    }
    const double fastest = sqrt(scene.gamma * (scene.gamma - 1) * (kind == PULSE ? 1 : hot));
    scene.t_end = (dim == 3 ? 2 : 4) * spacing / fastest;
    return scene;
}

static void run(struct scene *scene, bool skip, struct end *end)
{
    struct simulation *simulation = NULL;
    struct snapshot s;
    struct error error;
    scene->skip = skip;
    if (simulation_create(scene, &simulation, &error) ||
        simulation_run(simulation, scene->t_end, NULL, NULL, &error))
        fail_msg("%s", error.message);
    simulation_snapshot(simulation, &s);
    simulation_conservation(simulation, &end->sums);
    simulation_cost(simulation, &end->cost);
    memset(end->fields, 0, sizeof end->fields);
    const double *const fields[FIELDS_SEEN] = {s.x[0], s.x[1], s.x[2], s.v[0], s.v[1],
                                               s.v[2], s.rho,  s.u,    s.P};
    for (int f = 0; f < FIELDS_SEEN; f++)
        for (size_t i = 0; fields[f] && i < s.n; i++) end->fields[f][s.id[i]] = fields[f][i];
    simulation_destroy(simulation);
}

/* Mean difference over the largest value, which of velocities is at least the sound's. */
static double difference(const struct scene *scene, int field)
{
    double sum = 0, largest = 0;
    if (field >= 3 && field < 6) largest = plain.sums.sound_scale / plain.sums.mass;
    for (size_t i = 0; i < scene->n; i++) {
        double d = fabs(plain.fields[field][i] - skipping.fields[field][i]);
        if (field < scene->dim) d = fmin(d, fabs(scene->hi[field] - d));
        sum += d;
        largest = fmax(largest, fabs(plain.fields[field][i]));
    }
    return sum == 0 ? 0 : sum / ((double)scene->n * largest);
}

static void compare(struct scene *scene)
{
    run(scene, false, &plain);
    run(scene, true, &skipping);
    assert_int_equal(plain.cost.skipped_particle_updates, 0);
    const double updates = (double)(skipping.cost.steps * scene->n);
    near_inside((double)skipping.cost.skipped_particle_updates / updates, 0.2, 1);
    double moved = 0;
    for (size_t i = 0; i < scene->n; i++) moved = fmax(moved, fabs(plain.fields[6][i] - 1));
    near_inside(moved, 1e-3, 100);
    for (int f = 0; f < FIELDS_SEEN; f++) near_below(difference(scene, f), 1e-10);
    double start[3] = {0};
    for (size_t i = 0; i < scene->n; i++)
        for (int k = 0; k < scene->dim; k++) start[k] += m[i] * v[k][i];
    const double scale = skipping.sums.sound_scale + skipping.sums.momentum_scale;
    for (int k = 0; k < scene->dim; k++)
        near_below(fabs(skipping.sums.momentum[k] - start[k]) / scale, 1e-12);
    near_relative(skipping.sums.energy, plain.sums.energy, 1e-12);
}

/* A pulse leaves gas in peace that is three smoothing lengths ahead of it, mean over time. */
static void skip_enough_of_pulse(const struct scene *scene)
{
    const double h = scene->scheme.eta * pow(m[0], 1. / scene->dim);
    const double sound = sqrt(scene->gamma * (scene->gamma - 1));
    const double possible = 1 - 2 * (width + 3 * h + 0.5 * sound * scene->t_end);
    const double updates = (double)(skipping.cost.steps * scene->n);
    near_inside(possible, 0.5, 1);
    near_inside((double)skipping.cost.skipped_particle_updates / updates, 0.8 * possible, 1);
}

static void test_same_figures(void **state)
{
    static const int draws[] = {24, 6, 4};
    (void)state;
    for (int dim = 1; dim <= 3; dim++) {
        struct settings settings;
        struct scheme scheme;
        struct error error;
        settings_init(&settings);
        if (settings_scheme(&settings, dim, &scheme, &error)) fail_msg("%s", error.message);
        if (dim == 3) scheme.eta = 2.4; /* a third of the neighbours */
        for (int k = 0; k < draws[dim - 1]; k++) {
            const double hot = pow(10, dim == 1 ? draw(0.5, 4) : draw(0.5, 6));
            struct scene scene =
                draw_scene(dim, (enum kind)(k % KINDS), hot, (k + (dim == 3)) / KINDS % 2);
            scene.scheme = scheme;
            compare(&scene);
            if (k % KINDS == PULSE) skip_enough_of_pulse(&scene);
        }
    }
}

/* Gas that moves as one sleeps like gas at rest. */
static void test_boosted(void **state)
{
    (void)state;
    for (int dim = 1; dim <= 3; dim++) {
        struct settings settings;
        struct error error;
        struct scene scene = draw_scene(dim, TUBE, 10, true);
        settings_init(&settings);
        if (settings_scheme(&settings, dim, &scene.scheme, &error)) fail_msg("%s", error.message);
        if (dim == 3) scene.scheme.eta = 2.4;
        run(&scene, true, &plain);
        memset(v, 0, sizeof v);
        run(&scene, true, &skipping);
        assert_true(skipping.cost.skipped_particle_updates > 0);
        near_relative((double)plain.cost.skipped_particle_updates,
                      (double)skipping.cost.skipped_particle_updates, 0.02);
    }
}

/* Cold gas whose halves stream apart feels no force, but its density changes where they part: it is
 * awake there, with the same figures. */
static void test_cold_streams(void **state)
{
    struct settings settings;
    struct error error;
    struct scene scene = draw_scene(1, TUBE, 1, true);
    (void)state;
    settings_init(&settings);
    if (settings_scheme(&settings, 1, &scene.scheme, &error)) fail_msg("%s", error.message);
    const double boost = v[0][0];
    for (size_t i = 0; i < scene.n; i++) {
        u[i] = 1e-12;
        v[0][i] = boost + (x[0][i] < 0.3 ? -1 : x[0][i] < 0.6 ? 1 : -1);
    }
    scene.t_end = 2e-3;
    compare(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_same_figures),
                                       cmocka_unit_test(test_boosted),
                                       cmocka_unit_test(test_cold_streams)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
