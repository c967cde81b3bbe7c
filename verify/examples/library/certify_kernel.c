/* SPDX-License-Identifier: GPL-3.0-or-later
 * Certify my kernel: Wendland C8 from the two functions that a code of one's own has anyway.
 *
 *     cc certify_kernel.c $(pkg-config --cflags --libs sphproof) -o certify_kernel
 *     ./certify_kernel        # exit status 0: it is a right kernel in 1, 2 and 3 dimensions
 *
 * With -DTYPO a factor of the derivative is wrong, and the exit status 1. */
#include <stdio.h>

#include <sphproof/kernels.h>

#ifdef TYPO
#define FACTOR 25
#else
#define FACTOR 26
#endif

static double my_w(double q, int dim)
{
    (void)dim;
    if (q >= 1) return 0;
    const double a = 1 - q, a2 = a * a, a5 = a2 * a2 * a;
    return a5 * a5 * (1 + q * (10 + q * (42 + q * (90 + q * (429. / 5)))));
}

static double my_dw(double q, int dim)
{
    (void)dim;
    if (q >= 1) return 0;
    const double a = 1 - q, a3 = a * a * a;
    return -FACTOR * q * (a3 * a3 * a3) * (1 + q * (9 + q * (159. / 5 + q * (231. / 5))));
}

static void print(void *context, const struct sphproof_figure *figure)
{
    (void)context;
    printf("%-18s %10.2e %10.2e  %-4s  %s\n", figure->property, figure->value, figure->bound,
           figure->skipped  ? "skip"
           : figure->passed ? "pass"
                            : "FAIL",
           figure->where);
}

int main(void)
{
    const struct sphproof_shape shape = {.w = my_w,
                                         .dw = my_dw,
                                         .knot_count = 0, /* one formula from 0 to 1 */
                                         .smoothness = 8,
                                         .name = "my Wendland C8"};
    struct sphproof_kernel *kernel;
    struct sphproof_error error;
    enum sphproof_status worst = SPHPROOF_OK;
    if (sphproof_kernels_own(&shape, &kernel, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return (int)error.status;
    }
    for (int dim = 1; dim <= 3; dim++) {
        printf("%dD: property, measured, allowed\n", dim);
        const enum sphproof_status status =
            sphproof_kernels_certify(kernel, dim, print, NULL, &error);
        if (status > worst) worst = status;
        if (status) fprintf(stderr, "%dD: %s\n", dim, error.message);
    }
    sphproof_kernels_free(kernel);
    return (int)worst;
}
