/* SPDX-License-Identifier: GPL-3.0-or-later
 * Moment matrices, velocity gradients, Balsara's factor and the projector of viscosity=projected.
 */
#include <math.h>

#include "oracle_parts.h"

/* Beyond this condition number in the 2-norm a matrix is not used (CONVENTIONS eq. 4.7). */
static const long double worst_condition = 1e3L;

/* Largest over smallest eigenvalue of a symmetric matrix, by Jacobi's rotations. */
static long double condition_of(int dim, struct oracle_matrix A)
{
    oracle_vector *B = A.row;
    for (int sweep = 0; sweep < 40; sweep++)
        for (int p = 0; p < dim; p++)
            for (int q = p + 1; q < dim; q++) {
                if (B[p][q] == 0) continue;
                const long double angle = atan2l(2 * B[p][q], B[q][q] - B[p][p]) / 2;
                const long double c = cosl(angle), s = sinl(angle);
                for (int k = 0; k < dim; k++) {
                    const long double kp = B[k][p], kq = B[k][q];
                    B[k][p] = c * kp - s * kq;
                    B[k][q] = s * kp + c * kq;
                }
                for (int k = 0; k < dim; k++) {
                    const long double pk = B[p][k], qk = B[q][k];
                    B[p][k] = c * pk - s * qk;
                    B[q][k] = s * pk + c * qk;
                }
                B[p][q] = B[q][p] = 0;
            }
    long double low = INFINITY, high = 0;
    for (int k = 0; k < dim; k++) {
        low = fminl(low, B[k][k]);
        high = fmaxl(high, B[k][k]);
    }
    return low > 0 ? high / low : INFINITY;
}

/* Inverse by the adjugate; rows and columns beyond dim are those of the unit matrix. */
static struct oracle_matrix invert(int dim, struct oracle_matrix A)
{
    struct oracle_matrix inverse;
    oracle_vector *T = A.row, *C = inverse.row;
    for (int k = dim; k < 3; k++) T[k][k] = 1;
    long double determinant = 0;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            const int a1 = (a + 1) % 3, a2 = (a + 2) % 3, b1 = (b + 1) % 3, b2 = (b + 2) % 3;
            C[b][a] = T[a1][b1] * T[a2][b2] - T[a1][b2] * T[a2][b1];
        }
    for (int b = 0; b < 3; b++) determinant += T[0][b] * C[b][0];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) C[a][b] = a < dim && b < dim ? C[a][b] / determinant : 0;
    return inverse;
}

/* T = sum V x x^T weight and sum V (v_j - v_i) x^T weight. */
static void moments(const struct oracle *oracle, size_t i,
                    long double (*weight)(const struct oracle *, long double, long double),
                    struct oracle_matrix *T, struct oracle_matrix *differences)
{
    const struct oracle_particle *a = &oracle->particles[i];
    *T = *differences = (struct oracle_matrix){0};
    for (size_t j = 0; j < oracle->n; j++)
        for (int k = -oracle_images(oracle); k <= oracle_images(oracle); k++) {
            const struct oracle_particle *b = &oracle->particles[j];
            oracle_vector x;
            const long double r = oracle_distance(oracle, i, j, k);
            if (r == 0 || r >= a->width) continue;
            oracle_separation(oracle, a, b, k, x);
            const long double w = b->V * weight(oracle, r, a->width);
            for (int c = 0; c < 3; c++)
                for (int e = 0; e < 3; e++) {
                    T->row[c][e] += w * x[c] * x[e];
                    differences->row[c][e] += w * (b->v[c] - a->v[c]) * x[e];
                }
        }
}

/* P = kappa M^2/tr(M^2), M = L L^T. */
static void find_projector(struct oracle_particle *a)
{
    oracle_vector M[3];
    long double trace = 0, trace_of_square = 0;
    for (int b = 0; b < 3; b++)
        for (int c = 0; c < 3; c++) M[b][c] = oracle_dot(a->L.row[b], a->L.row[c]);
    for (int b = 0; b < 3; b++) {
        trace += M[b][b];
        trace_of_square += oracle_dot(M[b], M[b]); /* M is symmetric */
    }
    a->projector = (struct oracle_matrix){0};
    if (trace == 0) return;
    const long double s = 2 * trace_of_square / (trace * trace) - 1;
    long double t = (s - 0.7L) / 0.25L;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    for (int b = 0; b < 3; b++)
        for (int c = 0; c < 3; c++)
            a->projector.row[b][c] = (3 - 2 * t) * t * t * oracle_dot(M[b], M[c]) / trace_of_square;
}

static void find_balsara(const struct oracle *oracle, struct oracle_particle *a)
{
    const long double div = fabsl(a->L.row[0][0] + a->L.row[1][1] + a->L.row[2][2]);
    const oracle_vector curl = {a->L.row[2][1] - a->L.row[1][2], a->L.row[0][2] - a->L.row[2][0],
                                a->L.row[1][0] - a->L.row[0][1]};
    const long double floor_of = oracle->scheme.balsara_floor, rate = a->c / a->width;
    a->balsara =
        (div + floor_of * rate) / (div + sqrtl(oracle_dot(curl, curl)) + (floor_of + 1e-4L) * rate);
}

long double oracle_weight(const struct oracle *oracle, long double r, long double h)
{
    return oracle->scheme.gradient == GRADIENT_CORRECTED ? -oracle_dW_dr(oracle, r, h) / r
                                                         : oracle_W(oracle, r, h);
}

/* True if the scheme needs velocity gradients. */
static bool needs_slope(const struct scheme *scheme)
{
    return scheme->balsara == BALSARA_ON || scheme->viscosity == VISCOSITY_RECONSTRUCTED ||
           scheme->viscosity == VISCOSITY_PROJECTED || scheme->viscosity == VISCOSITY_CULLEN_DEHNEN;
}

static void find_slope(const struct oracle *oracle, size_t i)
{
    struct oracle_particle *a = &oracle->particles[i];
    struct oracle_matrix T, differences;
    moments(oracle, i, oracle_W, &T, &differences);
    a->L = a->slope_C = (struct oracle_matrix){0};
    if (condition_of(oracle->dim, T) <= worst_condition) {
        a->slope_C = invert(oracle->dim, T);
        for (int b = 0; b < 3; b++) oracle_product(&a->slope_C, differences.row[b], a->L.row[b]);
    }
    find_projector(a);
    find_balsara(oracle, a);
}

/* The standard gradient's share by the linear_exact gradient of h, from the moments of W. */
static void find_steep(const struct oracle *oracle, size_t i)
{
    struct oracle_particle *a = &oracle->particles[i];
    oracle_vector rises = {0}, slope;
    for (size_t j = 0; j < oracle->n; j++)
        for (int k = -oracle_images(oracle); k <= oracle_images(oracle); k++) {
            const struct oracle_particle *b = &oracle->particles[j];
            const long double r = oracle_distance(oracle, i, j, k);
            oracle_vector x;
            if (r >= a->width) continue;
            oracle_separation(oracle, a, b, k, x);
            for (int c = 0; c < 3; c++)
                rises[c] += b->V * oracle_W(oracle, r, a->width) * (b->width - a->width) * x[c];
        }
    oracle_product(&a->C, rises, slope);
    const long double t = (sqrtl(oracle_dot(slope, slope)) - 0.05L) / 0.1L;
    a->steep = t <= 0 ? 0 : t >= 1 ? 1 : 3 * t * t - 2 * t * t * t;
}

/* -0.12 eta h c sum_j V_j C_i x weight, limited to c/10; 0 if the matrix is ill-conditioned. */
static void find_shift(const struct oracle *oracle, size_t i)
{
    struct oracle_particle *a = &oracle->particles[i];
    oracle_vector sum = {0}, of_one = {0};
    for (size_t j = 0; j < oracle->n; j++) {
        const struct oracle_particle *b = &oracle->particles[j];
        const long double r = oracle_distance(oracle, i, j, 0);
        oracle_vector x;
        if (r == 0 || r >= a->width) continue;
        oracle_separation(oracle, a, b, 0, x);
        for (int c = 0; c < 3; c++) sum[c] += b->V * oracle_weight(oracle, r, a->width) * x[c];
    }
    if (!a->ill) oracle_product(&a->C, sum, of_one);
    const long double rate = oracle->scheme.eta * a->width * a->c * 0.12L,
                      speed = rate * sqrtl(oracle_dot(of_one, of_one)),
                      factor = -rate * (speed > a->c / 10 ? a->c / 10 / speed : 1);
    for (int c = 0; c < 3; c++) a->shift[c] = factor * of_one[c];
}

static void find_matrix(const struct oracle *oracle, size_t i)
{
    struct oracle_particle *a = &oracle->particles[i];
    struct oracle_matrix T, unused;
    moments(oracle, i, oracle_weight, &T, &unused);
    a->condition = condition_of(oracle->dim, T);
    a->ill = !(a->condition <= worst_condition);
    if (!a->ill) a->C = invert(oracle->dim, T);
    if (!a->ill && oracle->scheme.gradient == GRADIENT_BLENDED) find_steep(oracle, i);
    if (oracle->scheme.shifting != SHIFTING_NONE) find_shift(oracle, i);
}

void oracle_find_matrices(struct oracle *oracle)
{
    for (size_t i = 0; i < oracle->n; i++) {
        if (needs_slope(&oracle->scheme)) find_slope(oracle, i);
        if (oracle->scheme.gradient != GRADIENT_STANDARD) find_matrix(oracle, i);
    }
}
