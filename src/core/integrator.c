/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "integrator.h"

#include "scheme.h"

#define INTEGRATOR(name, ...)                                                                      \
    static const struct integrator integrator_##name = {.step = name##_step, __VA_ARGS__};
#include "integrator/integrators.def"
#undef INTEGRATOR

static const struct member *const members[] = {
#define INTEGRATOR(name, ...) &integrator_##name.member,
#include "integrator/integrators.def"
#undef INTEGRATOR
};

const struct family integrator_family = {"integrators", "time integrators", members,
                                         sizeof members / sizeof *members};
