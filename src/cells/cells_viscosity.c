/* SPDX-License-Identifier: GPL-3.0-or-later
 * What dissipates in 2D and 3D: artificial viscosity and conductivity of the pairs of one particle.
 * Closing speeds, slopes and gradients are there. */
#include <math.h>

#include "sides.h"
#include "stamp.h"

/* x . L x/r^2 for the particle's own L, and for the neighbours'. */
ALWAYS_INLINE void slopes_body(int dim, int count, const struct lanes *lanes, const double *own,
                               const double *theirs)
{
    const ptrdiff_t stride = lanes->stride;
    const double *restrict x = lane(lanes, LANE_DX),
                           *restrict r_inverse = lane(lanes, LANE_R_INVERSE), *restrict L = theirs;
    double *restrict slope_i = lane(lanes, LANE_SLOPE_I), *restrict slope_j =
                                                              lane(lanes, LANE_SLOPE_J);
#pragma omp simd
    for (int k = 0; k < count; k++) {
        double e[3] = {0}, mine = 0, other = 0;
        for (int a = 0; a < dim; a++) e[a] = x[a * stride + k] * r_inverse[k];
        for (int a = 0; a < dim; a++)
            for (int b = 0; b < dim; b++) {
                const double ee = e[a] * e[b];
                mine += own[a * dim + b] * ee;
                other += L[(a * dim + b) * stride + k] * ee;
            }
        slope_i[k] = mine;
        slope_j[k] = other;
    }
}

CLONES static void slopes_along(int dim, int count, const struct lanes *lanes, const double *own,
                                const double *theirs)
{
    if (dim == 2)
        slopes_body(2, count, lanes, own, theirs);
    else
        slopes_body(3, count, lanes, own, theirs);
}

/* K, what viscosity adds to a_i and a_j alike, for G = 1. */
ALWAYS_INLINE void viscous_body(enum viscosity viscosity, bool signal_form, int count,
                                const struct pair_numbers *numbers, const struct sides *sides,
                                const struct lanes *lanes)
{
    const struct pair_numbers n = *numbers;
    const double own_m = sides->own.m, own_h = sides->own.h, own_h_inverse = sides->own.h_inverse,
                 own_c = sides->own.c, own_rho = sides->own.rho, own_alpha = sides->own.alpha;
    const double *restrict m = sides->m, *restrict h = sides->h,
                           *restrict h_inverse = sides->h_inverse, *restrict c = sides->c,
                           *restrict rho = sides->rho, *restrict alpha = sides->alpha,
                           *restrict slope_i = lane(lanes, LANE_SLOPE_I),
                           *restrict slope_j = lane(lanes, LANE_SLOPE_J),
                           *restrict r = lane(lanes, LANE_R),
                           *restrict closing = lane(lanes, LANE_CLOSING);
    const bool varying = viscosity == VISCOSITY_TIME_DEPENDENT;
    const bool sloped = viscosity == VISCOSITY_RECONSTRUCTED;
    double *restrict K = lane(lanes, LANE_K);
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const struct pair_side i = {.m = own_m,
                                    .h = own_h,
                                    .h_inverse = own_h_inverse,
                                    .c = own_c,
                                    .rho = own_rho,
                                    .alpha = own_alpha,
                                    .slope = sloped ? slope_i[k] : 0};
        const struct pair_side j = {.m = m[k],
                                    .h = h[k],
                                    .h_inverse = h_inverse[k],
                                    .c = c[k],
                                    .rho = rho[k],
                                    .alpha = varying ? alpha[k] : 0,
                                    .slope = sloped ? slope_j[k] : 0};
        K[k] = signal_form ? pair_viscous_signal(viscosity, &n, &i, &j, r[k], closing[k], 1)
                           : pair_viscous(viscosity, &n, &i, &j, r[k], closing[k], 1);
    }
}

/* Times the mean Balsara factor of the pair, or its square. */
CLONES static void limit_viscosity(int count, bool squared, double own,
                                   const double *restrict theirs, double *restrict K)
{
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const double f = 0.5 * (own + theirs[k]);
        K[k] *= squared ? f * f : f;
    }
}

#define VISCOUS_CASE(symbol, name, label, paper, signal_form)                                      \
    case symbol:                                                                                   \
        viscous_body(symbol, signal_form, count, numbers, sides, lanes);                           \
        break;

#define VISCOUS(name, signal_form)                                                                 \
    CLONES static void name(enum viscosity viscosity, int count,                                   \
                            const struct pair_numbers *numbers, const struct sides *sides,         \
                            const struct lanes *lanes)                                             \
    {                                                                                              \
        switch (viscosity) {                                                                       \
            VISCOSITY_LINE_LIST(VISCOUS_CASE, signal_form)                                         \
        case VISCOSITY_CULLEN_DEHNEN: /* comes as time_dependent */                                \
        case VISCOSITY_PROJECTED:     /* comes as reconstructed */                                 \
            break;                                                                                 \
        }                                                                                          \
    }
VISCOUS(viscous_mu, false)
VISCOUS(viscous_signal, true)

/* minus v_ij . G, which heats where it is positive: v_ij . Gbar. */
CLONES static void find_approach(int dim, int count, const struct lanes *lanes, const double *v,
                                 const double *theirs, double *restrict approach)
{
    const ptrdiff_t stride = lanes->stride;
    const double *restrict G = lane(lanes, LANE_GX), *restrict w = theirs;
    const double v0 = v[0], v1 = v[1], v2 = v[2];
    const ptrdiff_t third = dim == 3 ? 2 * stride : 0;
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const double plane = (w[k] - v0) * G[k] + (w[stride + k] - v1) * G[stride + k];
        approach[k] = dim == 3 ? plane + (w[third + k] - v2) * G[third + k] : plane;
    }
}

/* Viscosity that would cool is left out: with a matrix a pair may approach against its gradient. */
CLONES static void never_cool(int count, const double *restrict approach, double *restrict K)
{
#pragma omp simd
    for (int k = 0; k < count; k++) K[k] = approach[k] > 0 ? K[k] : 0;
}

/* The linear term of viscosity=projected, of both signs (CONVENTIONS, projected):
 * PI = -nu cbar e . (1 - P_ij) u_ij/rhobar, u_ij = v_ij + (L_i + L_j) x/2, e = -x/r, times
 * 1 - (v_ij . e/cbar)^2 or 0: what is as fast as sound is no noise, and to damp it may cool. */
/* One axis of x . (1 - P_ij) (v_ij + (L_i + L_j) x/2), neighbour k. */
ALWAYS_INLINE double noise_along(int dim, int a, ptrdiff_t stride, ptrdiff_t k,
                                 const double *restrict x, const double *const own[3],
                                 const double *restrict v, const double *restrict L,
                                 const double *restrict P)
{
    double u = 0, e = 0;
    for (int b = 0; b < dim; b++) {
        const double xb = x[b * stride + k];
        const int ab = symmetric_at(dim, a, b);
        u += (own[1][a * dim + b] + L[(a * dim + b) * stride + k]) * xb;
        e += (own[2][ab] + P[ab * stride + k]) * xb;
    }
    return (x[a * stride + k] - 0.5 * e) * ((own[0][a] - v[a * stride + k]) + 0.5 * u);
}

ALWAYS_INLINE void noise_body(int dim, int count, double nu, const struct sides *sides,
                              const struct lanes *lanes, const double *const own[3],
                              const double *const theirs[3])
{
    const ptrdiff_t stride = lanes->stride;
    const double *restrict x = lane(lanes, LANE_DX),
                           *restrict r_inverse = lane(lanes, LANE_R_INVERSE),
                           *restrict v = theirs[0], *restrict L = theirs[1],
                           *restrict P = theirs[2];
    const double *restrict m = sides->m, *restrict c = sides->c, *restrict rho = sides->rho;
    const double *restrict closing = lane(lanes, LANE_CLOSING);
    double *restrict K = lane(lanes, LANE_K);
    const double own_m = sides->own.m, own_c = sides->own.c, own_rho = sides->own.rho;
#pragma omp simd
    for (int k = 0; k < count; k++) {
        double s = noise_along(dim, 0, stride, k, x, own, v, L, P) +
                   noise_along(dim, 1, stride, k, x, own, v, L, P);
        if (dim == 3) s += noise_along(dim, 2, stride, k, x, own, v, L, P);
        /* K = m_i m_j PI/2, and e . (1 - P) u = -s/r; fading towards the speed of sound */
        const double mach = 2 * closing[k] / (own_c + c[k]);
        const double still_noise = largest(1 - mach * mach, 0);
        K[k] += own_m * m[k] * (0.5 * nu) * still_noise * (own_c + c[k]) * (s * r_inverse[k]) /
                (own_rho + rho[k]);
    }
}

CLONES static void project_noise(int dim, int count, double nu, const struct sides *sides,
                                 const struct lanes *lanes, const double *const own[3],
                                 const double *const theirs[3])
{
    if (dim == 2)
        noise_body(2, count, nu, sides, lanes, own, theirs);
    else
        noise_body(3, count, nu, sides, lanes, own, theirs);
}

/* Conductivity (Price 2008), into heat: sum_j m_i m_j alpha_u v_u (u_i - u_j)/rhobar e_ij . Gbar.
 */
CLONES static double conducted(int dim, int count, double alpha_u, const struct sides *sides,
                               const struct lanes *lanes, double own_u, const double *restrict u)
{
    const ptrdiff_t stride = lanes->stride;
    const double *x = lane(lanes, LANE_DX),
                 *G = lane(lanes, LANE_GX), *restrict r_inverse = lane(lanes, LANE_R_INVERSE);
    const double *restrict m = sides->m, *restrict rho = sides->rho, *restrict P = sides->P;
    const double own_m = sides->own.m, own_P = sides->own.P, own_rho = sides->own.rho;
    double *restrict s = lane(lanes, LANE_SPARE);
    for (int k = 0; k < count; k++) s[k] = 0;
    for (int a = 0; a < dim; a++) {
        const double *restrict xa = x + a * stride, *restrict Ga = G + a * stride;
#pragma omp simd
        for (int k = 0; k < count; k++) s[k] += xa[k] * Ga[k];
    }
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const double rho_bar = 0.5 * (own_rho + rho[k]);
        const double speed = sqrt(fabs(own_P - P[k]) / rho_bar);
        const double along_pair = least(s[k] * r_inverse[k], 0);
        s[k] = own_m * m[k] * alpha_u * speed * (own_u - u[k]) / rho_bar * along_pair;
    }
    return lanes_sum(s, count);
}

double cells_conduction(const struct cells *cells, int count, const struct sides *sides,
                        const struct lanes *lanes, double own_u, const double *u)
{
    return conducted(cells->method.box.dim, count, cells->method.conductivity, sides, lanes, own_u,
                     u);
}

void cells_viscosity(const struct cells *cells, int count, const struct lanes *lanes,
                     const struct sides *sides, const double *record)
{
    const struct cells_method *method = &cells->method;
    const struct lanes_layout *layout = &cells->force;
    const int dim = method->box.dim;
    double *K = lane(lanes, LANE_K);
    if (method->viscosity == VISCOSITY_NONE) {
        for (int k = 0; k < count; k++) K[k] = 0;
        return;
    }
    if (method->viscosity == VISCOSITY_RECONSTRUCTED)
        slopes_along(dim, count, lanes, record + layout->offset[GROUP_SLOPE],
                     lane_of(lanes, layout, GROUP_SLOPE, 0));
    (method->signal_form ? viscous_signal : viscous_mu)(method->viscosity, count, &method->numbers,
                                                        sides, lanes);
    if (method->balsara)
        limit_viscosity(count, method->projected, sides->own_balsara, sides->balsara, K);
    if (method->viscosity == VISCOSITY_RECONSTRUCTED) {
        double *approach = lane(lanes, LANE_SPARE);
        find_approach(dim, count, lanes, record + layout->offset[GROUP_MOTION],
                      lane_of(lanes, layout, GROUP_MOTION, 0), approach);
        never_cool(count, approach, K);
    }
    if (method->projected)
        project_noise(dim, count, method->noise, sides, lanes,
                      (const double *const[3]){record + layout->offset[GROUP_MOTION],
                                               record + layout->offset[GROUP_SLOPE],
                                               record + layout->offset[GROUP_PROJECTOR]},
                      (const double *const[3]){lane_of(lanes, layout, GROUP_MOTION, 0),
                                               lane_of(lanes, layout, GROUP_SLOPE, 0),
                                               lane_of(lanes, layout, GROUP_PROJECTOR, 0)});
}

/* sum_j V_j v_ij . G, which is div v of CONVENTIONS with the pair gradient. */
double cells_divergence(int dim, int count, const struct lanes *lanes, const struct sides *sides,
                        const double *v, const double *theirs)
{
    double *approach = lane(lanes, LANE_SPARE);
    find_approach(dim, count, lanes, v, theirs, approach);
    return -lanes_dot(sides->V, approach, count);
}
