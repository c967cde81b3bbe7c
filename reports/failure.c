/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "buffer.h"
#include "value.h"

/* What is no check, in the order in which it is shown after all checks. */
static const char *const areas[] = {"detection", "suspicion", "harness", "convergence", "gate",
                                    "budget",    "study",     "run",     "stress",      "fault"};
enum { AREAS = sizeof areas / sizeof *areas };

struct failure {
    json_t *entry;
    double rank;
    size_t number; /* in the order of coming */
    double excess;
    size_t more; /* other figures of the same check */
};

static double rank_of(const char *area)
{
    int k = 0;
    while (k < AREAS && strcmp(areas[k], area)) k++;
    return FAILURE_RANK_MISSED + k;
}

/* Takes entry. */
static void keep(struct failure_list *failures, double rank, double excess, json_t *entry)
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
    failures->list[failures->count] = (struct failure){entry, rank, failures->count, excess, 0};
    failures->count++;
}

void failure_add(struct failure_list *failures, const char *area, const char *name,
                 const char *detail, const char *command)
{
    keep(failures, rank_of(area), 0,
         json_pack("{s:s, s:s, s:s, s:s}", "area", area, "name", name, "detail", detail, "command",
                   command));
}

void failure_add_check(struct failure_list *failures, const json_t *figure, double excess,
                       const char *detail, const char *command)
{
    const char *group = value_text(figure, "group"), *check = value_text(figure, "name");
    const double rank = value_member(figure, "rank");
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
    keep(failures, isnan(rank) ? FAILURE_RANK_MISSED - 1 : rank, excess, entry);
}

static int most_specific_first(const void *a, const void *b)
{
    const struct failure *x = a, *y = b;
    if (x->rank != y->rank) return x->rank < y->rank ? -1 : 1;
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
