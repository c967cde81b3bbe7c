/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a seed makes of a coordinate of Sobol's sequence before it is shifted, worked out a second time:
 * thirty binary digits, added without carrying to those of a root times the seed less 1. */
#ifndef SPHPROOF_MADE_DIGITS_H
#define SPHPROOF_MADE_DIGITS_H

#include <math.h>
#include <stdint.h>

static double made_digits(double part, int d, uint64_t seed)
{
    static const uint64_t roots[] = {0x9e3779b9, 0x6a09e667, 0xbb67ae85, 0x3c6ef373};
    const uint64_t digits = (seed - 1) * roots[d] % (1 << 30);
    return (double)((uint64_t)ldexp(part, 30) ^ digits) / (1 << 30);
}

#endif
