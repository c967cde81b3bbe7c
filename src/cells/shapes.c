/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shapes.h"

#include <math.h>

#include "family_names.h"
#include "specialise.h"

/* One loop over q. */
#define LOOP(function, shape, dim, attributes)                                                     \
    attributes static void function(const struct kernel *kernel, size_t n,                         \
                                    const double *restrict q, double *restrict value)              \
    {                                                                                              \
        _Pragma("omp simd") for (size_t i = 0; i < n; i++) value[i] = shape(kernel, q[i], dim);    \
    }

#define SUMS(function, w, dw, dim, attributes)                                                     \
    attributes static void function(const struct kernel *kernel, size_t n,                         \
                                    const double *restrict r, double h_inverse,                    \
                                    const double *restrict m, double sums[2])                      \
    {                                                                                              \
        double value[8] = {0}, slope[8] = {0};                                                     \
        for (size_t k = 0; k < n; k += 8) SIMD_LANES for (size_t l = 0; l < 8; l++)                \
            {                                                                                      \
                const double q = r[k + l] * h_inverse, shape = w(kernel, q, dim);                  \
                value[l] += m[k + l] * shape;                                                      \
                slope[l] += m[k + l] * (dim * shape + q * dw(kernel, q, dim));                     \
            }                                                                                      \
        sums[0] = TREE(value);                                                                     \
        sums[1] = TREE(slope);                                                                     \
    }

#define WEIGHTS(function, shape, dim, attributes)                                                  \
    attributes static void function(                                                               \
        const struct kernel *kernel, size_t n, const double *restrict r, double h_inverse,         \
        const double *restrict V, double *restrict w, double *restrict weight)                     \
    {                                                                                              \
        _Pragma("omp simd") for (size_t i = 0; i < (n & ~(size_t)7); i++)                          \
        {                                                                                          \
            w[i] = shape(kernel, r[i] * h_inverse, dim);                                           \
            weight[i] = V[i] * w[i];                                                               \
        }                                                                                          \
    }

#define PAIR(function, shape, dim, attributes)                                                     \
    attributes static void function(                                                               \
        const struct kernel *kernel, size_t n, const double *restrict r, double h_inverse,         \
        const double *restrict others, double *restrict value, double *restrict value_j)           \
    {                                                                                              \
        _Pragma("omp simd") for (size_t i = 0; i < (n & ~(size_t)7); i++)                          \
        {                                                                                          \
            value[i] = shape(kernel, r[i] * h_inverse, dim);                                       \
            value_j[i] = shape(kernel, r[i] * others[i], dim);                                     \
        }                                                                                          \
    }

#define BODIES(name, w, dw, dim, attributes)                                                       \
    LOOP(name##_w_##dim, w, dim, attributes)                                                       \
    LOOP(name##_dw_##dim, dw, dim, attributes)                                                     \
    SUMS(name##_sums_##dim, w, dw, dim, attributes)                                                \
    WEIGHTS(name##_weights_##dim, w, dim, attributes)                                              \
    PAIR(name##_pair_w_##dim, w, dim, attributes)                                                  \
    PAIR(name##_pair_dw_##dim, dw, dim, attributes)

#define LOOPS_OF(name, dim)                                                                        \
    {                                                                                              \
        name##_w_##dim, name##_dw_##dim, name##_sums_##dim, name##_weights_##dim,                  \
            name##_pair_w_##dim, name##_pair_dw_##dim                                              \
    }

/* In 1D only the operators on clouds use these loops. */
#define LOOPS(name)                                                                                \
    {                                                                                              \
        {name##_w_1, name##_dw_1, NULL, NULL, NULL, NULL}, LOOPS_OF(name, 2), LOOPS_OF(name, 3)    \
    }

#define ALL_BODIES(name, w, dw, attributes)                                                        \
    LOOP(name##_w_1, w, 1, attributes)                                                             \
    LOOP(name##_dw_1, dw, 1, attributes)                                                           \
    BODIES(name, w, dw, 2, attributes)                                                             \
    BODIES(name, w, dw, 3, attributes)

#ifdef KERNEL_FILE

#define KERNEL(name, ...)                                                                          \
    ALL_BODIES(name, name##_w, name##_dw, CLONES)                                                  \
    const struct shapes shapes_##name[KERNEL_DIM_MAX] = LOOPS(name);
#include KERNEL_FILE

#else

ALL_BODIES(any, kernel->w, kernel->dw, )

static const struct shapes any[KERNEL_DIM_MAX] = LOOPS(any);

#define DECLARE(name) extern const struct shapes shapes_##name[KERNEL_DIM_MAX];
KERNEL_NAMES(DECLARE)
#define TABLE(name)   shapes_##name,
static const struct shapes *const specialisations[] = {KERNEL_NAMES(TABLE)};

struct shapes shapes_of(const struct kernel *kernel, int dim, bool specialised)
{
    const int specialisation = specialised ? kernel_specialisation(kernel) : -1;
    return specialisation < 0 ? any[dim - 1] : specialisations[specialisation][dim - 1];
}

#endif
