/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shapes.h"

#include <math.h>

#include "kernel_names.h"
#include "stamp.h"

#define BODY(function, shape, dim, attributes)                                                     \
    attributes static void function(const struct kernel *kernel, size_t n,                         \
                                    const double *restrict q, double *restrict value)              \
    {                                                                                              \
        _Pragma("omp simd") for (size_t i = 0; i < n; i++) value[i] = shape(kernel, q[i], dim);    \
    }

#define LOOPS(name)                                                                                \
    {                                                                                              \
        {name##_w_1, name##_dw_1}, {name##_w_2, name##_dw_2},                                      \
        {                                                                                          \
            name##_w_3, name##_dw_3                                                                \
        }                                                                                          \
    }

#ifdef KERNEL_FILE

#define KERNEL(name, ...)                                                                          \
    BODY(name##_w_1, name##_w, 1, CLONES)                                                          \
    BODY(name##_w_2, name##_w, 2, CLONES)                                                          \
    BODY(name##_w_3, name##_w, 3, CLONES)                                                          \
    BODY(name##_dw_1, name##_dw, 1, CLONES)                                                        \
    BODY(name##_dw_2, name##_dw, 2, CLONES)                                                        \
    BODY(name##_dw_3, name##_dw, 3, CLONES)                                                        \
    const struct shapes shapes_##name[KERNEL_DIM_MAX] = LOOPS(name);
#include KERNEL_FILE

#else

BODY(any_w_1, kernel->w, 1, )
BODY(any_w_2, kernel->w, 2, )
BODY(any_w_3, kernel->w, 3, )
BODY(any_dw_1, kernel->dw, 1, )
BODY(any_dw_2, kernel->dw, 2, )
BODY(any_dw_3, kernel->dw, 3, )

static const struct shapes any[KERNEL_DIM_MAX] = LOOPS(any);

#define DECLARE(name) extern const struct shapes shapes_##name[KERNEL_DIM_MAX];
KERNEL_NAMES(DECLARE)
#define TABLE(name)   shapes_##name,
static const struct shapes *const stamps[] = {KERNEL_NAMES(TABLE)};

struct shapes shapes_of(const struct kernel *kernel, int dim, bool stamped)
{
    const int stamp = stamped ? kernel_stamp(kernel) : -1;
    return stamp < 0 ? any[dim - 1] : stamps[stamp][dim - 1];
}

#endif
