/* SPDX-License-Identifier: GPL-3.0-or-later
 * The terms of one pair: x = r_b - r_a, e = -x/r from b to a, and gradients with respect to r_a. */
#include <math.h>
#include <string.h>

#include "oracle_parts.h"

/* grad_i W(r_ij, h), or C x times the weight, where C belongs to the width h. */
static void gradient(const struct oracle *oracle, bool standard, const oracle_vector x,
                     long double h, const struct oracle_matrix *C, oracle_vector G)
{
    const long double r = sqrtl(oracle_dot(x, x));
    memset(G, 0, sizeof(oracle_vector));
    if (r == 0) return;
    if (!standard) oracle_product(C, x, G);
    for (int k = 0; k < 3; k++)
        G[k] =
            standard ? -x[k] / r * oracle_dW_dr(oracle, r, h) : G[k] * oracle_weight(oracle, r, h);
}

/* The gradients at both widths and their mean. */
struct gradients {
    oracle_vector i, j, mean;
};

/* One gradient of the pair at width h. By matrix: moments without the factors C/h^d (corrected:
 * C/h^(d+2)) of either particle's own width are averaged, so that h alone is the shape's width. */
static void single_gradient(const struct oracle *oracle, bool standard,
                            const struct oracle_particle *a, const struct oracle_particle *b,
                            const oracle_vector x, long double h, oracle_vector G)
{
    const int power = oracle->dim + (oracle->scheme.gradient == GRADIENT_CORRECTED ? 2 : 0);
    struct oracle_matrix C;
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            C.row[k][l] = (a->C.row[k][l] * powl(h / a->width, power) +
                           b->C.row[k][l] * powl(h / b->width, power)) /
                          2;
    gradient(oracle, standard, x, h, &C, G);
}

static void find_either(const struct oracle *oracle, bool standard, const struct oracle_particle *a,
                        const struct oracle_particle *b, const oracle_vector x, struct gradients *G)
{
    const long double harmonic = 2 * a->width * b->width / (a->width + b->width);
    gradient(oracle, standard, x, a->width, &a->C, G->i);
    gradient(oracle, standard, x, b->width, &b->C, G->j);
    switch (oracle->scheme.pair_width) {
    case PAIR_WIDTH_MEAN:
        for (int k = 0; k < 3; k++) G->mean[k] = (G->i[k] + G->j[k]) / 2;
        break;
    case PAIR_WIDTH_MAX:
        single_gradient(oracle, standard, a, b, x, fmaxl(a->width, b->width), G->mean);
        break;
    case PAIR_WIDTH_HARMONIC:
        single_gradient(oracle, standard, a, b, x, harmonic, G->mean);
        break;
    }
}

static void find_gradients(const struct oracle *oracle, const struct oracle_particle *a,
                           const struct oracle_particle *b, const oracle_vector x,
                           struct gradients *G)
{
    const enum gradient gradient = oracle->scheme.gradient;
    const bool standard = gradient == GRADIENT_STANDARD || a->ill || b->ill;
    struct gradients other;
    find_either(oracle, standard, a, b, x, G);
    if (standard || gradient != GRADIENT_BLENDED) return;
    find_either(oracle, true, a, b, x, &other);
    const long double share = (a->steep + b->steep) / 2;
    for (int k = 0; k < 3; k++) {
        G->i[k] = (1 - share) * G->i[k] + share * other.i[k];
        G->j[k] = (1 - share) * G->j[k] + share * other.j[k];
        G->mean[k] = (1 - share) * G->mean[k] + share * other.mean[k];
    }
}

/* phi of the reconstruction (Rosswog 2020). */
static long double limiter(const struct oracle *oracle, const struct oracle_particle *a,
                           const struct oracle_particle *b, long double slope_a,
                           long double slope_b, long double r)
{
    const long double sum = slope_a + slope_b, q = r / fmaxl(a->width, b->width),
                      near = 1 / (long double)oracle->scheme.eta;
    long double phi = sum == 0 ? 0 : 4 * slope_a * slope_b / (sum * sum);
    phi = phi < 0 ? 0 : phi > 1 ? 1 : phi;
    return q < near ? phi * expl(-((q - near) / 0.2L) * ((q - near) / 0.2L)) : phi;
}

/* v_ij . e_ij in the viscosity, from velocities reconstructed at the midpoint if the viscosity does
 * so; 0 for pairs without viscosity. */
static long double closing_speed(const struct oracle *oracle, const struct oracle_particle *a,
                                 const struct oracle_particle *b, const oracle_vector x,
                                 const oracle_vector v_ij, const struct gradients *G)
{
    const enum viscosity viscosity = oracle->scheme.viscosity;
    const long double r = sqrtl(oracle_dot(x, x));
    if (r == 0) return 0;
    const long double w = -oracle_dot(v_ij, x) / r;
    if (w >= 0) return 0;
    if (viscosity != VISCOSITY_RECONSTRUCTED && viscosity != VISCOSITY_PROJECTED) return w;
    if (oracle_dot(v_ij, G->mean) <= 0) return 0; /* viscosity would cool the pair */
    oracle_vector step_a, step_b, at_midpoint;
    oracle_product(&a->L, x, step_a);
    oracle_product(&b->L, x, step_b);
    const long double phi = limiter(oracle, a, b, oracle_dot(x, step_a), oracle_dot(x, step_b), r);
    for (int k = 0; k < 3; k++) at_midpoint[k] = v_ij[k] + phi / 2 * (step_a[k] + step_b[k]);
    return fminl(0, -oracle_dot(at_midpoint, x) / r);
}

/* The h of the viscosity: in 1D that of the last density sum. */
static long double viscous_width(const struct oracle *oracle, const struct oracle_particle *a)
{
    return oracle->dim == 1 ? a->h : a->width;
}

static long double shock_pressure(const struct oracle *oracle, const struct oracle_particle *a,
                                  const struct oracle_particle *b, long double r, long double w)
{
    const struct scheme *scheme = &oracle->scheme;
    const bool projected = scheme->viscosity == VISCOSITY_PROJECTED,
               switched = scheme->viscosity == VISCOSITY_TIME_DEPENDENT ||
                          scheme->viscosity == VISCOSITY_CULLEN_DEHNEN;
    const long double rho = (a->rho + b->rho) / 2, alpha = (a->alpha + b->alpha) / 2;
    const long double beta =
        switched ? alpha * ((long double)scheme->beta / scheme->alpha) : (long double)scheme->beta;
    long double c = (a->c + b->c) / 2, f = 1;
    /* fading: no more than 100 times the speed at which the pair closes */
    if (scheme->viscosity == VISCOSITY_FADING) c = fminl(c, 100 * -w);
    if (scheme->balsara == BALSARA_ON) f = (a->balsara + b->balsara) / 2;
    if (projected) f *= f;
    if (projected || scheme->viscosity_form == VISCOSITY_FORM_SIGNAL)
        return -f * (alpha * c - beta / 2 * w) * w / rho;
    const long double h = (viscous_width(oracle, a) + viscous_width(oracle, b)) / 4;
    const long double mu = h * w * r / (r * r + 0.01L * h * h);
    return f * (-alpha * c * mu + beta * mu * mu) / rho;
}

/* PI_n = -nu (1 - M^2) cbar e . (1 - P_ij) u_ij/rhobar, u_ij = v_ij - (L_i + L_j) r_ij/2, r_ij =
 * -x; 0 where the Mach number M of the pair is 1 or more. */
static long double noise_pressure(const struct oracle *oracle, const struct oracle_particle *a,
                                  const struct oracle_particle *b, const oracle_vector x,
                                  const oracle_vector v_ij)
{
    const long double r = sqrtl(oracle_dot(x, x));
    oracle_vector step_a, step_b, u, Pu_a, Pu_b;
    if (r == 0) return 0;
    oracle_product(&a->L, x, step_a);
    oracle_product(&b->L, x, step_b);
    for (int k = 0; k < 3; k++) u[k] = v_ij[k] + (step_a[k] + step_b[k]) / 2;
    oracle_product(&a->projector, u, Pu_a);
    oracle_product(&b->projector, u, Pu_b);
    for (int k = 0; k < 3; k++) u[k] -= (Pu_a[k] + Pu_b[k]) / 2;
    const long double mach = oracle_dot(x, v_ij) / r / ((a->c + b->c) / 2);
    if (fabsl(mach) >= 1) return 0;
    return (1 - mach * mach) * oracle->scheme.noise * (a->c + b->c) * oracle_dot(x, u) / r /
           (a->rho + b->rho);
}

/* The grad-h factor of particle a in its pair with b. */
static long double grad_h_factor(const struct oracle *oracle, const struct oracle_particle *a,
                                 const struct oracle_particle *b)
{
    if (oracle->without_grad_h) return 1;
    if (oracle->scheme.volume_element != VOLUME_ENERGY) return 1 / (1 + a->grad_h_rho);
    return 1 - b->m / b->U * a->grad_h_y / (1 + a->grad_h_rho);
}

static void add_pressure(const struct oracle *oracle, struct oracle_particle *a,
                         const struct oracle_particle *b, const oracle_vector v_ij,
                         const struct gradients *G)
{
    const long double ZZ = oracle_Z(oracle, a) * oracle_Z(oracle, b);
    if (oracle->scheme.formulation == FORMULATION_VANILLA_ICE) {
        for (int k = 0; k < 3; k++) a->F[k] -= ZZ * (a->P + b->P) / (a->y * b->y) * G->mean[k];
        a->dU += a->P * ZZ / (a->y * b->y) * oracle_dot(v_ij, G->mean);
        return;
    }
    const long double from_a = ZZ * grad_h_factor(oracle, a, b) * a->P / (a->y * a->y);
    const long double from_b = ZZ * grad_h_factor(oracle, b, a) * b->P / (b->y * b->y);
    for (int k = 0; k < 3; k++) a->F[k] -= from_a * G->i[k] + from_b * G->j[k];
    a->dU += from_a * oracle_dot(v_ij, G->i);
}

/* Conductivity, CONVENTIONS eq. 6.8. */
static long double conducted(const struct oracle *oracle, const struct oracle_particle *a,
                             const struct oracle_particle *b, const oracle_vector x,
                             const struct gradients *G)
{
    const long double r = sqrtl(oracle_dot(x, x)), rho = (a->rho + b->rho) / 2;
    const long double along = r > 0 ? -oracle_dot(x, G->mean) / r : 0;
    if (along >= 0) return 0;
    const long double jump = fabsl(a->P - b->P), sum = fabsl(a->P) + fabsl(b->P),
                      relative = sum > 0 ? jump / sum : 0,
                      strength =
                          oracle->scheme.alpha_u + oracle->scheme.shock_conductivity *
                                                       fminl(1, fmaxl(0, (5 * relative - 1) / 2));
    return a->m * b->m * strength * sqrtl(jump / rho) * (a->U / a->m - b->U / b->m) / rho * along;
}

/* Closes the gradient by the difference of the potentials, and adds to the gradient of 1. */
static void close_gradient(const struct oracle *oracle, struct oracle_particle *a,
                           const struct oracle_particle *b, const oracle_vector x,
                           struct gradients *G)
{
    const long double weight = oracle_dot(x, G->mean) / oracle->dim;
    for (int k = 0; k < 3; k++) {
        G->mean[k] -= weight * (a->potential[k] - b->potential[k]);
        a->of_one[k] += b->V * G->mean[k];
    }
}

/* Exchange by the volume that shifting sweeps over: density and specific energy are the donor's,
 * momentum has the mean velocity, and kinetic energy is such that none becomes heat. */
static void add_exchange(struct oracle_particle *a, const struct oracle_particle *b,
                         const struct gradients *G)
{
    long double swept = 0;
    for (int k = 0; k < 3; k++)
        swept += 2 * a->V * b->V * G->mean[k] * (a->shift[k] + b->shift[k]) / 2;
    const struct oracle_particle *donor = swept > 0 ? b : a;
    const long double mass = swept * donor->rho;
    a->dm += mass;
    for (int k = 0; k < 3; k++) a->dp_shift[k] += mass * (a->v[k] + b->v[k]) / 2;
    a->de_shift += mass * (donor->U / donor->m + oracle_dot(a->v, b->v) / 2);
}

void oracle_add_pair(const struct oracle *oracle, struct oracle_particle *a,
                     const struct oracle_particle *b, const oracle_vector x)
{
    const struct scheme *scheme = &oracle->scheme;
    const oracle_vector v_ij = {a->v[0] - b->v[0], a->v[1] - b->v[1], a->v[2] - b->v[2]};
    struct gradients G;
    find_gradients(oracle, a, b, x, &G);
    if (scheme->shifting == SHIFTING_CLOSED) close_gradient(oracle, a, b, x, &G);
    add_pressure(oracle, a, b, v_ij, &G);
    a->div_v -= b->V * oracle_dot(v_ij, G.mean);
    if (scheme->shifting != SHIFTING_NONE) add_exchange(a, b, &G);
    if (scheme_conducts(scheme)) a->dU += conducted(oracle, a, b, x, &G);
    if (scheme->viscosity == VISCOSITY_NONE) return;
    const long double r = sqrtl(oracle_dot(x, x)), w = closing_speed(oracle, a, b, x, v_ij, &G);
    long double PI = w < 0 ? shock_pressure(oracle, a, b, r, w) : 0;
    if (scheme->viscosity == VISCOSITY_PROJECTED) PI += noise_pressure(oracle, a, b, x, v_ij);
    for (int k = 0; k < 3; k++) a->F[k] -= a->m * b->m * PI * G.mean[k];
    a->dU += a->m * b->m * PI * oracle_dot(v_ij, G.mean) / 2;
}
