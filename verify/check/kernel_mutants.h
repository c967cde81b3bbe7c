/* SPDX-License-Identifier: GPL-3.0-or-later
 * Wrong kernels, and for each property those that it must reject: kernel_mutants_NAME. */
#pragma once

#include "check.h"

#define PROPERTY(name, rank, says, formula)                                                        \
    extern const struct check_mutant kernel_mutants_##name[];
#include "properties.def"
#undef PROPERTY
