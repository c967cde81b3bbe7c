/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure.h"

#include <stdlib.h>
#include <string.h>

#include "buffer.h"
#include "value.h"

/* Groups of checks and areas, in the order in which they are shown. */
static const char *const causes[] = {
    "kernels", "gradients", "conservation", "riemann",   "exact",     "norms",   "hydro",
    "clouds",  "stability", "check",        "detection", "suspicion", "harness", "convergence",
    "gate",    "budget",    "study",        "run",       "stress",    "fault",
};
enum { CAUSES = sizeof causes / sizeof *causes };

/* Checks of one formula each: before the others of their group, which follow from several. */
static const char *const elementary[] = {
    "normalisation", "radial_derivative", "width_derivative", "brute_force",
    "antisymmetry",  "star_states",       "error_norms",      "riemann_setup",
    "rates",         "h_residual",        "time_stepping",
};
enum { ELEMENTARY = sizeof elementary / sizeof *elementary };

struct failure {
    json_t *entry;
    size_t cause, check, number; /* of the lists above; in the order of coming */
    double excess;
    size_t more; /* other figures of the same check */
};

/* Where in a list; at its end where it is not. */
static size_t place(const char *name, const char *const *list, size_t n)
{
    size_t k = 0;
    while (k < n && strcmp(list[k], name)) k++;
    return k;
}

static size_t cause_of_check(const char *group)
{
    size_t cause = place(group, causes, CAUSES);
    return cause < CAUSES ? cause : place("check", causes, CAUSES);
}

size_t failure_rank(const char *group, const char *check)
{
    return cause_of_check(group) * (ELEMENTARY + 1) + place(check, elementary, ELEMENTARY);
}

/* Takes entry. */
static void keep(struct failure_list *failures, size_t cause, size_t check, double excess,
                 json_t *entry)
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
    failures->list[failures->count] =
        (struct failure){entry, cause, check, failures->count, excess, 0};
    failures->count++;
}

void failure_add(struct failure_list *failures, const char *area, const char *name,
                 const char *detail, const char *command)
{
    keep(failures, place(area, causes, CAUSES), 0, 0,
         json_pack("{s:s, s:s, s:s, s:s}", "area", area, "name", name, "detail", detail, "command",
                   command));
}

void failure_add_check(struct failure_list *failures, const json_t *figure, double excess,
                       const char *detail, const char *command)
{
    const char *group = value_text(figure, "group"), *check = value_text(figure, "name");
    json_t *entry =
        json_pack("{s:s, s:s++, s:s, s:s, s:s}", "area", "check", "name", group, ": ", check,
                  "subject", value_text(figure, "subject"), "detail", detail, "command", command);
    for (size_t k = failures->count; entry && k-- > 0;) {
        struct failure *known = &failures->list[k];
        if (!json_equal(json_object_get(entry, "area"), json_object_get(known->entry, "area")) ||
            !json_equal(json_object_get(entry, "name"), json_object_get(known->entry, "name")))
            continue;
        known->more++;
        if (excess > known->excess) {
            json_decref(known->entry);
            known->entry = json_incref(entry);
            known->excess = excess;
        }
        json_decref(entry);
        return;
    }
    keep(failures, cause_of_check(group), place(check, elementary, ELEMENTARY), excess, entry);
}

static int most_specific_first(const void *a, const void *b)
{
    const struct failure *x = a, *y = b;
    if (x->cause != y->cause) return x->cause < y->cause ? -1 : 1;
    if (x->check != y->check) return x->check < y->check ? -1 : 1;
    if (x->excess != y->excess) return x->excess > y->excess ? -1 : 1;
    return x->number < y->number ? -1 : 1;
}

static void tell_more(struct failure_list *failures, const struct failure *failure)
{
    struct buffer detail = {0};
    buffer_format(&detail, "%s; and %zu more %s of this check",
                  value_text(failure->entry, "detail"), failure->more,
                  failure->more == 1 ? "figure" : "figures");
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
