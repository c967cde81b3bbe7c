/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "oracle.h"

#include <math.h>
#include <stdlib.h>

#include "integrator.h"
#include "oracle_parts.h"

/* True if the oracle has a formula for every choice of a scheme. Gradients and viscosities may join
 * their lists without one. The switches have no default, so that a new member of those lists does
 * not compile until it is handled. (pair_width: see find_gradients.) */
bool oracle_covers(const struct scheme *scheme)
{
    switch (scheme->gradient) {
    case GRADIENT_STANDARD:
    case GRADIENT_IA:
    case GRADIENT_CORRECTED:
    case GRADIENT_BLENDED:
        break;
    default:
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
    case VOLUME_NUMBER:
        break;
    }
    switch (scheme->viscosity) {
    case VISCOSITY_NONE:
    case VISCOSITY_CONSTANT:
    case VISCOSITY_TIME_DEPENDENT:
    case VISCOSITY_RECONSTRUCTED:
    case VISCOSITY_FADING:
    case VISCOSITY_PROJECTED:
    case VISCOSITY_CULLEN_DEHNEN:
        break;
    default:
        return false;
    }
    switch (scheme->viscosity_form) {
    case VISCOSITY_FORM_MU:
    case VISCOSITY_FORM_SIGNAL:
        break;
    }
    switch (scheme->balsara) {
    case BALSARA_OFF:
    case BALSARA_ON:
        break;
    }
    switch (scheme->energy) {
    case ENERGY_INTERNAL:
    case ENERGY_TOTAL:
        break;
    }
    switch (scheme->h_method) {
    case H_NEWTON:
    case H_PREDICTED:
        break;
    }
    return true;
}

enum status oracle_create(struct oracle *oracle, const struct setup *setup, struct error *error)
{
    *oracle = (struct oracle){0};
    if (!oracle_covers(&setup->scheme))
        return error_set(error, STATUS_BAD_INPUT, "oracle: it has no formula for this scheme");
    *oracle = (struct oracle){
        .scheme = setup->scheme, .dim = setup->dim, .gamma = setup->gamma, .n = setup->n};
    long double share = 1; /* the box's volume, then the mean spacing */
    for (int k = 0; k < setup->dim; k++) {
        oracle->lo[k] = setup->lo[k];
        oracle->period[k] = (long double)setup->hi[k] - setup->lo[k];
        share *= oracle->period[k];
    }
    share = powl(share / (long double)setup->n, 1.0L / setup->dim);
    oracle->kernel = oracle_kernel_find(&oracle->scheme.kernel, setup->dim);
    oracle->particles = calloc(setup->n, sizeof *oracle->particles);
    oracle->start = calloc(setup->n, sizeof *oracle->start);
    oracle->distance = calloc(setup->n * setup->n * 3, sizeof *oracle->distance);
    if (!oracle->particles || !oracle->start || !oracle->distance) {
        oracle_free(oracle);
        return error_set(error, STATUS_ENVIRONMENT, "oracle: no memory");
    }
    const bool switched = setup->scheme.viscosity == VISCOSITY_TIME_DEPENDENT ||
                          setup->scheme.viscosity == VISCOSITY_CULLEN_DEHNEN;
    for (size_t i = 0; i < setup->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        a->m = setup->m[i];
        a->e = a->m * setup->u[i];
        for (int k = 0; k < setup->dim; k++) {
            const long double v = setup->v[k] ? setup->v[k][i] : 0;
            a->x[k] = setup->x[k][i];
            a->p[k] = a->m * v;
            if (setup->scheme.energy == ENERGY_TOTAL) a->e += a->m * v * v / 2;
        }
        a->alpha = switched ? setup->scheme.alpha_min : setup->scheme.alpha;
        a->h = share * setup->scheme.eta; /* a first guess only: the root is unique */
    }
    return STATUS_OK;
}

void oracle_free(struct oracle *oracle)
{
    free(oracle->particles);
    free(oracle->start);
    free(oracle->distance);
    oracle->particles = oracle->start = NULL;
    oracle->distance = NULL;
}

/* Sums of particle i at smoothing length h: rho, and y, which h follows, in units of a density
 * (mass; with the number element m_i n_i); and their derivatives in h. */
struct sums {
    long double rho, drho, y, dy;
};

static struct sums sum_density(const struct oracle *oracle, size_t i, long double h)
{
    const struct oracle_particle *a = &oracle->particles[i];
    const bool number = oracle->scheme.volume_element == VOLUME_NUMBER;
    const struct oracle_kernel *kernel = &oracle->kernel;
    const int d = oracle->dim;
    const long double of_w = kernel->constant / oracle_power(h, d),
                      of_dw = kernel->constant / oracle_power(h, d + 1);
    struct sums s = {0};
    for (size_t j = 0; j < oracle->n; j++)
        for (int k = -oracle_images(oracle); k <= oracle_images(oracle); k++) {
            const struct oracle_particle *b = &oracle->particles[j];
            const long double r = oracle_distance(oracle, i, j, k);
            if (r >= h) continue;
            const long double q = r / h, W = of_w * oracle_kernel_w(kernel, q),
                              dW = -(d * W + r * (of_dw * oracle_kernel_dw(kernel, q))) / h;
            const long double m = number ? a->m : b->m, Z = oracle_Z(oracle, b);
            s.rho += m * W;
            s.drho += m * dW;
            s.y += Z * W;
            s.dy += Z * dW;
        }
    return s;
}

static void keep_sums(const struct oracle *oracle, struct oracle_particle *a, struct sums s)
{
    a->rho_sum = s.rho;
    a->y = s.y;
    a->grad_h_rho = a->width / (oracle->dim * s.rho) * s.drho;
    a->grad_h_y = a->width / (oracle->dim * s.rho) * s.dy;
}

/* The root of h^d rho(h) = eta^d m: the left side rises with h, so bisection cannot fail; Newton
 * steps that leave the bracket are replaced by it. */
static enum status solve_h(struct oracle *oracle, size_t i, struct error *error)
{
    struct oracle_particle *a = &oracle->particles[i];
    const int d = oracle->dim;
    const long double target = oracle_power(oracle->scheme.eta, d) * a->m;
    long double lo = 0, hi = 0, h = a->h;
    for (int k = 0; k < d; k++) hi = fmaxl(hi, oracle->period[k]);
    for (int round = 0; round < 200; round++) {
        const struct sums s = sum_density(oracle, i, h);
        const long double residual = oracle_power(h, d) * s.rho - target;
        if (residual > 0)
            hi = h;
        else
            lo = h;
        const long double slope = oracle_power(h, d - 1) * (d * s.rho + h * s.drho);
        const long double newton = h - residual / slope;
        const long double next = newton > lo && newton < hi ? newton : (lo + hi) / 2;
        if (fabsl(next - h) <= 1e-17L * h || hi - lo <= 1e-17L * hi) {
            a->h = a->width = next;
            keep_sums(oracle, a, sum_density(oracle, i, next));
            return STATUS_OK;
        }
        h = next;
    }
    return error_set(error, STATUS_BROKE_DOWN, "oracle: particle %zu has no smoothing length", i);
}

/* h_method predicted: one sum at 1/h extrapolated from the last two, by a quarter at most, then a
 * Newton step for the next. The sums and gradients keep the predicted width; h itself follows from
 * the density sum. */
static void predict_h(struct oracle *oracle, size_t i)
{
    struct oracle_particle *a = &oracle->particles[i];
    long double next = a->found + oracle->ahead * (a->found - a->found_before);
    next = fminl(fmaxl(next, 0.8L * a->found), 1.25L * a->found);
    a->found_before = a->found;
    a->width = 1 / next;
    const struct sums s = sum_density(oracle, i, a->width);
    keep_sums(oracle, a, s);
    a->h = oracle->scheme.eta * powl(a->m / s.rho, 1.0L / oracle->dim);
    a->found = 1 / a->h;
    /* f(1/h) = 1/h - (rho(h)/m)^(1/d)/eta: df/d(1/h) = 1 + (h^2/(d rho)) drho/dh/target */
    const long double slope = 1 + a->width * a->width / (oracle->dim * s.rho) * s.drho * a->found;
    a->found = next + (a->found - next) / fmaxl(slope, 0.25L);
    a->found = fminl(fmaxl(a->found, next / 2), next * 2);
}

/* Corrects the pressure for the error of the predicted volume. */
static long double follow(const struct oracle *oracle, const struct oracle_particle *a)
{
    const long double weight = oracle->scheme.integrator->follow * (oracle->gamma - 1);
    return fmaxl(1 - weight * (oracle_power(a->h / a->width, oracle->dim) - 1), 0.5L);
}

static enum status find_primitives(struct oracle *oracle, struct error *error)
{
    const bool total = oracle->scheme.energy == ENERGY_TOTAL;
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        for (int k = 0; k < 3; k++) a->v[k] = a->p[k] / a->m;
        a->U = total ? a->e - oracle_dot(a->p, a->p) / (2 * a->m) : a->e;
        if (!(a->U > 0))
            return error_set(error, STATUS_BROKE_DOWN, "oracle: particle %zu has U = %Lg", i, a->U);
    }
    return STATUS_OK;
}

static enum status find_state(struct oracle *oracle, struct error *error)
{
    const bool energy = oracle->scheme.volume_element == VOLUME_ENERGY;
    const bool predicted = oracle->scheme.h_method != H_NEWTON && oracle->last_dt > 0;
    const enum status primitives = find_primitives(oracle, error);
    if (primitives) return primitives;
    oracle_find_distances(oracle);
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        if (predicted) {
            predict_h(oracle, i);
        } else {
            const enum status status = solve_h(oracle, i, error);
            if (status) return status;
            a->found = a->found_before = 1 / a->h;
        }
        a->V = oracle_Z(oracle, a) / a->y;
        a->rho = energy ? a->m * a->y / a->U : a->rho_sum;
        a->P = (oracle->gamma - 1) * (energy ? a->y : a->rho * a->U / a->m);
        a->c = sqrtl(oracle->gamma * a->P / a->rho);
        if (predicted && !energy) a->P *= follow(oracle, a);
    }
    oracle_find_matrices(oracle);
    return STATUS_OK;
}

void oracle_signals(struct oracle *oracle)
{
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        a->signal = 2 * a->c;
        for (size_t j = 0; j < oracle->n; j++)
            for (int k = -oracle_images(oracle); k <= oracle_images(oracle); k++) {
                const struct oracle_particle *b = &oracle->particles[j];
                oracle_vector x;
                const long double r = oracle_distance(oracle, i, j, k);
                if ((j == i && k == 0) || r >= fmaxl(a->width, b->width)) continue;
                oracle_separation(oracle, a, b, k, x);
                /* e_ij . v_ij with e_ij = -x/r */
                long double radial = 0;
                for (int c = 0; c < 3 && r > 0; c++)
                    radial -= (a->p[c] / a->m - b->p[c] / b->m) * x[c] / r;
                a->signal = fmaxl(a->signal, a->c + b->c - 3 * fminl(radial, 0));
            }
    }
}

/* The rates of one particle from all its pairs. */
static void find_rates(struct oracle *oracle, size_t i)
{
    const struct scheme *scheme = &oracle->scheme;
    struct oracle_particle *a = &oracle->particles[i];
    a->F[0] = a->F[1] = a->F[2] = a->dU = a->div_v = 0;
    a->of_one[0] = a->of_one[1] = a->of_one[2] = 0;
    a->dp_shift[0] = a->dp_shift[1] = a->dp_shift[2] = a->de_shift = a->dm = 0;
    a->neighbours = 0;
    for (size_t j = 0; j < oracle->n; j++)
        for (int k = -oracle_images(oracle); k <= oracle_images(oracle); k++) {
            const struct oracle_particle *b = &oracle->particles[j];
            oracle_vector x;
            const long double r = oracle_distance(oracle, i, j, k);
            if ((j == i && k == 0) || r >= fmaxl(a->width, b->width)) continue;
            oracle_separation(oracle, a, b, k, x);
            a->neighbours += r < a->width;
            oracle_add_pair(oracle, a, b, x);
        }
    a->de = scheme->energy == ENERGY_TOTAL ? oracle_dot(a->v, a->F) + a->dU : a->dU;
    const long double growth = fmaxl(-a->div_v, 0) * fmaxl(scheme->alpha_max - a->alpha, 0);
    const long double tau = a->h / (0.2L * a->c);
    a->dalpha = scheme->viscosity == VISCOSITY_TIME_DEPENDENT
                    ? growth - (a->alpha - scheme->alpha_min) / tau
                    : 0;
}

/* Iterates the potentials of a first state by eight evaluations, each no longer than 1/(20 h). */
static void find_potentials(struct oracle *oracle)
{
    for (size_t i = 0; i < oracle->n; i++)
        for (int k = 0; k < 3; k++) oracle->particles[i].potential[k] = 0;
    for (int evaluation = 1; evaluation < 8; evaluation++) {
        for (size_t i = 0; i < oracle->n; i++) find_rates(oracle, i);
        for (size_t i = 0; i < oracle->n; i++) {
            struct oracle_particle *a = &oracle->particles[i];
            for (int k = 0; k < 3; k++) a->potential[k] += a->of_one[k];
            const long double length = sqrtl(oracle_dot(a->potential, a->potential)),
                              most = 0.05L / a->width;
            for (int k = 0; length > most && k < 3; k++) a->potential[k] *= most / length;
        }
    }
}

enum status oracle_evaluate(struct oracle *oracle, struct error *error)
{
    const enum status status = find_state(oracle, error);
    if (status) return status;
    if (oracle->scheme.shifting == SHIFTING_CLOSED) find_potentials(oracle);
    for (size_t i = 0; i < oracle->n; i++) find_rates(oracle, i);
    if (oracle->scheme.viscosity == VISCOSITY_CULLEN_DEHNEN) oracle_find_switch(oracle);
    oracle_signals(oracle);
    return STATUS_OK;
}
