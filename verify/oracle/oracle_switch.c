/* SPDX-License-Identifier: GPL-3.0-or-later
 * The oracle's switch of Cullen & Dehnen 2010: CONVENTIONS eqs. 6.6 and 6.7. */
#include <math.h>

#include "oracle_parts.h"

static long double trace(const struct oracle_matrix *A)
{
    return A->row[0][0] + A->row[1][1] + A->row[2][2];
}

/* Sums over a particle's neighbours and itself. */
struct switch_sums {
    long double R, div_a, v_sig;
};

static void add_neighbour(const struct oracle *oracle, const struct oracle_particle *a,
                          const struct oracle_particle *b, const oracle_vector x, long double r,
                          struct switch_sums *sums)
{
    const long double W = r < a->width ? oracle_W(oracle, r, a->width) : 0, D = trace(&b->L);
    oracle_vector Cx;
    sums->R += (D > 0 ? b->m : D < 0 ? -b->m : 0) * W / a->rho;
    oracle_product(&a->slope_C, x, Cx);
    for (int k = 0; k < 3; k++) sums->div_a += b->V * (b->F[k] / b->m - a->F[k] / a->m) * Cx[k] * W;
    if (!(r < fmaxl(a->width, b->width))) return;
    long double w = 0; /* v_ij . e_ij, e_ij = -x/r */
    for (int k = 0; k < 3 && r > 0; k++) w -= (a->v[k] - b->v[k]) * x[k] / r;
    sums->v_sig = fmaxl(sums->v_sig, (a->c + b->c) / 2 - fminl(w, 0));
}

void oracle_find_switch(struct oracle *oracle)
{
    const int dim = oracle->dim;
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        struct switch_sums sums = {0};
        for (size_t j = 0; j < oracle->n; j++)
            for (int k = -oracle_images(oracle); k <= oracle_images(oracle); k++) {
                const struct oracle_particle *b = &oracle->particles[j];
                oracle_vector x;
                const long double r = oracle_separation(oracle, a, b, k, x);
                add_neighbour(oracle, a, b, x, r, &sums);
            }
        const long double D = trace(&a->L);
        long double square = 0, change = sums.div_a; /* d(div v)/dt = div a - tr(L L) */
        for (int b = 0; b < dim; b++)
            for (int c = 0; c < dim; c++) {
                const long double S =
                    (a->L.row[b][c] + a->L.row[c][b]) / 2 - (b == c ? D / dim : 0);
                square += S * S;
                change -= a->L.row[b][c] * a->L.row[c][b];
            }
        const long double t = 2 * powl(1 - sums.R, 4) * D,
                          xi = t * t > 0 ? t * t / (t * t + square) : 0;
        const long double A = xi * fmaxl(0, -change), rate = sums.v_sig / a->width;
        a->alpha_local =
            fmaxl(oracle->scheme.alpha_max * A / (A + rate * rate), oracle->scheme.alpha_min);
        a->decay = 2 * 0.05L * rate;
    }
}

/* alpha rises at once and decays at the rate 1/tau, by an implicit step. */
void oracle_apply_switch(struct oracle *oracle, long double dt)
{
    for (size_t i = 0; i < oracle->n; i++) {
        struct oracle_particle *a = &oracle->particles[i];
        a->alpha = a->alpha < a->alpha_local
                       ? a->alpha_local
                       : (a->alpha + dt * a->decay * a->alpha_local) / (1 + dt * a->decay);
    }
}
