/* SPDX-License-Identifier: GPL-3.0-or-later
 * As reconstructed in shocks, with alpha f^2 and beta f^2 (f: Balsara factor), plus a linear term
 * that damps noise except along the local shear, CONVENTIONS eqs. 6.3 to 6.5. The linear term has
 * both signs: PI = -nu cbar e . (1 - P_ij) u_ij/rhobar, u_ij = v_ij + (L_i + L_j) x/2, e = -x/r,
 * times
 *   max(0, 1 - (v_ij . e/cbar)^2): speeds like that of sound are not noise, and damping may
 *   cool. */
#ifndef VISCOSITY_PROJECTED_H
#define VISCOSITY_PROJECTED_H

ALWAYS_INLINE struct viscosity_terms projected_viscous(const struct pair_numbers *numbers,
                                                       const struct pair_side *i,
                                                       const struct pair_side *j,
                                                       const struct viscosity_pair *pair)
{
    struct viscosity_terms terms = reconstructed_viscous(numbers, i, j, pair);
    terms.factor = pair->factor * pair->factor;
    /* m_i m_j PI/2, vanishing towards the sound speed */
    const double c_sum = i->c + j->c, rho_sum = i->rho + j->rho, half_nu = 0.5 * numbers->noise;
    const double inverse = 1 / (c_sum * rho_sum), mach = 2 * pair->closing * rho_sum * inverse;
    const double still_noise = largest(1 - mach * mach, 0);
    terms.extra = i->m * j->m * half_nu * still_noise * (c_sum * c_sum * inverse) * pair->noise;
    return terms;
}

/* A A^T. */
ALWAYS_INLINE void projected_square(int dim, const double *A, double *product)
{
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            double sum = 0;
            for (int c = 0; c < dim; c++) sum += A[a * dim + c] * A[b * dim + c];
            product[a * dim + b] = sum;
        }
}

/* P = kappa M^2/tr M^2, symmetric, with M = L L^T and kappa = smoothstep((s - 0.7)/0.25), s = 2 tr
 * M^2/(tr M)^2 - 1: 1 for simple shear, 0 for rotation. If M = 0, P = 0. */
ALWAYS_INLINE void projected_projector(int dim, const double *L, double *projector)
{
    double M[9], M2[9], trace = 0, trace2 = 0;
    projected_square(dim, L, M);
    projected_square(dim, M, M2);
    for (int a = 0; a < dim; a++) trace += M[a * dim + a], trace2 += M2[a * dim + a];
    for (int k = 0; k < 6; k++) projector[k] = 0;
    if (!(trace2 > 0)) return;
    const double s = 2 * trace2 / (trace * trace) - 1;
    const double t = least(1, largest(0, (s - 0.7) / 0.25)), kappa = t * t * (3 - 2 * t);
    int k = 0;
    for (int a = 0; a < dim; a++)
        for (int b = a; b < dim; b++) projector[k++] = kappa * M2[a * dim + b] / trace2;
}

#endif
VISCOSITY(projected,
          .member = {"projected",
                     "reconstructed in shocks; noise damped, but not along the local shear", ""},
          .least_dim = 2, .parameters = "alpha beta noise viscosity_form balsara", .midpoint = true,
          .noise = true,
          .defaults = {VOLUME_NUMBER, BALSARA_ON, VISCOSITY_FORM_SIGNAL, PAIR_WIDTH_MEAN})
