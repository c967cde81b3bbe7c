/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "layer_mode.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>

#include "layer_collocation.h"

enum { LAST = LAYER_MODE_NODES - 1, MIDDLE = LAST / 2 };

/* ---- places: Chebyshev points in zeta in [-1, 1], dense where the layer is ---- */

static double reach(const struct layer *layer)
{
    return layer->periodic ? 0.25 : layer->wall;
}

static double stretch(const struct layer *layer)
{
    return asinh(2.5 * reach(layer) / layer->width);
}

static double place(const struct layer *layer, int j)
{
    const double b = stretch(layer);
    return reach(layer) * sinh(b * cos(M_PI * j / LAST)) / sinh(b);
}

/* ---- shooting ---- */

struct shot {
    const struct layer *layer;
    double complex omega;
};

/* y = Re xi, Im xi, Re p, Im p. */
static int slopes(double at, const double y[], double dy[], void *context)
{
    const struct shot *shot = context;
    const struct layer *layer = shot->layer;
    const struct layer_base base = layer_base(layer, at);
    const double g = layer->g, k = layer->k, N2 = -g * (base.rho_dy / base.rho + g / base.c2);
    const double complex s = k * base.U - shot->omega, xi = y[0] + LAYER_I * y[1],
                         p = y[2] + LAYER_I * y[3];
    const double complex xi_dy = g / base.c2 * xi + (k * k / (s * s) - 1 / base.c2) * p / base.rho;
    const double complex p_dy = base.rho * (s * s - N2) * xi - g / base.c2 * p;
    dy[0] = creal(xi_dy);
    dy[1] = cimag(xi_dy);
    dy[2] = creal(p_dy);
    dy[3] = cimag(p_dy);
    return GSL_SUCCESS;
}

/* Integrates from an end (node 0 or LAST) to the middle; stores xi and p at the nodes. */
static bool shoot(const struct shot *shot, int from, double complex *xi, double complex *p)
{
    struct shot copy = *shot;
    const gsl_odeiv2_system system = {slopes, NULL, 4, &copy};
    const int step = from ? -1 : 1;
    const bool node = shot->layer->periodic && shot->layer->pressure_node;
    /* the pressure of a displacement of 1: the unit of absolute accuracy */
    const double omega = cabs(shot->omega),
                 unit = shot->layer->rho * omega * omega / shot->layer->k;
    const double scale[4] = {1, 1, unit, unit};
    double y[4] = {node ? 1 : 0, 0, node ? 0 : unit, 0}, at = place(shot->layer, from);
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_scaled_new(
        &system, gsl_odeiv2_step_rk8pd, -1e-3 * at, 1e-14, 1e-13, 1, 0, scale);
    if (!driver) return false;
    bool sound = true;
    for (int j = from; sound; j += step) {
        const double next = j == MIDDLE ? 0 : place(shot->layer, j);
        sound = j == from || gsl_odeiv2_driver_apply(driver, &at, next, y) == GSL_SUCCESS;
        xi[j] = y[0] + LAYER_I * y[1];
        p[j] = y[2] + LAYER_I * y[3];
        if (j == MIDDLE) break;
    }
    gsl_odeiv2_driver_free(driver);
    return sound;
}

/* The mismatch of both halves in the middle, 0 for a mode; xi and p: the joined solution. */
static double complex mismatch(const struct layer *layer, double complex omega, double complex *xi,
                               double complex *p)
{
    const struct shot shot = {layer, omega};
    if (!shoot(&shot, LAST, xi, p)) return (double)NAN;
    const double complex below[2] = {xi[MIDDLE], p[MIDDLE]};
    if (!shoot(&shot, 0, xi, p)) return (double)NAN;
    const double complex ratio = xi[MIDDLE] / below[0]; /* a growing mode has xi != 0 there */
    const double complex defect = below[0] * p[MIDDLE] - below[1] * xi[MIDDLE];
    for (int j = MIDDLE + 1; j <= LAST; j++) {
        xi[j] *= ratio;
        p[j] *= ratio;
    }
    return defect;
}

/* Transforms values at the nodes to Chebyshev coefficients. */
static void transform(double complex *values)
{
    double complex sums[LAYER_MODE_NODES];
    for (int m = 0; m <= LAST; m++) {
        sums[m] = 0;
        for (int j = 0; j <= LAST; j++)
            sums[m] += (j % LAST ? 1 : 0.5) * values[j] * cos(M_PI * ((m * j) % (2 * LAST)) / LAST);
        sums[m] *= (m % LAST ? 2. : 1.) / LAST;
    }
    for (int m = 0; m <= LAST; m++) values[m] = sums[m];
}

/* Clenshaw's sum. */
static double complex series(const double complex *coefficients, double zeta)
{
    double complex b1 = 0, b2 = 0;
    for (int m = LAST; m > 0; m--) {
        const double complex b = 2 * zeta * b1 - b2 + coefficients[m];
        b2 = b1;
        b1 = b;
    }
    return zeta * b1 - b2 + coefficients[0];
}

/* Normalises the mode: the greatest |v| is 1, v(0) > 0. */
static void normalise(struct layer_mode *mode)
{
    enum { SAMPLES = 2000 };
    const double end = reach(&mode->layer);
    double speed = 0, xi = 0;
    for (int i = 0; i <= SAMPLES; i++) {
        const struct layer_amplitude a = layer_mode_amplitude(mode, end * (2. * i / SAMPLES - 1));
        speed = fmax(speed, cabs(a.v));
        xi = fmax(xi, cabs(a.xi));
    }
    const double complex middle = layer_mode_amplitude(mode, 0).v;
    const double complex unit = cabs(middle) / (middle * speed);
    for (int m = 0; m <= LAST; m++) {
        mode->v[m] *= unit;
        mode->p[m] *= unit;
    }
    mode->displacement = xi / speed;
}

bool layer_mode_find(const struct layer *layer, struct layer_mode *mode)
{
    enum { START_POINTS = 32, ROUNDS = 40 };
    *mode = (struct layer_mode){.layer = *layer};
    double complex last = layer_mode_collocation(layer, START_POINTS), omega = last * (1 + 1e-4);
    mode->omega = last;
    if (!(cimag(last) > 0)) return false;
    double complex defect = mismatch(layer, last, mode->v, mode->p);
    double done = (double)INFINITY; /* the last step, relative */
    for (int i = 0; i < ROUNDS; i++) {
        const double complex now = mismatch(layer, omega, mode->v, mode->p);
        const double complex step = now == defect ? 0 : now * (omega - last) / (now - defect);
        const double size = cabs(step) / cabs(omega);
        if (!isfinite(size) || (done < 1e-10 && size >= 0.5 * done)) break; /* round-off */
        last = omega;
        defect = now;
        omega -= step;
        done = size;
        if (size <= 1e-14) break;
    }
    const double slowest = 1e-8 * layer->k * sqrt(layer_base(layer, 0).c2); /* round-off grows */
    if (!(done <= 1e-10 && cimag(omega) > slowest)) return false;
    mismatch(layer, omega, mode->v, mode->p);
    for (int j = 0; j <= LAST; j++) /* v is smoother than xi */
        mode->v[j] *= LAYER_I * (layer->k * layer_base(layer, place(layer, j)).U - omega);
    mode->omega = omega;
    transform(mode->v);
    transform(mode->p);
    normalise(mode);
    return true;
}

/* ---- the mode at a place ---- */

struct layer_amplitude layer_mode_amplitude(const struct layer_mode *mode, double y)
{
    const struct layer *layer = &mode->layer;
    const double within = layer->periodic ? y - floor(y + 0.25) : y; /* [-1/4, 3/4) */
    const bool mirrored = layer->periodic && within > 0.25;
    const double at = mirrored ? 0.5 - within : within, b = stretch(layer);
    const double zeta = asinh(at * sinh(b) / reach(layer)) / b;
    const struct layer_base base = layer_base(layer, at);
    const double complex s = layer->k * base.U - mode->omega;
    const double complex v = series(mode->v, zeta), xi = v / (LAYER_I * s),
                         p = series(mode->p, zeta);
    /* reflection about y = 1/4 changes the sign of either v or all the other values */
    const double sign = !mirrored ? 1 : layer->pressure_node ? -1 : 1, side = mirrored ? -sign : 1;
    return (struct layer_amplitude){
        .rho = sign * (p / base.c2 - (base.rho_dy + base.rho * layer->g / base.c2) * xi),
        .u = sign * (-layer->k * p / (base.rho * s) - base.U_dy * xi),
        .v = side * v,
        .p = sign * p,
        .xi = side * xi};
}

struct layer_values layer_mode_values(const struct layer_mode *mode, double x, double y, double t)
{
    const struct layer_amplitude a = layer_mode_amplitude(mode, y);
    const double complex wave = cexp(LAYER_I * (mode->layer.k * x - mode->omega * t));
    return (struct layer_values){
        creal(a.rho * wave), {creal(a.u * wave), creal(a.v * wave)}, creal(a.p * wave)};
}
