/* SPDX-License-Identifier: GPL-3.0-or-later
 * The cubic spline (Monaghan & Lattanzio 1985) as a plug-in, for tests of plug-ins in runs: w and dw
 * written another way than in the program; and copies that do harm, but only in a run: while their
 * certificate is made, a timer runs in the process (guard.c). -DHARM=... */
#include <stdlib.h>
#include <sys/time.h>
#include <unistd.h>

#include "plugin.h"

#ifdef HARM
static void do_harm(void)
{
    enum { PATIENCE = 1 << 15 };
    static int calls;
    struct itimerval timer;
    if (++calls % PATIENCE) return;
    getitimer(ITIMER_PROF, &timer);
    if (timer.it_interval.tv_sec || timer.it_interval.tv_usec) return;
    HARM;
}
#else
static void do_harm(void)
{
}
#endif

double sphproof_kernel_w(double q, int dim)
{
    (void)dim;
    do_harm();
    if (q >= 1) return 0;
    return q <= 0.5 ? 1 - 6 * q * q * (1 - q) : 2 * (1 - q) * (1 - q) * (1 - q);
}

double sphproof_kernel_dw(double q, int dim)
{
    (void)dim;
    if (q >= 1) return 0;
    return q <= 0.5 ? -12 * q + 18 * q * q : -6 * (1 - q) * (1 - q);
}
