/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "problem_list.h"

#include <string.h>

#include "user_solution.h"

#define PROBLEM(name) extern const struct problem problem_##name;
#include "problems.def"
#undef PROBLEM

static const struct member *const members[] = {
#define PROBLEM(name) &problem_##name.member,
#include "problems.def"
#undef PROBLEM
};

const struct family problem_family = {"problems", "initial states and what they are judged by",
                                      members, sizeof members / sizeof *members};

const struct problem *problem_of(const struct settings *settings)
{
    const struct problem *problem =
        (const struct problem *)members[settings_choice(settings, SETTING_kind)];
    return settings->reference > 0 ? user_solution_problem(settings->reference, problem) : problem;
}

static bool calls_its_own(const struct problem *problem, enum setting key)
{
    for (size_t i = 0; i < problem->key_count; i++)
        if (problem->keys[i].key == key) return true;
    return false;
}

bool problem_reads(const struct problem *problem, enum setting key)
{
    if (calls_its_own(problem, key)) return true;
    for (size_t i = 0; i < problem_family.n; i++)
        if (calls_its_own((const struct problem *)members[i], key)) return false;
    return true;
}

/* True for keys without meaning in 1D. */
static bool needs_a_plane(enum setting key)
{
    return key == SETTING_direction || key == SETTING_boost || key == SETTING_viscosity_form ||
           key == SETTING_balsara || key == SETTING_balsara_floor || key == SETTING_noise ||
           key == SETTING_alpha_u || key == SETTING_shock_conductivity || key == SETTING_shifting ||
           key == SETTING_window_radius || key == SETTING_gravity;
}

static bool needs_a_line(enum setting key)
{
    return key == SETTING_grade || key == SETTING_grade_ratio;
}

bool problem_foreign(const struct settings *settings, enum setting key)
{
    return !problem_reads(problem_of(settings), key) ||
           (settings->dim == 1 && needs_a_plane(key)) || (settings->dim > 1 && needs_a_line(key));
}

const char *problem_functional(const struct problem *problem, const char *name)
{
    for (const struct functional *const *f = problem->functionals; *f; f++)
        if (strcmp((*f)->name, name) == 0) return (*f)->name;
    return problem->growing && strcmp(problem->growing->name, name) == 0 ? problem->growing->name
                                                                         : NULL;
}

const char *problem_functional_name(const char *name)
{
    const char *found = NULL;
    for (size_t i = 0; i < problem_family.n && !found; i++)
        found = problem_functional((const struct problem *)problem_family.members[i], name);
    return found;
}
