/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "case_state.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "html.h"
#include "page_plot.h"
#include "value.h"

/* From best to worst. */
static const char *const states[] = {"ok",   "known",      "undetermined", "smoke",
                                     "fail", "broke_down", "failed"};
enum { STATES = sizeof states / sizeof *states, OPEN = 1, FAILED = 4 };

static int rank(const char *status)
{
    for (int k = STATES; k-- > 0;)
        if (!strcmp(status, states[k])) return k;
    return 0;
}

const json_t *case_state_find(const json_t *list, const char *case_name, const char *label)
{
    size_t i;
    const json_t *entry;
    json_array_foreach(list, i, entry) {
        if (!strcmp(value_text(entry, "case"), case_name) &&
            (!label || !strcmp(value_text(entry, "label"), label)))
            return entry;
    }
    return NULL;
}

size_t case_state_labels(const json_t *list, int least, int most, const char **labels)
{
    size_t count = 0, i;
    const json_t *entry;
    json_array_foreach(list, i, entry) {
        const double dimension = fmax(1, value_member(entry, "dimension"));
        const char *label = value_text(entry, "label");
        size_t k = 0;
        if (dimension < least || dimension > most) continue;
        while (k < count && strcmp(labels[k], label)) k++;
        if (k == count && count < PAGE_SCHEMES) labels[count++] = label;
    }
    return count;
}

/* The worst state of a document and its gates. With speaks = false only failures count. */
static int worst_of(const json_t *document, bool speaks)
{
    static const char *const lists[] = {"gates", "orders", NULL};
    int worst = *value_text(document, "suspicion") ? FAILED : rank(value_text(document, "status"));
    for (const char *const *list = lists; *list; list++) {
        size_t i;
        const json_t *gate;
        json_array_foreach(json_object_get(document, *list), i, gate) {
            const int now = rank(value_text(gate, "status"));
            if (now > worst && (speaks || now >= FAILED)) worst = now;
        }
    }
    return worst;
}

const char *case_state(const json_t *results, const char *case_name)
{
    static const char *const lists[] = {"runs", "studies", NULL};
    const char *speaker = NULL;
    int worst = 0;
    for (const char *const *list = lists; *list; list++) {
        size_t i;
        const json_t *entry;
        json_array_foreach(json_object_get(results, *list), i, entry) {
            if (strcmp(value_text(entry, "case"), case_name) != 0) continue;
            if (!speaker) speaker = value_text(entry, "label");
            const int now = worst_of(entry, !strcmp(value_text(entry, "label"), speaker));
            if (now > worst) worst = now;
        }
    }
    return states[worst];
}

void case_state_cell(struct buffer *to, const char *case_name)
{
    html_format(to, "<td><a href=\"#case-%s\">%-s</a></td>", case_name, case_name);
}

double case_state_level_error(const json_t *study, const char *name, size_t i)
{
    const json_t *level = json_array_get(json_object_get(study, "levels"), i);
    const json_t *scalar = value_named(json_object_get(study, "functionals"), name);
    const double error = value_inner(json_object_get(level, "errors"), name, "l1");
    if (isfinite(error) || !scalar) return error;
    return fabs(value_real(json_array_get(json_object_get(scalar, "values"), i)) -
                value_member(scalar, "exact"));
}

const json_t *case_state_finest(const json_t *study)
{
    const json_t *levels = json_object_get(study, "levels");
    return json_array_get(levels, json_array_size(levels) - 1);
}

const char *case_state_measured(const json_t *document)
{
    const char *name = json_string_value(html_member(document, "measured/0"));
    return name ? name : "density";
}

double case_state_error(const json_t *run, const char **name)
{
    *name = case_state_measured(run);
    const double error = value_inner(json_object_get(run, "errors"), *name, "l1");
    if (isfinite(error)) return error;
    const json_t *scalar = value_named(json_object_get(run, "functionals"), *name);
    return fabs(value_member(scalar, "value") - value_member(scalar, "reference"));
}
