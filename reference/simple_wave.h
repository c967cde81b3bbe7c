/* SPDX-License-Identifier: GPL-3.0-or-later
 * An isentropic simple wave that runs to the right in a periodic box, exact at any amplitude until
 * its crests break (Landau & Lifshitz, Fluid Mechanics, section 101): for small amplitudes the
 * linear sound wave. At t = 0
 *   rho = rho0 (1 + amplitude sin(2 pi x/length)), P = P0 (rho/rho0)^gamma,
 *   v = v0 + 2 (c - c0)/(gamma - 1),
 * and each value travels with its own constant speed v + c. */
#pragma once

/* The box repeats with `length`, which is one wavelength. Any consistent units. */
struct simple_wave {
    double gamma, rho0, v0, P0, amplitude, length;
};

struct simple_wave_state {
    double rho, v, P, u;
};

/* NULL, or a text that says what is wrong: gamma > 1, rho0, P0, length > 0, |amplitude| < 1. */
const char *simple_wave_fault(const struct simple_wave *wave);

/* The time when the crest breaks; infinite for amplitude 0. */
double simple_wave_breaking_time(const struct simple_wave *wave);

/* The state at x and time 0 <= t < breaking time; all NaN outside of that and where a number would
 * leave the range of double. The wave is valid (simple_wave_fault). */
struct simple_wave_state simple_wave_sample(const struct simple_wave *wave, double x, double t);
