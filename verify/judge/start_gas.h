/* SPDX-License-Identifier: GPL-3.0-or-later
 * The particles of a snapshot of t = 0 beside the case's gas, and how far they are from it. */
#pragma once

#include "judge_start.h"

enum { START_GASES_MAX = 4 };

struct start_gas {
    const struct prepared *problem;
    const struct snapshot *snapshot;
    double spacing;
    struct problem_state *exact; /* of the case, where each particle is */
    double (*x)[3];
    unsigned *wrong;     /* a bit for each start_field */
    double speed;        /* the greatest of the case; where all rests, of sound */
    double volume, mass; /* that all have; volume 0: masses are equal */
    /* Of gas of few densities: what each has the particles of. */
    size_t gases;
    struct {
        double rho, mass;
    } of[START_GASES_MAX];
};

/* Are they equal to this part of b? */
bool start_alike(double a, double b, double tolerance);

/* The difference as a part of the exact value; where that is 0, 1 for any other value. */
double start_relative(double value, double exact);

/* The mass that a particle should have in gas so dense. */
double start_mass(const struct start_gas *gas, double rho);

/* What its own density and energy make of its pressure. */
double start_pressure(const struct start_gas *gas, size_t i);

/* How far the field of particle i is from that state, as judge_start.h has it. */
double start_off(const struct start_gas *gas, enum start_field field, size_t i,
                 const struct problem_state *exact);

/* "a quarter". */
void start_share(size_t part, size_t n, char *text, size_t size);

/* ", at x > 1": where those are of which one of these fields is wrong. */
void start_place(const struct start_gas *gas, unsigned fields, char *text, size_t size);

/* What the wrong values of a field are; false: nothing simple. */
bool start_cause(const struct start_gas *gas, enum start_field field, char *text, size_t size);

/* Are all particles, or those that are wrong, those of other places? */
bool start_cause_places(const struct start_gas *gas, char *text, size_t size);
