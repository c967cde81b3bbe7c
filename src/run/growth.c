/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "growth.h"

#include <math.h>

void growth_see(struct growth *growth, double time, double amplitude)
{
    const double y = amplitude > 0 ? log(amplitude) : (double)NAN;
    growth->n++;
    growth->t += time;
    growth->y += y;
    growth->tt += time * time;
    growth->ty += time * y;
}

double growth_rate(const struct growth *growth)
{
    const double n = (double)growth->n;
    if (growth->n < 3) return (double)NAN;
    return (n * growth->ty - growth->t * growth->y) / (n * growth->tt - growth->t * growth->t);
}
