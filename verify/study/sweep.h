/* SPDX-License-Identifier: GPL-3.0-or-later
 * Variations of a run: `--vary kernel,gradient` (all members of each family), `--vary
 * kernel=a,b,eta=2,4` (these values), every combination of them; and ladders of resolutions. */
#pragma once

#include <jansson.h>
#include <stddef.h>

#include "run.h"

enum { SWEEP_KEYS_MAX = 8, SWEEP_VALUES_MAX = 32, SWEEP_LABEL = 256 };

struct sweep {
    size_t key_count;
    struct sweep_key {
        enum setting key;
        size_t count;
        char values[SWEEP_VALUES_MAX][SETTING_TEXT_MAX];
    } keys[SWEEP_KEYS_MAX];
    size_t count; /* combinations; 1 if nothing varies */
};

/* text: the argument of --vary, NULL for none. The last key varies fastest. */
enum status sweep_parse(struct sweep *sweep, const char *text, struct error *error);

/* Applies combination i to the settings. */
enum status sweep_apply(const struct sweep *sweep, size_t i, struct run_settings *settings,
                        struct error *error);

/* "kernel=cubic_spline gradient=ia", or "" if nothing varies. */
void sweep_label(const struct sweep *sweep, size_t i, char label[SWEEP_LABEL]);

/* {"kernel": "cubic_spline", ...}. New reference. */
json_t *sweep_json(const struct sweep *sweep, size_t i);

/* Reads a comma-separated list of particle numbers, sorts it and removes duplicates; at least
 * `least` must remain. dim: of the case, see setting_check_power. */
enum status sweep_ladder(const char *text, size_t least, int dim, size_t ladder[CASE_LADDER_MAX],
                         size_t *count, struct error *error);
