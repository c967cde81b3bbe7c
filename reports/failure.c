/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure.h"

#include <stdlib.h>
#include <string.h>

#include "buffer.h"
#include "html.h"

/* Groups of checks and areas, in the order in which they are shown. */
static const char *const causes[] = {
    "kernels",     "gradients", "conservation", "riemann",   "exact",     "norms",
    "hydro",       "stability", "check",        "detection", "suspicion", "harness",
    "convergence", "budget",    "study",        "run",       "stress",    "fault",
};
enum { CAUSES = sizeof causes / sizeof *causes };

struct failure {
    json_t *entry;
    size_t cause, number;
    double excess;
    size_t more; /* other figures of the same check */
};

static size_t cause_of(const char *name, const char *otherwise)
{
    size_t other = CAUSES;
    for (size_t k = 0; k < CAUSES; k++) {
        if (!strcmp(causes[k], name)) return k;
        if (!strcmp(causes[k], otherwise)) other = k;
    }
    return other;
}

/* Takes entry. */
static void keep(struct failure_list *failures, size_t cause, double excess, json_t *entry)
{
    if (failures->count == failures->room) {
        size_t room = 2 * failures->room + 16;
        struct failure *more = realloc(failures->list, room * sizeof *more);
        if (more) failures->list = more, failures->room = room;
    }
    if (!entry || failures->count == failures->room) {
        failures->failed = true;
        json_decref(entry);
        return;
    }
    failures->list[failures->count] = (struct failure){entry, cause, failures->count, excess, 0};
    failures->count++;
}

static json_t *entry_of(const char *area, const char *name, const char *detail, const char *command)
{
    return json_pack("{s:s, s:s, s:s, s:s}", "area", area, "name", name, "detail", detail,
                     "command", command);
}

void failure_add(struct failure_list *failures, const char *area, const char *name,
                 const char *detail, const char *command)
{
    keep(failures, cause_of(area, area), 0, entry_of(area, name, detail, command));
}

static bool is_check(const json_t *entry, const char *name)
{
    return name && !strcmp(html_string(entry, "area"), "check") &&
           !strcmp(html_string(entry, "name"), name);
}

void failure_add_check(struct failure_list *failures, const char *group, double excess,
                       const char *name, const char *detail, const char *command)
{
    json_t *entry = entry_of("check", name, detail, command);
    for (size_t k = failures->count; k-- > 0;) {
        struct failure *known = &failures->list[k];
        if (!entry || !is_check(known->entry, name)) continue;
        known->more++;
        if (excess > known->excess) {
            json_decref(known->entry);
            known->entry = json_incref(entry);
            known->excess = excess;
        }
        json_decref(entry);
        return;
    }
    keep(failures, cause_of(group, "check"), excess, entry);
}

static int most_specific_first(const void *a, const void *b)
{
    const struct failure *x = a, *y = b;
    if (x->cause != y->cause) return x->cause < y->cause ? -1 : 1;
    if (x->excess != y->excess) return x->excess > y->excess ? -1 : 1;
    return x->number < y->number ? -1 : 1;
}

static void tell_more(struct failure_list *failures, const struct failure *failure)
{
    struct buffer detail = {0};
    buffer_format(&detail, "%s; and %zu more figures of this check",
                  html_string(failure->entry, "detail"), failure->more);
    if (detail.failed || json_object_set_new(failure->entry, "detail", json_string(detail.data)))
        failures->failed = true;
    buffer_free(&detail);
}

json_t *failure_take(struct failure_list *failures)
{
    json_t *taken = json_array();
    if (failures->count)
        qsort(failures->list, failures->count, sizeof *failures->list, most_specific_first);
    for (size_t k = 0; k < failures->count; k++) {
        if (failures->list[k].more) tell_more(failures, &failures->list[k]);
        if (json_array_append_new(taken, failures->list[k].entry)) failures->failed = true;
    }
    free(failures->list);
    if (failures->failed) {
        json_decref(taken);
        taken = NULL;
    }
    *failures = (struct failure_list){0};
    return taken;
}
