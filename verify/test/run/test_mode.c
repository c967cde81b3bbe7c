/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests problems that start from a growing mode: the base state and the perturbation in the
 * problem's units, and measured amplitudes of made-up states against independent sums. */
#include "test.h"

#include <complex.h>

#include "mode.h"
#include "prepared.h"

/* Problems in boxes other than the unit box. */
static const char shear_keys[] = "kind=kelvin_helmholtz_mode|lo=-0.9 3|hi=1.1 5|waves=2|"
                                 "amplitude=0.001|gamma=1.6|boost=0.25 -0.5",
                  heavy_keys[] = "kind=rayleigh_taylor_mode|lo=0.5 -2|hi=2.5 2|waves=2|"
                                 "amplitude=0.001|gamma=1.4|gravity=0 -0.125";

static struct prepared made(const char *keys)
{
    struct settings settings;
    return prepared_of(&settings, 2, keys);
}

PROBLEM_OWN(mode_start)

/* The layer of a problem, in units in which the box has a height of 1. */
TEST(layers_are_those_of_the_keys)
{
    const struct prepared shear = made(shear_keys), heavy = made(heavy_keys);
    const struct mode_start *s = mode_start_of(&shear), *h = mode_start_of(&heavy);
    const struct layer *shear_layer = &s->mode.layer, *heavy_layer = &h->mode.layer;
    assert_true(shear_layer->width == 0.05 && shear_layer->rho == 1.5 &&
                shear_layer->rho_step == 0.5 && shear_layer->U == 0.5 && shear_layer->P == 2.5 &&
                shear_layer->g == 0);
    assert_true(heavy_layer->width == 0.05 && heavy_layer->rho == 1.5 &&
                heavy_layer->rho_step == 0.5 && heavy_layer->U == 0 && heavy_layer->P == 2.5 &&
                heavy_layer->wall == 0.5 && !heavy_layer->periodic);
    near_relative(s->mode.layer.k, 4 * M_PI, 1e-15);
    assert_true(s->mode.layer.gamma == 1.6 && s->mode.layer.periodic && s->length == 2);
    assert_true(s->origin[0] == -0.9 && s->origin[1] == 3.5);
    near_relative(s->amplitude, 0.0005, 1e-15); /* relative to the speed 1/2 */
    near_relative(h->mode.layer.k, 8 * M_PI, 1e-15);
    near_relative(h->mode.layer.g, 0.5, 1e-15);
    assert_true(h->origin[0] == 0.5 && h->origin[1] == 0 && h->length == 4);
    near_relative(h->amplitude, 0.001 * sqrt(2 * M_PI * 0.5 / (8 * M_PI)), 1e-15);
    for (int k = 0; k < 2; k++) { /* growth from t = 0 with the rate of the mode */
        const struct prepared *p = k ? &heavy : &shear;
        const double rate = cimag(mode_start_of(p)->mode.omega) / mode_start_of(p)->length;
        double times[2];
        assert_true(rate > 0.05);
        near_relative(mode_growing.rate(p), rate, 1e-15);
        near_relative(mode_amplitude.exact(p, 0.7), mode_start_of(p)->amplitude * exp(0.7 * rate),
                      1e-14);
        mode_growing.during(p, times);
        near_relative(exp(rate * times[0]), 2, 1e-14);
        /* displaced by a tenth of the layer's width */
        near_relative(mode_start_of(p)->amplitude * exp(rate * times[1]) *
                          mode_start_of(p)->mode.displacement,
                      0.1 * 0.05, 1e-13);
    }
}

TEST(samples_are_base_and_mode)
{
    for (int k = 0; k < 2; k++) {
        const struct prepared p = made(k ? heavy_keys : shear_keys);
        const struct mode_start *start = mode_start_of(&p);
        for (int i = 0; i < 40; i++) {
            const double x[3] = {p.domain.lo[0] + 0.0237 * i, p.domain.lo[1] + 0.0471 * i, 7};
            const double t = 0.05 * i, X = (x[0] - start->origin[0]) / start->length,
                         Y = (x[1] - start->origin[1]) / start->length;
            const struct layer_base base = layer_base(&start->mode.layer, Y);
            const struct layer_amplitude f = layer_mode_amplitude(&start->mode, Y);
            const double complex wave =
                start->amplitude *
                cexp(LAYER_I * (start->mode.layer.k * X - start->mode.omega * t / start->length));
            struct problem_state s;
            mode_sample(&p, x, t, &s);
            const double scale = start->amplitude * exp(mode_growing.rate(&p) * t);
            assert_true(fabs(s.rho - base.rho - creal(f.rho * wave)) <= 1e-9 * scale + 1e-15);
            assert_true(fabs(s.v[0] - base.U - creal(f.u * wave)) <= 1e-9 * scale + 1e-15);
            assert_true(fabs(s.v[1] - creal(f.v * wave)) <= 1e-9 * scale);
            assert_true(fabs(s.P - base.P - creal(f.p * wave)) <= 1e-9 * scale + 1e-15);
            near_relative(s.u, s.P / ((p.gamma - 1) * s.rho), 1e-14);
            assert_true(s.v[2] == 0);
        }
    }
}

enum { N = 700, BINS = 32 };

/* A state of arbitrary points with arbitrary volumes, whose velocity is the sum of the mode,
 * another flow and a boost. One of 32 parts of the height has no point. */
struct mode_state {
    double x[2][N + 1], v[2][N + 1], volume[N + 1]; /* one more after the last */
    struct snapshot snapshot;
};

static void make_state(struct mode_state *made, const struct prepared *p, double scatter)
{
    const struct mode_start *start = mode_start_of(p);
    /* on either side of the end of the layer's half; outside of the box and at its end */
    static const double set[] = {0.5 + 1e-8, 0.5 - 1e-8, -0.1, 1, 1.1};
    for (int i = 0; i <= N; i++) {
        const double part =
            i < (start->mode.layer.periodic ? 2 : 5) ? set[i] : fmod(0.7548776662 * i + 0.01, 1);
        made->x[0][i] =
            p->domain.lo[0] + fmod(0.6180339887 * i, 1) * (p->domain.hi[0] - p->domain.lo[0]);
        /* no point is in the 5th of the 32 parts */
        made->x[1][i] = p->domain.lo[1] + (part >= 4. / BINS && part < 5. / BINS ? 0.5 : part) *
                                              (p->domain.hi[1] - p->domain.lo[1]);
        made->volume[i] = 0.001 * (2 + sin(5 * i));
        const double X = (made->x[0][i] - start->origin[0]) / start->length,
                     Y = (made->x[1][i] - start->origin[1]) / start->length;
        const double complex f = layer_mode_amplitude(&start->mode, Y).v;
        made->v[0][i] = cos(i) + p->boost[0];
        made->v[1][i] = creal((0.3 - 0.2 * LAYER_I) * f * cexp(LAYER_I * start->mode.layer.k * X)) +
                        scatter * sin(12.9898 * i) + p->boost[1];
    }
    made->snapshot = (struct snapshot){.n = N,
                                       .x = {made->x[0], made->x[1]},
                                       .v = {made->v[0], made->v[1]},
                                       .volume = made->volume};
}

/* The four functionals from their definitions. */
static void measure(const struct prepared *p, const struct mode_state *made, double found[4])
{
    const struct mode_start *start = mode_start_of(p);
    double complex up[2] = {0}, measured[BINS] = {0}, mode[BINS] = {0};
    double ff = 0, vv = 0, volume[BINS] = {0};
    for (int i = 0; i < N; i++) {
        const double X = (made->x[0][i] - start->origin[0]) / start->length,
                     Y = (made->x[1][i] - start->origin[1]) / start->length;
        const double vy = made->v[1][i] - p->boost[1], V = made->volume[i];
        const double complex f = layer_mode_amplitude(&start->mode, Y).v,
                             back = cexp(-LAYER_I * start->mode.layer.k * X);
        /* the image of the layer begins at 1/2 */
        const bool image = start->mode.layer.periodic && Y > 0.25;
        const double part = (made->x[1][i] - p->domain.lo[1]) / (p->domain.hi[1] - p->domain.lo[1]);
        const int b = part < 0 ? 0 : part < 1 ? (int)(part * BINS) : BINS - 1;
        up[image] += V * vy * conj(f) * back;
        ff += V * creal(f * conj(f));
        vv += V * vy * vy;
        measured[b] += 2 * V * vy * back;
        mode[b] += V * f;
        volume[b] += V;
    }
    const double complex c = 2 * (up[0] + up[1]) / ff;
    const double square = creal(c * conj(c)), of_mode = square * ff / 2;
    double off = 0, whole = 0;
    for (int b = 0; b < BINS; b++) {
        if (volume[b] == 0) continue;
        off += pow(cabs(measured[b] - c * mode[b]), 2) / volume[b];
        whole += pow(cabs(c * mode[b]), 2) / volume[b];
    }
    found[0] = sqrt(square);
    found[1] = sqrt(off / whole);
    found[2] = sqrt(fabs(vv - of_mode) / of_mode);
    found[3] = cabs(2 * (up[0] - up[1]) / ff) / sqrt(square);
}

TEST(measured_as_defined)
{
    static const struct functional *const f[] = {&mode_amplitude, &mode_error, &mode_noise,
                                                 &mode_other_parity};
    static struct mode_state mode_state;
    for (int k = 0; k < 2; k++) {
        const struct prepared p = made(k ? heavy_keys : shear_keys);
        for (int scattered = 0; scattered < 2; scattered++) {
            double want[4];
            make_state(&mode_state, &p, 0.05 * scattered);
            measure(&p, &mode_state, want);
            near_relative(want[0], hypot(0.3, 0.2), 0.1); /* the mode's amplitude */
            assert_true(want[1] > 0.01 && want[2] > 0.01);
            for (int i = 0; i < 4; i++)
                near_relative(f[i]->measure(&p, &mode_state.snapshot), want[i], 1e-10);
            for (int i = 1; i < 4; i++) assert_true(f[i]->exact(&p, 0.5) == 0);
        }
    }
}

/* On a regular grid waves are orthogonal: if the velocity is the mode alone, the measured amplitude
 * is that of the mode, a wave of another length counts as noise only, and the mode has nothing of
 * the other parity. */
TEST(grid_knows_the_mode_alone)
{
    enum { SIDE = 64 };
    static double x[2][SIDE * SIDE], v[2][SIDE * SIDE], volume[SIDE * SIDE];
    struct prepared p = made(shear_keys);
    const struct mode_start *start = mode_start_of(&p);
    const struct snapshot s = {
        .n = SIDE * SIDE, .x = {x[0], x[1]}, .v = {v[0], v[1]}, .volume = volume};
    double squares = 0, noise = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double X = (i % SIDE + 0.5) / SIDE, Y = (i / SIDE + 0.5) / SIDE - 0.25;
        const double complex f = layer_mode_amplitude(&start->mode, Y).v;
        x[0][i] = start->origin[0] + 2 * X;
        x[1][i] = start->origin[1] + 2 * Y;
        volume[i] = 1;
        v[1][i] = p.boost[1] + 3 * creal(f * cexp(LAYER_I * 4 * M_PI * X));
        squares += 9 * creal(f * conj(f)) / 2;
    }
    near_relative(mode_amplitude.measure(&p, &s), 3, 1e-12);
    near_below(mode_error.measure(&p, &s), 1e-12);
    near_below(mode_noise.measure(&p, &s), 1e-6);
    near_below(mode_other_parity.measure(&p, &s), 1e-10);
    for (int i = 0; i < SIDE * SIDE; i++) { /* a wave of half the mode's length */
        const double wave = cos(8 * M_PI * (i % SIDE + 0.5) / SIDE);
        v[1][i] += wave;
        noise += wave * wave;
    }
    near_relative(mode_amplitude.measure(&p, &s), 3, 1e-12);
    near_below(mode_error.measure(&p, &s), 1e-12);
    near_relative(mode_noise.measure(&p, &s), sqrt(noise / squares), 1e-10);
    for (int i = 0; i < SIDE * SIDE; i++) /* in a single layer both parities are equally strong */
        if (i / SIDE >= SIDE / 2) v[1][i] = p.boost[1];
    near_relative(mode_other_parity.measure(&p, &s), 1, 1e-10);
}

/* Sides that differ by 1e-12 count as equal, and with one more bit they do not. */
TEST(boxes_are_square)
{
    const double bit = 0x1p-52;
    int tried = 0;
    for (int k = 4600; k < 4700; k++) {
        const double width = k * bit / 1e-12; /* from 1 to 2 */
        if (1e-12 * width != k * bit) continue;
        for (int more = -1; more <= 1; more++) {
            char keys[128];
            snprintf(keys, sizeof keys, "kind=kelvin_helmholtz_mode|lo=0 0|hi=%.17g %.17g", width,
                     width + (k + more) * bit);
            if (more > 0)
                prepared_refused(2, keys, "the layers lie in a square box");
            else
                made(keys);
        }
        if (++tried == 2) break;
    }
    assert_int_equal(tried, 2);
}

TEST(what_no_mode_has_is_refused)
{
    static const char *const rows[][2] = {
        {"kind=kelvin_helmholtz_mode|waves=30",
         "waves=30: no mode of 30 waves in the box grows in a layer of width 0.1"},
        {"kind=kelvin_helmholtz_mode|hi=2|waves=30", "in a layer of width 0.15"},
        {"kind=kelvin_helmholtz_mode|amplitude=0", "amplitude=0: more than 0 and less than"},
        {"kind=kelvin_helmholtz_mode|hi=1 1.0001", "sides of 2 and 2.0001"},
        {"kind=kelvin_helmholtz_mode|hi=1 0.9999", "sides of 2 and 1.9999"},
        {"kind=rayleigh_taylor_mode|gravity=0 0.1", "gravity=\"0 0.1\""},
        {"kind=rayleigh_taylor_mode|gravity=0 0", "gravity=\"0 0\""},
        {"kind=rayleigh_taylor_mode|gravity=0.1 -0.5", "gravity=\"0.1 -0.5\""},
        {"kind=rayleigh_taylor_mode|gravity=0 -100", "pressure"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        prepared_refused(2, rows[k][0], rows[k][1]);
}

/* The growth is fitted from twice the initial amplitude up to, but not including, a tenth of the
 * layer's width. */
TEST(amplitudes_leave_room_to_grow)
{
    static const char *const names[] = {"kelvin_helmholtz_mode", "rayleigh_taylor_mode"};
    for (int k = 0; k < 2; k++) {
        char keys[96], said[64];
        snprintf(keys, sizeof keys, "kind=%s|amplitude=0.001", names[k]);
        const struct prepared p = made(keys);
        const double speed = mode_start_of(&p)->amplitude / 0.001;
        const double most = 0.1 * 0.05 / (2 * mode_start_of(&p)->mode.displacement * speed);
        snprintf(said, sizeof said, "less than %.4g", most);
        for (int less = -1; less < 2; less++) {
            snprintf(keys, sizeof keys, "kind=%s|amplitude=%.17g", names[k],
                     most * (1 - less * 1e-12));
            if (less > 0)
                made(keys);
            else
                prepared_refused(2, keys, said);
        }
    }
}

/* Sinuous and varicose modes differ. Without the key gravity is that of the layer. */
TEST(keys_choose_the_mode)
{
    const struct prepared one = made("kind=kelvin_helmholtz_mode|parity=sinuous"),
                          two = made("kind=kelvin_helmholtz_mode|parity=varicose"),
                          heavy = made("kind=rayleigh_taylor_mode|hi=1 3");
    assert_true(mode_start_of(&one)->mode.layer.pressure_node);
    assert_false(mode_start_of(&two)->mode.layer.pressure_node);
    assert_true(heavy.gravity[1] == -0.125 && heavy.gravity[0] == 0);
    assert_true(mode_start_of(&heavy)->mode.layer.g == 0.5);
    assert_true(heavy.boundary[1] == BOUNDARY_REFLECTING && heavy.boundary[0] == BOUNDARY_PERIODIC);
}

/* Modes that were found before are those of the layer that is asked for, whichever of its numbers
 * differs from those of other layers. */
TEST(modes_are_found_again)
{
    struct settings settings;
    struct prepared p = prepared_of(&settings, 2, heavy_keys);
    const struct layer first = mode_start_of(&p)->mode.layer;
    for (int draw = 0; draw < 2; draw++)
        for (int changed = 0; changed <= 11; changed++) {
            struct layer layer = first;
            double *const numbers[] = {&layer.gamma, &layer.k,        &layer.width,
                                       &layer.rho,   &layer.rho_step, &layer.U,
                                       &layer.P,     &layer.g,        &layer.wall};
            if (changed < 9)
                *numbers[changed] = 1.0625 * *numbers[changed] + (changed == 5) * 0.125;
            if (changed >= 9) layer.U = 0.5, layer.g = 0, layer.k = 2 * M_PI;
            layer.periodic = changed >= 10;
            layer.pressure_node = changed == 11;
            struct layer_mode found;
            struct error error;
            const double origin[2] = {0, 0};
            /* the usual layer stays among those that were found last */
            assert_int_equal(mode_prepare(&p, &first, origin, 4, 0.5, &settings, &error), 0);
            assert_int_equal(mode_prepare(&p, &layer, origin, 4, 0.5, &settings, &error), 0);
            assert_true(layer_mode_find(&layer, &found));
            assert_true(mode_start_of(&p)->mode.omega == found.omega);
            assert_true(mode_start_of(&p)->mode.displacement == found.displacement);
            assert_true(mode_start_of(&p)->mode.layer.wall == layer.wall);
        }
}
