/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "check_registry.h"

#define CHECK(file, name) extern const struct check check_##name;
#include "checks.def"
#undef CHECK

const struct check *const check_registry[] = {
#define CHECK(file, name) &check_##name,
#include "checks.def"
#undef CHECK
};
const size_t check_registry_count = sizeof check_registry / sizeof *check_registry;
