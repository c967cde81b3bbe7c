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
    if (!status) {
        json_t *checks = certificate_checks(c);
        json_array_extend(list, checks);
        json_decref(checks);
        certificate_free(c);
    }
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
    *reply = result_object("name=%s checks=%p", status ? "" : user.name, (void *)list);
    if (!status) user_kernel_unload(&user);
    return status;
}

/* ---- in this one ---- */

static enum status take(struct user_figures *figures, const struct guard_verdict *verdict,
                        struct error *error)
{
    const char *name = value_text(verdict->reply, "name");
    if (*name) snprintf(figures->name, sizeof figures->name, "%s", name);
    findings_of_verify(&figures->figures, verdict->reply);
    if (!verdict->ended) {
        char subject[500];
        snprintf(subject, sizeof subject, "%s, %.400s", figures->name, verdict->reason);
        findings_add(&figures->figures,
                     (struct finding){
                         .what = "runs", .subject = subject, .value = 1, .status = FINDING_FAIL});
    }
    return figures->figures.failed ? error_set(error, STATUS_ENVIRONMENT, "no memory for figures")
                                   : STATUS_OK;
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
    findings_free(&figures->figures);
    *figures = (struct user_figures){0};
}
