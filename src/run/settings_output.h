/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SPHPROOF_SETTINGS_OUTPUT_H
#define SPHPROOF_SETTINGS_OUTPUT_H

#include <jansson.h>

#include "settings.h"

/* All keys as used: numbers, names, "rho v P" as an array. Keys of other problems are left out. New
 * reference. */
json_t *settings_json(const struct settings *settings);

#endif
