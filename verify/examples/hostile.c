/* SPDX-License-Identifier: GPL-3.0-or-later
 * The cubic spline with mistakes in places that are seldom tested, and foreign code at its worst:
 * the compiler option -DFAULT=NAME chooses one. hostile.txt says what sphproof must say to each.
 * With -DBARE neither class nor knots nor dW/dh is declared. */
#include <math.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "plugin.h"

enum {
    /* correct kernels */
    NONE,
    NEGATIVE_DECLARED,
    SINGLE,
    PRINTS,
    /* wrong kernels: in a narrow interval, by a small amount, or after many calls */
    SIGN_NARROW,
    HOLE_DECIMAL,
    HOLE_ANYWHERE,
    HOLE_SQUARED,
    BUMP_NARROW,
    KINK,
    KINK_OF_W,
    DH_SMALL_H,
    DH_LARGE_H,
    DH_HOLE,
    DRIFT,
    ALTERNATES,
    NEGATIVE_UNDECLARED,
    NEGATIVE_WRONG_DW,
    SINGLE_WRONG_DW,
    SINGLE_WRONG_CONSTANT,
    SINGLE_WRONG_DH,
    /* never return a value */
    ABORT_IN_DH,
    ABORT_LATE,
    LOOP_LATE,
    LOOP_FIRST,
    SLEEPS,
    EXIT_42,
    EXIT_0_LATE,
    ANSWERS,
    RECURSES,
    EATS_MEMORY,
    STOPS_ITSELF,
    FORKS,
    FORKS_AND_SLEEPS,
    CLOSES,
    PRINTS_WITHOUT_END,
    LOOP_AT_LOAD,
    EXIT_AT_LOAD,
    CRASH_AT_UNLOAD
};

static const double pi = 3.14159265358979323846;
static volatile long calls;
static volatile int never;

static void misbehave(void)
{
    calls++;
    if (FAULT == EXIT_42 && calls == 2000) _exit(42);
    if (FAULT == EXIT_0_LATE && calls == 100000) exit(0);
    if (FAULT == ABORT_LATE && calls == 100000) abort();
    if (FAULT == LOOP_FIRST)
        while (!never) continue;
    if (FAULT == LOOP_LATE && calls > 5000)
        while (!never) continue;
    if (FAULT == SLEEPS && calls > 5000) sleep(1000);
    if (FAULT == STOPS_ITSELF && calls > 5000) raise(SIGSTOP);
    if (FAULT == PRINTS && calls % 10000 == 0) printf("w has been called %ld times\n", calls);
    if (FAULT == PRINTS_WITHOUT_END && calls > 5000)
        while (!never) puts("{\"status\": \"pass\"}");
    if (FAULT == FORKS && calls == 5000 && fork() == 0) sleep(1000);
    if (FAULT == FORKS_AND_SLEEPS && calls == 5000) {
        signal(SIGINT, SIG_IGN);
        if (fork() >= 0) sleep(1000);
    }
    if (FAULT == CLOSES && calls == 5000)
        for (int i = 3; i < 256; i++) close(i);
    if (FAULT == ANSWERS && calls == 5000) { /* imitates the reply of a certificate */
        for (int i = 3; i < 256; i++)
            if (write(i, "{\"status\": \"pass\"}\n", 19) < 0) continue;
        _exit(0);
    }
    while (FAULT == EATS_MEMORY && calls > 5000) {
        char *block = malloc(1 << 20);
        if (!block) abort();
        memset(block, 1, 1 << 20);
    }
}

static int recurse(volatile int *deeper)
{
    volatile int here = *deeper + 1;
    return never ? here : recurse(&here) + here;
}

__attribute__((constructor)) static void at_load(void)
{
    if (FAULT == LOOP_AT_LOAD)
        while (!never) continue;
    if (FAULT == EXIT_AT_LOAD) exit(0);
}

__attribute__((destructor)) static void at_unload(void)
{
    if (FAULT == CRASH_AT_UNLOAD) abort();
}

/* (1 - q^2)^3 (1 - 2 q^2): negative beyond q = 0.707. */
static int has_lobe(void)
{
    return FAULT == NEGATIVE_DECLARED || FAULT == NEGATIVE_UNDECLARED || FAULT == NEGATIVE_WRONG_DW;
}

static int is_single(void)
{
    return FAULT == SINGLE || FAULT == SINGLE_WRONG_DW || FAULT == SINGLE_WRONG_CONSTANT ||
           FAULT == SINGLE_WRONG_DH;
}

static float single_w(float q)
{
    const float a = 1 - q;
    return q >= 1 ? 0 : q >= 0.5f ? 2 * a * a * a : 1 - 6 * q * q * a;
}

static float single_dw(float q)
{
    const float a = 1 - q;
    return q >= 1 ? 0 : q >= 0.5f ? -6 * a * a : q * (18 * q - 12);
}

double sphproof_kernel_w(double q, int dim)
{
    (void)dim;
    misbehave();
    if (FAULT == RECURSES && calls > 5000) {
        int start = 0;
        return recurse(&start);
    }
    if (is_single()) return (double)single_w((float)q);
    if (q >= 1) return 0;
    const double a = 1 - q, square = q * q;
    if (has_lobe()) return (1 - square) * (1 - square) * (1 - square) * (1 - 2 * square);
    double w = q >= 0.5 ? 2 * a * a * a : 1 - 6 * q * q * a;
    if (FAULT == HOLE_DECIMAL && q > 0.37 && q < 0.37 + 1e-8) return 0;
    if (FAULT == HOLE_ANYWHERE && fabs(q - 0.41234567891234) < 5e-9) return 0;
    if (FAULT == HOLE_SQUARED && square > 0.17071067811 && square < 0.1707106783) return 0;
    if (FAULT == BUMP_NARROW) w += 1e-7 * exp(-pow((q - 0.7234567) / 1e-5, 2));
    if (FAULT == KINK || FAULT == KINK_OF_W) w += q < 0.37 ? 1e-7 * (0.37 - q) : 0;
    if (FAULT == DRIFT && calls > 200000) w *= 1 + 1e-6;
    if (FAULT == ALTERNATES && calls % 1000 == 999) w *= 1 + 1e-15;
    return w;
}

double sphproof_kernel_dw(double q, int dim)
{
    (void)dim;
    if (is_single())
        return (double)(single_dw((float)q) * (FAULT == SINGLE_WRONG_DW ? 1.0001f : 1));
    if (q >= 1) return 0;
    const double a = 1 - q, b = 1 - q * q;
    if (has_lobe())
        return -q * b * b * (6 * (1 - 2 * q * q) + 4 * b) *
               (FAULT == NEGATIVE_WRONG_DW ? 1.000001 : 1);
    double dw = q >= 0.5 ? -6 * a * a : q * (18 * q - 12);
    if (FAULT == SIGN_NARROW && q > 0.6712345 && q < 0.6712345 + 1e-5) dw = -dw;
    if (FAULT == BUMP_NARROW) {
        const double x = (q - 0.7234567) / 1e-5;
        dw -= 2e-7 / 1e-5 * x * exp(-x * x);
    }
    if (FAULT == KINK) dw -= q < 0.37 ? 1e-7 : 0;
    return dw;
}

double sphproof_kernel_constant(int dim)
{
    if (has_lobe()) /* from moments of 1 - 5 s + 9 s^2 - 7 s^3 + 2 s^4, s = q^2 */
        return dim == 1   ? 1 / (2 * (1 - 5. / 3 + 9. / 5 - 1 + 2. / 9))
               : dim == 2 ? 1 / (2 * pi * (1. / 2 - 5. / 4 + 9. / 6 - 7. / 8 + 2. / 10))
                          : 1 / (4 * pi * (1. / 3 - 1 + 9. / 7 - 7. / 9 + 2. / 11));
    const double constant = dim == 1 ? 4. / 3 : dim == 2 ? 40 / (7 * pi) : 8 / pi;
    if (is_single())
        return (double)(float)constant * (FAULT == SINGLE_WRONG_CONSTANT ? 1.00002 : 1);
    return constant;
}

#ifndef BARE
double sphproof_kernel_dw_dh(double r, double h, int dim)
{
    if (FAULT == ABORT_IN_DH) abort();
    const double q = r / h;
    double c = sphproof_kernel_constant(dim) * pow(h, -dim - 1);
    if (FAULT == DH_SMALL_H && h < 1e-3) c *= 1.01;
    if (FAULT == DH_LARGE_H && h > 1e5 && h < 3e5) c *= 1 + 1e-9;
    if (FAULT == DH_HOLE && q > 0.123456 && q < 0.123456 + 1e-8) c = 0;
    if (FAULT == SINGLE_WRONG_DH) c *= 1.0001;
    const double value = -c * (dim * sphproof_kernel_w(q, dim) + q * sphproof_kernel_dw(q, dim));
    return is_single() ? (double)(float)value : value;
}

int sphproof_kernel_knots(int dim, double *knots)
{
    (void)dim;
    knots[0] = 0.5;
    return has_lobe() ? 0 : 1;
}

int sphproof_kernel_class(int dim)
{
    (void)dim;
    return 2;
}
#endif

int sphproof_kernel_negative(int dim)
{
    (void)dim;
    return FAULT == NEGATIVE_DECLARED || FAULT == NEGATIVE_WRONG_DW;
}
