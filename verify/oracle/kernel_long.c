/* SPDX-License-Identifier: GPL-3.0-or-later
 * The kernels' own files, compiled with long double in place of double: the same formulas, with
 * the same rounded constants, and 11 bits more in every operation. */
#include "kernel_long.h"

#include <math.h>
#include <string.h>

#ifdef __clang__
#pragma clang diagnostic ignored "-Wkeyword-macro"
#endif
/* Not <tgmath.h>, because musl's macros contain double. A function that a kernel needs and that is
 * missing here narrows its argument, which the compiler refuses. */
#define cbrt cbrtl
#define cos  cosl
#define cosh coshl
#define erf  erfl
#define exp  expl
#define fabs fabsl
#define fmax fmaxl
#define fmin fminl
#define log  logl
#define pow  powl
#define sin  sinl
#define sinh sinhl
#define sqrt sqrtl
#define tan  tanl
#define double long double
#define KERNEL(name, ...)
#include "kernel/kernels.def"
#undef KERNEL
#undef double

static const struct {
    const char *name;
    kernel_long_shape *w, *dw;
} list[] = {
#define KERNEL(name, ...) {#name, name##_w, name##_dw},
#include "kernel/kernels.def"
#undef KERNEL
};

void kernel_long_find(const char *name, kernel_long_shape **w, kernel_long_shape **dw)
{
    *w = NULL;
    *dw = NULL;
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        if (strcmp(list[i].name, name) == 0) {
            *w = list[i].w;
            *dw = list[i].dw;
        }
}
