/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "start_format.h"

#include <stdlib.h>

#include "text.h"

#define START(name) extern const struct start_format start_##name;
#include "starts.def"
#undef START

static const struct member *const members[] = {
#define START(name) &start_##name.member,
#include "starts.def"
#undef START
};

const struct family start_format_family = {
    "formats", "initial states for other codes, as `sphproof ic` writes them", members,
    sizeof members / sizeof *members};

const struct start_format *start_format_of(const char *name, struct error *error)
{
    const int at = family_index(&start_format_family, name);
    if (at >= 0) return (const struct start_format *)members[at];
    text_unknown_member(error, "ic", "format", name, &start_format_family);
    return NULL;
}

enum status start_possible(const struct start_format *format, const struct run *run,
                           struct error *error)
{
    const struct prepared *problem = &run->problem;
    const int dim = run->asked.layers ? 3 : problem->domain.dim;
    if (format->dim && dim != format->dim)
        return error_set(error, STATUS_BAD_INPUT,
                         "ic: a problem in %dD: the code that reads '%s' is for %dD%s", dim,
                         format->member.name, format->dim,
                         dim == 2 && format->dim == 3 ? " (--as-3d LAYERS makes that of it)" : "");
    for (int d = 0; d < problem->domain.dim; d++) {
        const enum boundary boundary = problem->boundary[d];
        if (format->no_walls && boundary != BOUNDARY_PERIODIC && boundary != BOUNDARY_OPEN)
            return error_set(error, STATUS_BAD_INPUT,
                             "ic: boundary '%s' along %c: the code that reads '%s' has no walls; "
                             "allowed: periodic open",
                             scheme_boundary_family.members[boundary]->name, "xyz"[d],
                             format -> member.name);
    }
    return STATUS_OK;
}

enum status start_write(const struct start_format *format, const struct run_result *result,
                        const char *path, struct error *error)
{
    double factor = format->h_over_support;
    if (format->width && format->width(result, &factor, error)) return error->status;
    if (factor == 0) return format->writer->write(result, path, error);
    struct run_result theirs = *result;
    double *h = malloc(result->n * sizeof *h);
    if (!h) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    for (size_t i = 0; i < result->n; i++) h[i] = factor * result->snapshot.h[i];
    theirs.snapshot.h = h;
    const enum status status = format->writer->write(&theirs, path, error);
    free(h);
    return status;
}
