/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "field.h"

#define MEMBERS(...)                                                                               \
    (const struct member *const[])                                                                 \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }
#define MEMBER(name, label)                                                                        \
    &(const struct member)                                                                         \
    {                                                                                              \
        name, label, ""                                                                            \
    }

const struct family field_family = {"fields", "fields whose errors are measured",
                                    MEMBERS(MEMBER("density", "rho"), MEMBER("velocity", "v"),
                                            MEMBER("pressure", "P"),
                                            MEMBER("internal_energy", "u = P/((gamma - 1) rho)")),
                                    FIELDS};
const struct family field_norm_family = {
    "norms", "error norms over the measure window",
    MEMBERS(MEMBER("l1", "sum w |q - exact| / sum w, w the part of V in the window"),
            MEMBER("l2", "sqrt(sum V (q - exact)^2 / sum V)"), MEMBER("linf", "max |q - exact|"),
            MEMBER("particle_mean", "sum |q - exact| / number of particles"),
            MEMBER("l1_whole", "sum V |q - exact| / sum V of the particles in the window")),
    NORMS};

const char *field_unit(enum field field, int dim)
{
    static const char *const units[3][FIELDS] = {
        {"mass/length", "length/time", "mass/(length time^2)", "(length/time)^2"},
        {"mass/length^2", "length/time", "mass/time^2", "(length/time)^2"},
        {"mass/length^3", "length/time", "mass/(length time^2)", "(length/time)^2"}};
    return units[dim - 1][field];
}
