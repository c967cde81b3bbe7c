/* SPDX-License-Identifier: GPL-3.0-or-later
 * A cube root from arithmetic operations only: loops vectorise, and the result is identical on
 * every machine. */
#ifndef SPHPROOF_CUBE_ROOT_H
#define SPHPROOF_CUBE_ROOT_H

#include <stdint.h>
#include <string.h>

#include "specialise.h"

/* x^(1/3) to one unit in the last place; x > 0, neither subnormal nor within a factor of 4 of the
 * largest double. The upper half of a double's bits is nearly a logarithm: one third of it plus a
 * constant is accurate to 1/32 (as in FreeBSD). Two steps of Halley's method and one of Newton's
 * follow. Adding and subtracting 2^52 converts between an integer in the lower bits and a double.
 */
ALWAYS_INLINE double cube_root(double x)
{
    uint64_t bits;
    double y;
    memcpy(&bits, &x, sizeof bits);
    bits = bits >> 32 | 0x4330000000000000;
    memcpy(&y, &bits, sizeof y);
    y = (y - 0x1p52) * (1. / 3) + 715094163 + 0x1p52;
    memcpy(&bits, &y, sizeof bits);
    bits <<= 32;
    memcpy(&y, &bits, sizeof y);
    for (int step = 0; step < 2; step++) {
        const double y3 = y * y * y;
        y *= (y3 + 2 * x) / (2 * y3 + x);
    }
    return y - (y * y * y - x) / (3 * (y * y));
}

#endif
