/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks of the growing modes of layers: two methods agree on omega, the modes satisfy the
 * linearised equations by differences of their fields in x, y and t, and known limits are met. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "layer_collocation.h"
#include "layer_mode.h"
#include "worst.h"

struct layer_subject {
    bool (*find)(const struct layer *layer, struct layer_mode *mode);
    struct layer_values (*values)(const struct layer_mode *mode, double x, double y, double t);
};

static const struct layer_subject right = {layer_mode_find, layer_mode_values};

/* gamma, k, width, rho, step, U, P, g, periodic, wall, node; omega from an independent program by
 * shooting and collocation (NaN: not in its table). */
static const struct {
    const char *name;
    struct layer layer;
    double real, growth;
} layers[] = {
    {"shear between walls",
     {5. / 3, 2 * M_PI, 0.05, 1, 0, 0.5, 2.5, 0, false, 0.5, false},
     0,
     1.652652878},
    {"shear of two densities between walls",
     {5. / 3, 2 * M_PI, 0.05, 1.5, 0.5, 0.5, 2.5, 0, false, 0.5, false},
     0.640421805,
     1.600445063},
    {"periodic shear, p = 0 in the streams",
     {5. / 3, 2 * M_PI, 0.05, 1.5, 0.5, 0.5, 2.5, 0, true, 0, true},
     0.630225022,
     1.705572193},
    {"periodic shear, v = 0 in the streams",
     {5. / 3, 2 * M_PI, 0.05, 1.5, 0.5, 0.5, 2.5, 0, true, 0, false},
     (double)NAN,
     (double)NAN},
    {"heavy over light, short",
     {5. / 3, 4 * M_PI, 0.05, 1.5, 0.5, 0, 2.5, 0.5, false, 0.5, false},
     0,
     1.170903153},
    {"heavy over light, long",
     {5. / 3, 2 * M_PI, 0.05, 1.5, 0.5, 0, 2.5, 0.5, false, 0.5, false},
     0,
     0.923138681},
    {"shear and gravity",
     {1.4, 3, 0.07, 1.3, 0.2, 0.4, 1.7, 0.3, false, 0.6, false},
     (double)NAN,
     (double)NAN},
};
enum { LAYERS = sizeof layers / sizeof *layers };

/* ---- equations ---- */

enum { EQUATIONS = 4 };

/* d/dx, d/dy and d/dt by sixth-order central differences. */
static struct layer_values difference(const struct layer_subject *subject,
                                      const struct layer_mode *mode, const double at[3], int axis)
{
    static const double weights[] = {3. / 4, -3. / 20, 1. / 60}, step = 5e-4;
    struct layer_values sum = {0};
    for (int i = -3; i <= 3; i++) {
        double x[3] = {at[0], at[1], at[2]};
        if (i == 0) continue;
        x[axis] += i * step;
        const struct layer_values v = subject->values(mode, x[0], x[1], x[2]);
        const double w = (i < 0 ? -1 : 1) * weights[abs(i) - 1] / step;
        sum.rho += w * v.rho;
        sum.p += w * v.p;
        for (int d = 0; d < 2; d++) sum.v[d] += w * v.v[d];
    }
    return sum;
}

/* Residual of mass, both momenta and energy, relative to the sum of the sizes of the terms; the
 * base state is differentiated numerically as well. */
static double residual(const struct layer_subject *subject, const struct layer_mode *mode,
                       const double at[3])
{
    enum { TERMS = 5 };
    const struct layer *layer = &mode->layer;
    const double h = 1e-4, g = layer->g, y = at[1];
    const struct layer_base b = layer_base(layer, y), up = layer_base(layer, y + h),
                            down = layer_base(layer, y - h), up2 = layer_base(layer, y + 2 * h),
                            down2 = layer_base(layer, y - 2 * h);
#define SLOPE(field) ((8 * (up.field - down.field) - (up2.field - down2.field)) / (12 * h))
    const double rho_dy = SLOPE(rho), U_dy = SLOPE(U), P_dy = SLOPE(P);
    const struct layer_values q = subject->values(mode, at[0], y, at[2]),
                              dx = difference(subject, mode, at, 0),
                              dy = difference(subject, mode, at, 1),
                              dt = difference(subject, mode, at, 2);
    const double div = dx.v[0] + dy.v[1];
    const double terms[EQUATIONS][TERMS] = {
        {dt.rho, b.U * dx.rho, q.v[1] * rho_dy, b.rho * div, 0},
        {b.rho * dt.v[0], b.rho * b.U * dx.v[0], b.rho * q.v[1] * U_dy, dx.p, 0},
        {b.rho * dt.v[1], b.rho * b.U * dx.v[1], dy.p, g * q.rho, 0},
        {dt.p, b.U * dx.p, q.v[1] * P_dy, layer->gamma * b.P * div, 0},
    };
    const double floors[EQUATIONS] = {b.rho, b.rho, b.rho, b.P}; /* times the growth rate */
    double worst = fabs(P_dy + b.rho * g) / layer->P;
    for (int e = 0; e < EQUATIONS; e++) {
        double sum = 0, size = 1e-3 * floors[e] * cimag(mode->omega);
        for (int i = 0; i < TERMS; i++) {
            sum += terms[e][i];
            size += fabs(terms[e][i]);
        }
        worst_keep(&worst, fabs(sum) / size);
    }
    return worst;
}
#undef SLOPE

static double worst_residual(const struct layer_subject *subject, const struct layer_mode *mode)
{
    enum { PLACES = 100 };
    const struct layer *layer = &mode->layer;
    const double end = layer->periodic ? 0.5 : layer->wall - 4e-3;
    double worst = 0;
    for (int i = 1; i <= PLACES; i++) {
        /* every second point in the layer; some where mirror images join */
        const double part = 2 * fmod(i * 0.7548776662466927, 1) - 1;
        const double y = i % 9 == 0 && layer->periodic ? copysign(0.25, part)
                         : i % 2                       ? end * part
                                                       : 2 * layer->width * part;
        const double at[3] = {fmod(i * 0.5698402909980532, 1), y, 0.3 * fmod(i * 0.618034, 1)};
        worst_keep(&worst, residual(subject, mode, at));
    }
    return worst;
}

/* Defect of the boundary conditions: no flow through walls, and periodicity. *unit: deviation of
 * the greatest |v| from 1. */
static double edges(const struct layer_subject *subject, const struct layer_mode *mode,
                    double *unit)
{
    const double wall = mode->layer.wall;
    double worst = 0, speed = 0;
    for (int i = 0; i < 20; i++) {
        const double x = 0.11 * i, y = 0.07 * i - 0.6;
        if (!mode->layer.periodic) {
            worst_keep(&worst, fabs(subject->values(mode, x, wall, 0.1).v[1]));
            worst_keep(&worst, fabs(subject->values(mode, x, -wall, 0.1).v[1]));
            continue;
        }
        const struct layer_values a = subject->values(mode, x, y, 0.1),
                                  b = subject->values(mode, x, y + 1, 0.1);
        worst_keep(&worst, fabs(a.rho - b.rho) + fabs(a.p - b.p) + fabs(a.v[0] - b.v[0]) +
                               fabs(a.v[1] - b.v[1]));
    }
    for (int i = -250; i <= 250; i++) {
        const double y = i / 250. * (mode->layer.periodic ? 0.25 : wall);
        const double quarter = 0.5 * M_PI / mode->layer.k;
        speed = fmax(speed, hypot(subject->values(mode, 0, y, 0).v[1],
                                  subject->values(mode, quarter, y, 0).v[1]));
    }
    *unit = fabs(speed - 1);
    return worst;
}

/* Found once, also for all mutants: each takes as long as everything else about the layer. */
static double complex collocated(size_t i)
{
    enum { POINTS = 56 };
    static _Thread_local double complex kept[LAYERS];
    if (kept[i] == 0) kept[i] = layer_mode_collocation(&layers[i].layer, POINTS);
    return kept[i];
}

static void measure_layer(struct check_run *run, const void *given)
{
    const struct layer_subject *subject = given ? given : &right;
    for (size_t i = 0; i < LAYERS && !check_decided(run); i++) {
        const struct layer *layer = &layers[i].layer;
        struct layer_mode mode;
        const bool found = !layer_fault(layer) && subject->find(layer, &mode);
        check_measure(run, found ? cabs(mode.omega - collocated(i)) : (double)NAN, 2e-11, 1e-12,
                      "%s: omega of shooting and of collocation", layers[i].name);
        if (!found) continue;
        if (isfinite(layers[i].growth))
            check_measure(run,
                          fmax(fabs(creal(mode.omega) - layers[i].real),
                               fabs(cimag(mode.omega) - layers[i].growth)),
                          1e-9, 5e-10, "%s: omega of another program", layers[i].name);
        check_measure(run, worst_residual(subject, &mode), 1e-7, 5e-9,
                      "%s: linearised Euler equations by differences", layers[i].name);
        double unit = (double)NAN;
        check_measure(run, edges(subject, &mode, &unit), 1e-10, 1e-12,
                      "%s: walls, or the other end of the box", layers[i].name);
        check_measure(run, unit, 3e-4, 5e-5, "%s: the greatest |v| is 1", layers[i].name);
    }
    /* at a high sound speed and far from walls: Michalke 1964, J. Fluid Mech. 19, 543: growth
     * 0.1897 U/width at k width = 0.4446 */
    const struct layer vortex_sheet = {1.4, 0.4446, 1, 1, 0, 1, 1e5, 0, false, 15, false};
    struct layer_mode mode;
    const bool found = subject->find(&vortex_sheet, &mode);
    check_measure(run, found ? fabs(cimag(mode.omega) - 0.1897) : (double)NAN, 1e-4, 5e-5,
                  "growth of Michalke's incompressible layer");
}

/* ---- wrong modes ---- */

static bool find_other_parity(const struct layer *layer, struct layer_mode *mode)
{
    struct layer other = *layer;
    other.pressure_node = !layer->pressure_node;
    return layer_mode_find(&other, mode);
}

static bool find_incompressible(const struct layer *layer, struct layer_mode *mode)
{
    struct layer stiff = *layer;
    stiff.P *= 1e3;
    const bool found = layer_mode_find(&stiff, mode);
    mode->layer = *layer;
    return found;
}

static bool find_roughly(const struct layer *layer, struct layer_mode *mode)
{
    const bool found = layer_mode_find(layer, mode);
    mode->omega *= 1 + 1e-9;
    return found;
}

static struct layer_values without_shear(const struct layer_mode *mode, double x, double y,
                                         double t)
{
    const struct layer_amplitude a = layer_mode_amplitude(mode, y);
    const double complex wave = cexp(LAYER_I * (mode->layer.k * x - mode->omega * t));
    struct layer_values values = layer_mode_values(mode, x, y, t);
    values.v[0] += creal(layer_base(&mode->layer, y).U_dy * a.xi * wave);
    return values;
}

static struct layer_values unmirrored(const struct layer_mode *mode, double x, double y, double t)
{
    struct layer_mode other = *mode;
    other.layer.pressure_node = !mode->layer.pressure_node;
    return layer_mode_values(&other, x, y, t);
}

static struct layer_values without_weight(const struct layer_mode *mode, double x, double y,
                                          double t)
{
    const struct layer_amplitude a = layer_mode_amplitude(mode, y);
    const struct layer_base base = layer_base(&mode->layer, y);
    const double complex wave = cexp(LAYER_I * (mode->layer.k * x - mode->omega * t));
    struct layer_values values = layer_mode_values(mode, x, y, t);
    values.rho += creal(base.rho * mode->layer.g / base.c2 * a.xi * wave);
    return values;
}

static struct layer_values decaying(const struct layer_mode *mode, double x, double y, double t)
{
    struct layer_mode other = *mode;
    other.omega = conj(mode->omega);
    return layer_mode_values(&other, x, y, t);
}

#define FIND(function)                                                                             \
    &(struct layer_subject)                                                                        \
    {                                                                                              \
        function, layer_mode_values                                                                \
    }
#define VALUES(function)                                                                           \
    &(struct layer_subject)                                                                        \
    {                                                                                              \
        layer_mode_find, function                                                                  \
    }
static const struct check_mutant layer_mutants[] = {
    {"layer_other_parity", "the mode of the other parity", FIND(find_other_parity)},
    {"layer_incompressible", "a sound speed 30 times too high", FIND(find_incompressible)},
    {"layer_roughly", "omega off by 1e-9", FIND(find_roughly)},
    {"layer_without_shear", "u without - U' xi", VALUES(without_shear)},
    {"layer_unmirrored", "mirrored with the signs of the other parity", VALUES(unmirrored)},
    {"layer_without_weight", "density without the part of gravity", VALUES(without_weight)},
    {"layer_decaying", "the mode decays", VALUES(decaying)},
    {0},
};

CHECK_DEFINE(
    exact, layer_modes, 550, .cost = 0.5,
    .property = "growing modes of shear and stratified layers: two methods, the linear equations",
    .measure = measure_layer, .mutants = layer_mutants);
