/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphproof/gradients.h"

#include <math.h>

#include "library.h"
#include "operator.h"
#include "summation.h"

#define TOLERANCE 1e-10

static enum sphproof_status check_cloud(const struct sphproof_kernel *kernel,
                                        const struct sphproof_cloud *cloud,
                                        struct sphproof_error *error)
{
    if (cloud->dim < 1 || cloud->dim > 3)
        return library_fail(error, STATUS_BAD_INPUT, "dim = %d: allowed: 1, 2, 3", cloud->dim);
    if (kernel->dim && kernel->dim != cloud->dim)
        return library_fail(error, STATUS_BAD_INPUT, "kernel %.80s: dim = %d is not among its own",
                            kernel->kernel.member.name, cloud->dim);
    for (int a = 0; a < cloud->dim; a++)
        if (!cloud->x[a])
            return library_fail(error, STATUS_BAD_INPUT, "a cloud in %dD needs x[%d]", cloud->dim,
                                a);
    return SPHPROOF_OK;
}

static struct points points_of(const struct sphproof_cloud *cloud)
{
    struct points points = {.dim = cloud->dim, .n = cloud->n, .periodic = cloud->periodic};
    for (int a = 0; a < cloud->dim; a++)
        points.x[a] = cloud->x[a], points.lo[a] = cloud->lo[a], points.hi[a] = cloud->hi[a];
    return points;
}

enum sphproof_status sphproof_gradients_apply(const char *name,
                                              const struct sphproof_kernel *kernel,
                                              const struct sphproof_cloud *cloud, const double *f,
                                              double *const gradient[],
                                              struct sphproof_error *error)
{
    const int at = family_index(&operator_family, name ? name : "");
    if (at < 0)
        return library_fail(error, STATUS_BAD_INPUT,
                            "no operator '%.60s'; there are standard, ia, linear_exact ... "
                            "(sphproof list operators)",
                            name ? name : "");
    const enum sphproof_status wrong = check_cloud(kernel, cloud, error);
    if (wrong) return wrong;
    if (!cloud->volume || !cloud->h)
        return library_fail(error, STATUS_BAD_INPUT, "the cloud needs volume and h");
    const struct cloud ours = {points_of(cloud), cloud->volume, cloud->h};
    const struct operator_settings settings = {
        .form = (const struct operator_form *)operator_family.members[at],
        .kernel = &kernel->kernel,
        .threads = 1};
    struct error failure;
    return library_pass(operator_apply(&settings, &ours, 1, &f, gradient, NULL, NULL, &failure),
                        &failure, error);
}

enum sphproof_status sphproof_gradients_density(const struct sphproof_kernel *kernel, double eta,
                                                const struct sphproof_cloud *cloud, const double *m,
                                                double *h, double *rho,
                                                struct sphproof_error *error)
{
    const enum sphproof_status wrong = check_cloud(kernel, cloud, error);
    if (wrong) return wrong;
    const struct summation summation = {.points = points_of(cloud),
                                        .kernel = &kernel->kernel,
                                        .m = m,
                                        .eta = eta,
                                        .tolerance = TOLERANCE,
                                        .threads = 1};
    struct error failure;
    return library_pass(summation_solve(&summation, h, rho, &failure), &failure, error);
}
