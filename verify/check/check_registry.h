/* SPDX-License-Identifier: GPL-3.0-or-later
 * All checks, in the order of checks.def. */
#pragma once

#include "check.h"

extern const struct check *const check_registry[];
extern const size_t check_registry_count;
