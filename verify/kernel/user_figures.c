/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "user_figures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "certificate.h"
#include "guard.h"
#include "result.h"
#include "user_kernel.h"
#include "value.h"

/* ---- in the guarded process ---- */

static enum status add_certificate(const struct user_kernel *user, int dim, json_t *list,
                                   struct error *error)
{
    struct certificate *c = calloc(1, sizeof *c);
    const struct terms terms = user_kernel_terms(user, dim);
    if (!c) return error_set(error, STATUS_ENVIRONMENT, "no memory for a kernel");
    const enum status status = certificate_measure(c, &user->kernel, dim, &terms, error);
    for (size_t i = 0; i < c->figure_count && !status; i++) {
        const struct certificate_figure *figure = &c->figures[i];
        json_array_append_new(list, json_pack("{s:s, s:i, s:o, s:o, s:o, s:b, s:s}", "property",
                                              figure->property->name, "dim", dim, "value",
                                              result_number(figure->value), "bound",
                                              result_number(figure->bound), "floor",
                                              result_number(figure->floor), "skipped",
                                              (int)figure->skipped, "where", figure->where));
    }
    if (!status) certificate_free(c);
    free(c);
    return status;
}

static enum status work(const void *path, json_t **reply, struct error *error)
{
    const struct terms terms = {.samples = CERTIFICATE_SAMPLES, .seed = CERTIFICATE_SEED};
    struct user_kernel user;
    json_t *list = json_array();
    enum status status = user_kernel_load(&user, path, 0, &terms, error);
    for (int dim = 1; dim <= KERNEL_DIM_MAX && !status; dim++)
        status = add_certificate(&user, dim, list, error);
    *reply = json_pack("{s:s, s:o}", "name", status ? "" : user.name, "figures", list);
    if (!status) user_kernel_unload(&user);
    return status;
}

/* ---- in this one ---- */

static const char *property_called(const char *name)
{
    for (size_t i = 0; i < property_count; i++)
        if (strcmp(property_list[i].name, name) == 0) return property_list[i].name;
    return NULL;
}

static void take_figure(struct user_figures *figures, const json_t *json)
{
    struct user_figure figure = {
        .property = property_called(value_text(json, "property")),
        .dim = (int)value_member(json, "dim"),
        .value = value_member(json, "value"),
        .bound = value_member(json, "bound"),
        .floor = value_member(json, "floor"),
        .skipped = json_is_true(json_object_get(json, "skipped")),
    };
    snprintf(figure.where, sizeof figure.where, "%s", value_text(json, "where"));
    if (figure.property) figures->list[figures->n++] = figure;
}

static enum status take(struct user_figures *figures, const struct guard_verdict *verdict,
                        struct error *error)
{
    const json_t *list = json_object_get(verdict->reply, "figures");
    const size_t n = json_array_size(list);
    figures->list = calloc(n + 1, sizeof *figures->list);
    if (!figures->list) return error_set(error, STATUS_ENVIRONMENT, "no memory for figures");
    if (n) snprintf(figures->name, sizeof figures->name, "%s", value_text(verdict->reply, "name"));
    for (size_t i = 0; i < n; i++) take_figure(figures, json_array_get(list, i));
    if (verdict->ended) return STATUS_OK;
    struct user_figure *figure = &figures->list[figures->n++];
    *figure = (struct user_figure){.property = property_called("runs"), .value = 1};
    snprintf(figure->where, sizeof figure->where, "%s", verdict->reason);
    return STATUS_OK;
}

enum status user_figures_measure(struct user_figures *figures, const char *path,
                                 struct error *error)
{
    struct guard_verdict verdict;
    *figures = (struct user_figures){0};
    user_kernel_file_name(path, figures->name, sizeof figures->name);
    enum status status = guard_run(work, path, GUARD_LIMIT, &verdict, error);
    if (status == STATUS_BAD_INPUT && !verdict.ended)
        error_set(error, status, "kernel '%.150s' %.300s", path, verdict.reason);
    if (status == STATUS_OK || status == STATUS_CHECK_FAILED)
        status = take(figures, &verdict, error);
    guard_free(&verdict);
    return status;
}

void user_figures_free(struct user_figures *figures)
{
    free(figures->list);
    *figures = (struct user_figures){0};
}
