/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernel_loop.h"

#include <math.h>

#include "loop.h"

#define BODY(function, shape, dim, attributes)                                                     \
    attributes static void function(const struct kernel *kernel, size_t n,                         \
                                    const double *restrict q, double *restrict value)              \
    {                                                                                              \
        _Pragma("omp simd") for (size_t i = 0; i < n; i++) value[i] = shape(kernel, q[i], dim);    \
    }

#define KERNEL(name, ...)                                                                          \
    BODY(name##_w_1, name##_w, 1, CLONES)                                                          \
    BODY(name##_w_2, name##_w, 2, CLONES)                                                          \
    BODY(name##_w_3, name##_w, 3, CLONES)                                                          \
    BODY(name##_dw_1, name##_dw, 1, CLONES)                                                        \
    BODY(name##_dw_2, name##_dw, 2, CLONES)                                                        \
    BODY(name##_dw_3, name##_dw, 3, CLONES)
#include "kernels.def"
#undef KERNEL

BODY(any_w_1, kernel->w, 1, )
BODY(any_w_2, kernel->w, 2, )
BODY(any_w_3, kernel->w, 3, )
BODY(any_dw_1, kernel->dw, 1, )
BODY(any_dw_2, kernel->dw, 2, )
BODY(any_dw_3, kernel->dw, 3, )

#define LOOPS(name)                                                                                \
    {                                                                                              \
        {name##_w_1, name##_dw_1}, {name##_w_2, name##_dw_2},                                      \
        {                                                                                          \
            name##_w_3, name##_dw_3                                                                \
        }                                                                                          \
    }
static const struct kernel_loops any[KERNEL_DIM_MAX] = LOOPS(any);
static const struct kernel_loops stamps[][KERNEL_DIM_MAX] = {
#define KERNEL(name, ...) LOOPS(name),
#include "kernels.def"
#undef KERNEL
};

struct kernel_loops kernel_loop_find(const struct kernel *kernel, int dim, bool stamped)
{
    for (size_t i = 0; stamped && i < kernel_family.n; i++) {
        const struct kernel *built_in = (const struct kernel *)kernel_family.members[i];
        if (built_in->w == kernel->w && built_in->dw == kernel->dw) return stamps[i][dim - 1];
    }
    return any[dim - 1];
}
