/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pairing instability by energy. On the densest lattice (hexagonal, face-centred cubic) single
 * particles are compared with coincident pairs on the same lattice, 2^(1/d) times wider. Energy
 * increases with the estimated density. The density of the pairs equals that of single particles
 * with a support smaller by 2^(1/d), so that pairs have less energy if the lattice sum at eta
 * exceeds that at eta/2^(1/d). This never happens for kernels without a negative transform. Agrees
 * with relaxation runs (Dehnen & Aly 2012). */
#include "measure.h"

#include <math.h>

/* Sum of W over the densest lattice with unit volume per particle, h = eta. */
static double densest_sum(const struct kernel *kernel, int dim, double eta)
{
    const double nearest = dim == 1 ? 1 : dim == 2 ? sqrt(2 / sqrt(3)) : pow(2, 1. / 6);
    const int reach = (int)ceil(1.8 * eta / nearest);
    double sum = 0;
    for (int i = -reach; i <= reach; i++)
        for (int j = dim > 1 ? -reach : 0; j <= (dim > 1 ? reach : 0); j++)
            for (int k = dim > 2 ? -reach : 0; k <= (dim > 2 ? reach : 0); k++) {
                /* lattice vectors at 60 degrees to each other */
                const double r = nearest * sqrt(i * i + j * j + k * k + i * j + j * k + i * k);
                if (r < eta) sum += kernel_value(kernel, r, eta, dim);
            }
    return sum;
}

double measure_pairing(const struct kernel *kernel, int dim)
{
    const double ball = measure_sphere(dim) / dim, narrower = pow(2, -1. / dim);
    const double first = dim == 1 ? 4 : dim == 2 ? 8 : 12; /* at least the nearest neighbours */
    for (double n = first; n <= MEASURE_NEIGHBOURS_MAX; n *= 1.01) {
        const double eta = pow(n / ball, 1. / dim);
        if (densest_sum(kernel, dim, eta) > densest_sum(kernel, dim, eta * narrower) + 1e-9)
            return n;
    }
    return (double)NAN;
}
