/* SPDX-License-Identifier: GPL-3.0-or-later
 * The particles of a snapshot of t = 0 beside the case's gas, and how far they are from it. */
#pragma once

#include "judge_start.h"

enum { START_GASES_MAX = 4 };

/* A relative difference above this is more than rounding. */
#define START_WRONG 1e-4

struct start_gas {
    const struct prepared *problem;
    const struct snapshot *snapshot;
    double spacing;
    struct problem_state *exact; /* the case's exact state at each particle's position */
    double (*x)[3];
    unsigned *wrong;     /* per particle, one bit for each start_field */
    double speed;        /* greatest speed of the case; the sound speed if all gas is at rest */
    double volume, mass; /* common to all particles; volume 0: masses are equal */
    /* If the gas has only a few densities: the particle mass of each density. */
    size_t gases;
    struct {
        double rho, mass;
    } of[START_GASES_MAX];
};

/* The index of the gas with this density; gas->gases: there is none. */
size_t start_gas_of(const struct start_gas *gas, double rho);

/* The difference relative to the exact value; where the exact value is 0, 1 for any other value. */
double start_relative(double value, double exact);

/* Magnitude of the difference of two velocities. */
double start_apart(const double v[3], const double other[3]);

/* The mass that a particle of gas with density rho should have. */
double start_mass(const struct start_gas *gas, double rho);

/* The pressure of particle i from the file's density and energy. */
double start_pressure(const struct start_gas *gas, size_t i);

/* Difference between the field of particle i and the exact state, as defined in judge_start.h. */
double start_off(const struct start_gas *gas, enum start_field field, size_t i,
                 const struct problem_state *exact);

/* Writes the share in words, such as "a quarter". */
void start_share(size_t part, size_t n, char *text, size_t size);

/* Writes where these fields are wrong, such as ", at x > 1". */
void start_where(const struct start_gas *gas, unsigned fields, char *text, size_t size);

/* Writes what the wrong values of a field are; false if no simple rule describes them. */
bool start_cause(const struct start_gas *gas, enum start_field field, char *text, size_t size);

/* True if all particles, or all wrong ones, have the states of other positions, which text
 * names. */
bool start_cause_positions(const struct start_gas *gas, char *text, size_t size);
