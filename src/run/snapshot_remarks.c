/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "snapshot_writer.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "problem_list.h"
#include "problem_prepare.h"

static void __attribute__((format(printf, 2, 3)))
append(struct snapshot_remark *remark, const char *format, ...)
{
    const size_t used = strlen(remark->value);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(remark->value + used, sizeof remark->value - used, format, arguments);
    va_end(arguments);
}

/* True if the key changes the exact solution. Box, boundary, gamma and window have remarks of their
 * own, and the arrangement of the particles does not matter. */
static bool changes_solution(const struct settings *settings, enum setting key)
{
    const struct setting_key *about = &setting_keys[key];
    return settings->value[key].source == SOURCE_USER && strcmp(about->section, "initial") == 0 &&
           about->type != SETTING_PATH && !problem_foreign(settings, key) &&
           !problem_lays_particles(problem_of(settings), key);
}

static void list_keys(const struct run_result *result, struct snapshot_remark *remark)
{
    const struct window *window = &result->problem.window;
    char text[SETTING_TEXT_MAX];
    append(remark, "window=%.17g %.17g", window->lo[0], window->hi[0]);
    if (window->radius > 0) append(remark, "; window_radius=%.17g", window->radius);
    for (int key = 0; key < SETTINGS; key++) {
        if (!changes_solution(&result->settings, (enum setting)key)) continue;
        settings_text(&result->settings, (enum setting)key, text);
        append(remark, "; %s=%s", setting_keys[key].name, text);
    }
}

size_t snapshot_remarks(const struct run_result *result,
                        struct snapshot_remark remarks[SNAPSHOT_REMARKS])
{
    const struct domain *domain = &result->problem.domain;
    struct snapshot_remark *next = remarks;
    memset(remarks, 0, SNAPSHOT_REMARKS * sizeof *remarks);
    if (result->case_name[0]) {
        next->key = "case";
        append(next++, "%s", result->case_name);
    }
    next->key = "time";
    append(next++, "%.17g", result->time);
    next->key = "gamma";
    append(next++, "%.17g", result->problem.gamma);
    next->key = "box";
    for (int d = 0; d < domain->dim; d++)
        append(next, "%s%.17g:%.17g", d ? " " : "", domain->lo[d], domain->hi[d]);
    next++;
    next->key = "boundary";
    for (int d = 0; d < domain->dim; d++)
        append(next, "%s%s", d ? " " : "",
               scheme_boundary_family.members[result->problem.boundary[d]]->name);
    next++;
    next->key = "keys";
    list_keys(result, next++);
    return (size_t)(next - remarks);
}
