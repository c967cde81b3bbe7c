/* SPDX-License-Identifier: GPL-3.0-or-later
 * The table of keys a second time: what each holds, from where to where, and what it is if nobody
 * says anything. Words have no ends. */
#include "test.h"

#include <string.h>

#include "settings.h"

TEST(keys_are_as_they_were)
{
    static const struct {
        const char *name;
        enum setting_type type;
        int count;
        bool above;
        double lo, hi;
        const char *fallback;
    } rows[] = {
        {"lo", SETTING_VECTOR, 3, false, -1e30, 1e30, "-1"},
        {"hi", SETTING_VECTOR, 3, false, -1e30, 1e30, "1"},
        {"boundary", SETTING_CHOICES, 3, false, 0, 0, "auto"},
        {"gravity", SETTING_VECTOR, 3, false, -1e30, 1e30, "auto"},
        {"kind", SETTING_CHOICE, 1, false, 0, 0, "riemann"},
        {"file", SETTING_PATH, 0, false, 0, 0, ""},
        {"left", SETTING_REALS, 3, false, -1e30, 1e30, "1 0 1"},
        {"right", SETTING_REALS, 3, false, -1e30, 1e30, "0.125 0 0.1"},
        {"background", SETTING_REALS, 3, false, -1e30, 1e30, "1 0 1"},
        {"amplitude", SETTING_REAL, 1, false, 0, 0.5, "1e-4"},
        {"waves", SETTING_INTEGER, 1, false, 1, 64, "1"},
        {"parity", SETTING_CHOICE, 1, false, 0, 0, "sinuous"},
        {"direction", SETTING_VECTOR, 3, false, -16, 16, "auto"},
        {"contrast", SETTING_REAL, 1, true, 0, 1e3, "4"},
        {"rho0", SETTING_REAL, 1, true, 0, 1e30, "1"},
        {"sound", SETTING_REAL, 1, true, 0, 1e30, "10"},
        {"nu", SETTING_REAL, 1, false, 0, 1e30, "0.01"},
        {"speed", SETTING_REAL, 1, false, -1e30, 1e30, "1"},
        {"equal_masses", SETTING_CHOICE, 1, false, 0, 0, "no"},
        {"boost", SETTING_VECTOR, 3, false, -1e30, 1e30, "0"},
        {"lattice", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"jitter", SETTING_REAL, 1, false, 0, 0.49, "auto"},
        {"seed", SETTING_INTEGER, 1, false, 0, 4294967295., "1"},
        {"grade", SETTING_REAL, 1, true, 0, 1, "1"},
        {"grade_ratio", SETTING_REAL, 1, true, 1, 2, "1.05"},
        {"mass_ratio", SETTING_REAL, 1, true, 0, 1e6, "auto"},
        {"kernel", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"sinc_n", SETTING_INTEGER, 1, false, 3, 12, "5"},
        {"eta", SETTING_REAL, 1, true, 0, 100, "auto"},
        {"gradient", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"formulation", SETTING_CHOICE, 1, false, 0, 0, "vanilla_ice"},
        {"volume_element", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"integrator", SETTING_CHOICE, 1, false, 0, 0, "predicted_midpoint"},
        {"cfl", SETTING_REAL, 1, true, 0, 100, "auto"},
        {"energy", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"viscosity", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"viscosity_form", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"balsara", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"balsara_floor", SETTING_REAL, 1, false, 0, 100, "0"},
        {"noise", SETTING_REAL, 1, false, 0, 10, "0.4"},
        {"alpha_u", SETTING_REAL, 1, false, 0, 100, "0"},
        {"alpha", SETTING_REAL, 1, false, 0, 100, "auto"},
        {"beta", SETTING_REAL, 1, false, 0, 200, "auto"},
        {"alpha_min", SETTING_REAL, 1, false, 0, 100, "0.1"},
        {"alpha_max", SETTING_REAL, 1, false, 0, 100, "1.5"},
        {"pair_width", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"steps", SETTING_CHOICE, 1, false, 0, 0, "global"},
        {"shifting", SETTING_CHOICE, 1, false, 0, 0, "none"},
        {"h_method", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"h_tolerance", SETTING_REAL, 1, false, 1e-15, 1e-2, "1e-10"},
        {"gamma", SETTING_REAL, 1, true, 1, 100, "1.4"},
        {"n", SETTING_COUNT, 1, false, 4, 1e7, "450"},
        {"t_end", SETTING_REAL, 1, false, 0, 1e30, "0.2"},
        {"skip", SETTING_CHOICE, 1, false, 0, 0, "auto"},
        {"window", SETTING_REALS, 2, false, -1e30, 1e30, "auto"},
        {"window_radius", SETTING_REAL, 1, false, 0, 1e30, "0"},
    };
    assert_int_equal(SETTINGS, sizeof rows / sizeof *rows);
    for (int i = 0; i < SETTINGS; i++) {
        const struct setting_key *key = &setting_keys[i];
        assert_string_equal(key->name, rows[i].name);
        if (key->type != rows[i].type || key->count != rows[i].count ||
            key->above != rows[i].above || key->lo != rows[i].lo || key->hi != rows[i].hi ||
            strcmp(key->fallback, rows[i].fallback) != 0)
            fail_msg("%s is not as it was", key->name);
    }
}
