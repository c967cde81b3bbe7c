/* SPDX-License-Identifier: GPL-3.0-or-later
 * Check my gradient operator: moving least squares in 2D, written without a line of sphproof, is
 * handed over as a callback and tried on clouds of all kinds.
 *
 *     cc check_gradient.c $(pkg-config --cflags --libs sphproof) -lm -o check_gradient
 *     ./check_gradient        # exit status 0: it keeps its promises
 *
 * With -DTYPO the matrix is not symmetric any more, and the exit status 1. */
#include <math.h>
#include <stdio.h>

#include <sphproof/gradients.h>

/* The least squares solution g of f_j - f_i = g . (r_j - r_i) with weights (1 - r^2/h^2)^2. */
static bool my_gradient(void *context, const struct sphproof_cloud *cloud, const double *f,
                        double *const gradient[])
{
    const double *const x = cloud->x[0], *const y = cloud->x[1];
    (void)context;
    for (size_t i = 0; i < cloud->n; i++) {
        double xx = 0, xy = 0, yy = 0, fx = 0, fy = 0;
        for (size_t j = 0; j < cloud->n; j++) {
            const double dx = x[j] - x[i], dy = y[j] - y[i], df = f[j] - f[i];
            const double s = 1 - (dx * dx + dy * dy) / (cloud->h[i] * cloud->h[i]);
            if (s <= 0) continue;
            xx += s * s * dx * dx, xy += s * s * dx * dy, yy += s * s * dy * dy;
            fx += s * s * df * dx, fy += s * s * df * dy;
        }
        const double determinant = xx * yy - xy * xy;
#ifdef TYPO
        gradient[0][i] = (yy * fx + xy * fy) / determinant;
#else
        gradient[0][i] = (yy * fx - xy * fy) / determinant;
#endif
        gradient[1][i] = (xx * fy - xy * fx) / determinant;
    }
    return true;
}

static void print(void *context, const struct sphproof_figure *figure)
{
    (void)context;
    printf("%-10s %10.2e %10.2e  %s  %s\n", figure->property, figure->value, figure->bound,
           figure->passed ? "pass" : "FAIL", figure->where);
}

int main(void)
{
    const struct sphproof_gradient_promise promise = {
        .exact = 2, /* constants and linear fields */
        .order = 1, /* of smooth fields, where points are disordered */
        .eta = 2.4,
        .turns = true,
        .moves = true,
        .scales = true,
        .linear = true,
    };
    struct sphproof_error error;
    const enum sphproof_status status =
        sphproof_gradients_check(my_gradient, NULL, 2, &promise, print, NULL, &error);
    if (status) fprintf(stderr, "%s\n", error.message);
    return (int)status;
}
