/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdarg.h>
#include <stdio.h>

#include "library.h"
#include "version.h"

_Static_assert((int)SPHPROOF_OK == (int)STATUS_OK &&
                   (int)SPHPROOF_CHECK_FAILED == (int)STATUS_CHECK_FAILED &&
                   (int)SPHPROOF_BAD_INPUT == (int)STATUS_BAD_INPUT &&
                   (int)SPHPROOF_BROKE_DOWN == (int)STATUS_BROKE_DOWN &&
                   (int)SPHPROOF_ENVIRONMENT == (int)STATUS_ENVIRONMENT,
               "the library's outcomes are the program's");

const char *sphproof_version(void)
{
    return VERSION;
}

enum sphproof_status library_pass(enum status status, const struct error *ours,
                                  struct sphproof_error *theirs)
{
    if (status && theirs) {
        theirs->status = (enum sphproof_status)status;
        snprintf(theirs->message, sizeof theirs->message, "%s", ours->message);
    }
    return (enum sphproof_status)status;
}

enum sphproof_status library_fail(struct sphproof_error *theirs, enum status status,
                                  const char *format, ...)
{
    struct error ours;
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    error_set(&ours, status, "%s", text);
    return library_pass(status, &ours, theirs);
}

void library_figure(struct library_figures *figures, const struct sphproof_figure *figure)
{
    if (!figure->passed && !figures->failed++)
        library_fail(figures->error, STATUS_CHECK_FAILED, "%s: %.3g, allowed %.3g (%s)",
                     figure->property, figure->value, figure->bound, figure->where);
    if (figures->sink) figures->sink(figures->context, figure);
}
