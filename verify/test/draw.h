/* SPDX-License-Identifier: GPL-3.0-or-later
 * Random numbers, the same in every run. Include after test.h. */
#pragma once

static uint64_t draw_state = 1;

/* 53 random bits. */
static inline uint64_t draw_bits(void)
{
    draw_state = draw_state * 6364136223846793005u + 1442695040888963407u;
    return (draw_state ^ draw_state >> 29) >> 11;
}

/* A random number from low up to high. */
static inline double draw(double low, double high)
{
    return low + (high - low) * ldexp((double)draw_bits(), -53);
}

/* A random integer below n. */
static inline unsigned drawn(unsigned n)
{
    return (unsigned)draw(0, n);
}

/* A random integer from low to high, both included. */
static inline int draw_count(int low, int high)
{
    return low + (int)draw(0, high - low + 1);
}
