/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "oracle.h"

#include <math.h>
#include <stdlib.h>

#include "integrator.h"

static long double larger(long double a, long double b)
{
    return a > b ? a : b;
}

/* Has every choice of a scheme its formula here? Switches without a default: a member that joins
 * one of the lists does not compile until it is placed. */
static bool covers(const struct scheme *scheme)
{
    switch (scheme->gradient) {
    case GRADIENT_STANDARD:
    case GRADIENT_IA:
        break;
    case GRADIENT_CORRECTED:
        return false;
    }
    switch (scheme->formulation) {
    case FORMULATION_VANILLA_ICE:
    case FORMULATION_LAGRANGIAN:
        break;
    }
    switch (scheme->volume_element) {
    case VOLUME_MASS:
    case VOLUME_ENERGY:
        break;
    case VOLUME_NUMBER:
        return false;
    }
    switch (scheme->viscosity) {
    case VISCOSITY_NONE:
    case VISCOSITY_CONSTANT:
    case VISCOSITY_TIME_DEPENDENT:
    case VISCOSITY_RECONSTRUCTED:
    case VISCOSITY_FADING:
        break;
    case VISCOSITY_CULLEN_DEHNEN:
    case VISCOSITY_PROJECTED:
        return false;
    }
    switch (scheme->viscosity_form) {
    case VISCOSITY_FORM_MU:
        break;
    case VISCOSITY_FORM_SIGNAL:
        return false;
    }
    switch (scheme->balsara) {
    case BALSARA_OFF:
        break;
    case BALSARA_ON:
        return false;
    }
    switch (scheme->energy) {
    case ENERGY_INTERNAL:
    case ENERGY_TOTAL:
        break;
    }
    switch (scheme->h_method) {
    case H_NEWTON:
    case H_PREDICTED:
    case H_CORRECTED:
        break;
    }
    return true; /* pair_width: see mean_gradient; integrator: see oracle_step */
}

enum status oracle_create(struct oracle *oracle, const struct scene *scene, struct error *error)
{
    *oracle = (struct oracle){0};
    if (!covers(&scene->scheme))
        return error_set(error, STATUS_BAD_INPUT, "oracle: it has no formula for this scheme");
    *oracle = (struct oracle){.scheme = scene->scheme,
                              .lo = scene->lo[0],
                              .period = (long double)scene->hi[0] - scene->lo[0],
                              .gamma = scene->gamma,
                              .n = scene->n};
    oracle->kernel = oracle_kernel_find(&oracle->scheme.kernel);
    oracle->particles = calloc(scene->n, sizeof *oracle->particles);
    oracle->start = calloc(scene->n, sizeof *oracle->start);
    if (!oracle->particles || !oracle->start) {
        oracle_free(oracle);
        return error_set(error, STATUS_ENVIRONMENT, "oracle: no memory");
    }
    const bool switched = scene->scheme.viscosity == VISCOSITY_TIME_DEPENDENT;
    for (size_t i = 0; i < scene->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        const long double v = scene->v[0] ? scene->v[0][i] : 0;
        a->x = scene->x[0][i];
        a->m = scene->m[i];
        a->p = a->m * v;
        a->e = a->m * scene->u[i];
        if (scene->scheme.energy == ENERGY_TOTAL) a->e += a->m * v * v / 2;
        a->alpha = switched ? scene->scheme.alpha_min : scene->scheme.alpha;
        /* a first guess only: the root is unique */
        a->h = oracle->period / (long double)scene->n * scene->scheme.eta;
    }
    return STATUS_OK;
}

void oracle_free(struct oracle *oracle)
{
    free(oracle->particles);
    free(oracle->start);
    oracle->particles = oracle->start = NULL;
}

/* x_j - x_i of image k = -1, 0, 1 about the nearest one. */
static long double separation(const struct oracle *oracle, size_t i, size_t j, int k)
{
    const long double x = oracle->particles[j].x - oracle->particles[i].x;
    return x - oracle->period * roundl(x / oracle->period) + k * oracle->period;
}

static long double W(const struct oracle *oracle, long double x, long double h)
{
    return oracle->kernel.constant / h * oracle_kernel_w(&oracle->kernel, fabsl(x) / h);
}

static long double dW_dr(const struct oracle *oracle, long double x, long double h)
{
    return oracle->kernel.constant / (h * h) * oracle_kernel_dw(&oracle->kernel, fabsl(x) / h);
}

static long double dW_dh(const struct oracle *oracle, long double x, long double h)
{
    return -(W(oracle, x, h) + fabsl(x) * dW_dr(oracle, x, h)) / h;
}

/* Kernel sums at particle i of mass and of the volume element, with their derivatives in h. */
static void sum_density(const struct oracle *oracle, size_t i, long double h, long double *rho,
                        long double *drho, long double *y, long double *dy)
{
    const bool energy = oracle->scheme.volume_element == VOLUME_ENERGY;
    *rho = *drho = *y = *dy = 0;
    for (size_t j = 0; j < oracle->n; j++)
        for (int k = -1; k <= 1; k++) {
            const struct oracle_particle *b = &oracle->particles[j];
            const long double x = separation(oracle, i, j, k), Z = energy ? b->U : b->m;
            if (fabsl(x) >= h) continue;
            *rho += b->m * W(oracle, x, h);
            *drho += b->m * dW_dh(oracle, x, h);
            *y += Z * W(oracle, x, h);
            *dy += Z * dW_dh(oracle, x, h);
        }
}

/* The root of h rho(h) = eta m: the left side rises with h, so bisection cannot fail; Newton steps
 * that leave the bracket are replaced by it. */
static enum status solve_h(struct oracle *oracle, size_t i, struct error *error)
{
    struct oracle_particle *a = &oracle->particles[i];
    const long double target = oracle->scheme.eta * a->m;
    long double lo = 0, hi = oracle->period, h = a->h, rho, drho, y, dy;
    for (int round = 0; round < 200; round++) {
        sum_density(oracle, i, h, &rho, &drho, &y, &dy);
        const long double residual = h * rho - target;
        if (residual > 0)
            hi = h;
        else
            lo = h;
        const long double newton = h - residual / (rho + h * drho);
        const long double next = newton > lo && newton < hi ? newton : (lo + hi) / 2;
        if (fabsl(next - h) <= 1e-17L * h || hi - lo <= 1e-17L * hi) {
            a->h = next;
            sum_density(oracle, i, a->h, &a->rho_sum, &drho, &a->y, &dy);
            a->grad_h_rho = a->h / a->rho_sum * drho;
            a->grad_h_y = a->h / a->rho_sum * dy;
            return STATUS_OK;
        }
        h = next;
    }
    return error_set(error, STATUS_BROKE_DOWN, "oracle: particle %zu has no smoothing length", i);
}

/* h_method predicted, corrected: one sum at 1/h extrapolated from the last two, kept within a
 * factor of 2. The sums and gradients keep that width, h itself is what the sum asks for. */
static void predict_h(struct oracle *oracle, size_t i)
{
    struct oracle_particle *a = &oracle->particles[i];
    long double drho, dy, next = a->found + oracle->ahead * (a->found - a->found_before);
    if (next < a->found / 2) next = a->found / 2;
    if (next > a->found * 2) next = a->found * 2;
    a->found_before = a->found;
    a->width = 1 / next;
    sum_density(oracle, i, a->width, &a->rho_sum, &drho, &a->y, &dy);
    a->grad_h_rho = a->width / a->rho_sum * drho;
    a->grad_h_y = a->width / a->rho_sum * dy;
    a->h = oracle->scheme.eta * a->m / a->rho_sum;
    a->found = 1 / a->h;
    if (oracle->scheme.h_method != H_CORRECTED) return;
    /* f(1/h) = 1/h - rho(h)/(eta m): df/d(1/h) = 1 + h^2 drho/dh/(eta m) */
    const long double slope = 1 + a->width * a->width * drho / (oracle->scheme.eta * a->m);
    a->found = next + (a->found - next) / slope;
    if (a->found < next / 2) a->found = next / 2;
    if (a->found > next * 2) a->found = next * 2;
}

/* The pressure follows a volume that was predicted wrong. */
static long double follow(const struct oracle *oracle, const struct oracle_particle *a)
{
    const long double weight = oracle->scheme.integrator->follow * (oracle->gamma - 1);
    return larger(1 - weight * (a->h / a->width - 1), 0.5L);
}

static enum status find_state(struct oracle *oracle, struct error *error)
{
    const bool total = oracle->scheme.energy == ENERGY_TOTAL;
    const bool energy = oracle->scheme.volume_element == VOLUME_ENERGY;
    const bool predicted = oracle->scheme.h_method != H_NEWTON && oracle->last_dt > 0;
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        a->v = a->p / a->m;
        a->U = total ? a->e - a->p * a->p / (2 * a->m) : a->e;
        if (!(a->U > 0))
            return error_set(error, STATUS_BROKE_DOWN, "oracle: particle %zu has U = %Lg", i, a->U);
    }
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        if (predicted) {
            predict_h(oracle, i);
        } else {
            const enum status status = solve_h(oracle, i, error);
            if (status) return status;
            a->width = a->h;
            a->found = a->found_before = 1 / a->h;
        }
        a->V = (energy ? a->U : a->m) / a->y;
        a->rho = energy ? a->m * a->y / a->U : a->rho_sum;
        a->P = (oracle->gamma - 1) * (energy ? a->y : a->rho * a->U / a->m);
        a->c = sqrtl(oracle->gamma * a->P / a->rho);
        if (predicted && !energy) a->P *= follow(oracle, a);
    }
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        long double tau = 0, slope = 0;
        for (size_t j = 0; j < oracle->n; j++)
            for (int k = -1; k <= 1; k++) {
                const struct oracle_particle *b = &oracle->particles[j];
                const long double x = separation(oracle, i, j, k), w = W(oracle, x, a->width);
                tau += b->V * x * x * w;
                slope += b->V * (b->v - a->v) * x * w;
            }
        a->C = 1 / tau;
        a->slope = slope / tau;
    }
    return STATUS_OK;
}

/* grad_i W(r_ij, h) or C x W, as the scheme's gradient says; C belongs to the particle of h. */
static long double gradient(const struct oracle *oracle, long double x, long double h,
                            long double C)
{
    if (oracle->scheme.gradient == GRADIENT_IA) return C * x * W(oracle, x, h);
    return x == 0 ? 0 : -x / fabsl(x) * dW_dr(oracle, x, h);
}

/* One gradient of the pair at width h. For ia the moments 1/sum V x^2 w, without the factors C_1/h
 * of either particle's own width, are averaged: the shape's width is h alone. */
static long double single_gradient(const struct oracle *oracle, const struct oracle_particle *a,
                                   const struct oracle_particle *b, long double x, long double h)
{
    return gradient(oracle, x, h, (a->C / a->width + b->C / b->width) / 2 * h);
}

static long double mean_gradient(const struct oracle *oracle, const struct oracle_particle *a,
                                 const struct oracle_particle *b, long double x)
{
    switch (oracle->scheme.pair_width) {
    case PAIR_WIDTH_MAX:
        return single_gradient(oracle, a, b, x, larger(a->width, b->width));
    case PAIR_WIDTH_HARMONIC:
        return single_gradient(oracle, a, b, x, 2 * a->width * b->width / (a->width + b->width));
    case PAIR_WIDTH_MEAN:
        break;
    }
    return (gradient(oracle, x, a->width, a->C) + gradient(oracle, x, b->width, b->C)) / 2;
}

/* v_ij as the viscosity sees it: reconstructed at the midpoint (Rosswog 2020), and never so that
 * viscosity would cool. */
static long double viscous_velocity(const struct oracle *oracle, const struct oracle_particle *a,
                                    const struct oracle_particle *b, long double x)
{
    const long double v_ij = a->v - b->v;
    if (oracle->scheme.viscosity != VISCOSITY_RECONSTRUCTED) return v_ij;
    if (v_ij * x <= 0) return 0;
    const long double sum = a->slope + b->slope;
    long double phi = sum == 0 ? 0 : 4 * a->slope * b->slope / (sum * sum);
    phi = phi < 0 ? 0 : phi > 1 ? 1 : phi;
    const long double q = fabsl(x) / larger(a->width, b->width),
                      near = 1 / (long double)oracle->scheme.eta;
    if (q < near) phi *= expl(-((q - near) / 0.2L) * ((q - near) / 0.2L));
    return v_ij + phi / 2 * sum * x;
}

static long double viscous_pressure(const struct oracle *oracle, const struct oracle_particle *a,
                                    const struct oracle_particle *b, long double x)
{
    const struct scheme *scheme = &oracle->scheme;
    if (scheme->viscosity == VISCOSITY_NONE) return 0;
    /* r_ij = -x */
    const long double approach = -viscous_velocity(oracle, a, b, x) * x;
    if (approach >= 0) return 0;
    const long double h = (a->h + b->h) / 4, rho = (a->rho + b->rho) / 2;
    const long double mu = h * approach / (x * x + 0.01L * h * h);
    long double c = (a->c + b->c) / 2;
    /* fading: no more than 100 times the speed at which the pair closes */
    if (scheme->viscosity == VISCOSITY_FADING && c > 100 * -approach / fabsl(x))
        c = 100 * -approach / fabsl(x);
    const bool switched = scheme->viscosity == VISCOSITY_TIME_DEPENDENT;
    const long double alpha = (a->alpha + b->alpha) / 2;
    const long double beta =
        switched ? alpha * ((long double)scheme->beta / scheme->alpha) : (long double)scheme->beta;
    return (-alpha * c * mu + beta * mu * mu) / rho;
}

/* f_ij of the grad-h factors: of particle a in its pair with b. */
static long double grad_h_factor(const struct oracle *oracle, const struct oracle_particle *a,
                                 const struct oracle_particle *b)
{
    if (oracle->scheme.volume_element == VOLUME_MASS) return 1 / (1 + a->grad_h_rho);
    return 1 - b->m / b->U * a->grad_h_y / (1 + a->grad_h_rho);
}

static void add_pair(struct oracle *oracle, struct oracle_particle *a,
                     const struct oracle_particle *b, long double x)
{
    const bool energy = oracle->scheme.volume_element == VOLUME_ENERGY;
    const long double Zi = energy ? a->U : a->m, Zj = energy ? b->U : b->m, v_ij = a->v - b->v;
    const long double G = mean_gradient(oracle, a, b, x);
    if (oracle->scheme.formulation == FORMULATION_VANILLA_ICE) {
        a->F -= Zi * Zj * (a->P + b->P) / (a->y * b->y) * G;
        a->dU += a->P * Zi * Zj / (a->y * b->y) * v_ij * G;
    } else {
        const long double Gi = gradient(oracle, x, a->width, a->C);
        const long double Gj = gradient(oracle, x, b->width, b->C);
        const long double fi = grad_h_factor(oracle, a, b), fj = grad_h_factor(oracle, b, a);
        a->F -= Zi * Zj * (fi * a->P / (a->y * a->y) * Gi + fj * b->P / (b->y * b->y) * Gj);
        a->dU += fi * a->P / (a->y * a->y) * Zi * Zj * v_ij * Gi;
    }
    const long double PI = viscous_pressure(oracle, a, b, x);
    a->F -= a->m * b->m * PI * G;
    a->dU += a->m * b->m * PI * v_ij * G / 2;
    a->div_v -= b->V * v_ij * G;
}

void oracle_signals(struct oracle *oracle)
{
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        a->signal = 2 * a->c;
        for (size_t j = 0; j < oracle->n; j++)
            for (int k = -1; k <= 1; k++) {
                const struct oracle_particle *b = &oracle->particles[j];
                const long double x = separation(oracle, i, j, k);
                if (x == 0 || fabsl(x) >= larger(a->h, b->h)) continue;
                /* e_ij . v_ij with e_ij = -x/|x| */
                const long double radial = -(a->p / a->m - b->p / b->m) * x / fabsl(x);
                a->signal = larger(a->signal, a->c + b->c - 3 * (radial < 0 ? radial : 0));
            }
    }
}

enum status oracle_evaluate(struct oracle *oracle, struct error *error)
{
    const enum status status = find_state(oracle, error);
    if (status) return status;
    const struct scheme *scheme = &oracle->scheme;
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        a->F = a->dU = a->div_v = 0;
        for (size_t j = 0; j < oracle->n; j++)
            for (int k = -1; k <= 1; k++)
                if (j != i || k != 0)
                    add_pair(oracle, a, &oracle->particles[j], separation(oracle, i, j, k));
        a->de = scheme->energy == ENERGY_TOTAL ? a->v * a->F + a->dU : a->dU;
        const long double growth = larger(-a->div_v, 0) * larger(scheme->alpha_max - a->alpha, 0);
        const long double tau = a->h / (0.2L * a->c);
        a->dalpha = scheme->viscosity == VISCOSITY_TIME_DEPENDENT
                        ? growth - (a->alpha - scheme->alpha_min) / tau
                        : 0;
    }
    oracle_signals(oracle);
    return STATUS_OK;
}
