/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "property.h"

const struct property property_list[] = {
#define PROPERTY(name, rank, says, formula) {#name, formula, property_##name},
#include "properties.def"
#undef PROPERTY
};
const size_t property_count = sizeof property_list / sizeof *property_list;
