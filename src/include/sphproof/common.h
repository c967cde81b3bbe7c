/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * Shared by all headers of libsphproof. Functions neither print nor abort; one that can fail
 * returns a status and fills an error if the caller passes one. Arrays belong to the caller unless
 * a function says otherwise. Any consistent units. Functions may be called from several threads at
 * once, each with objects of its own. */
#ifndef SPHPROOF_PUBLIC_COMMON_H
#define SPHPROOF_PUBLIC_COMMON_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Status codes, equal to the exit status of the program. */
enum sphproof_status {
    SPHPROOF_OK = 0,
    SPHPROOF_CHECK_FAILED = 1, /**< the check was sound, its subject is wrong */
    SPHPROOF_BAD_INPUT = 2,    /**< an invalid argument, name or value */
    SPHPROOF_BROKE_DOWN = 3,   /**< a simulation broke down */
    SPHPROOF_ENVIRONMENT = 4,  /**< no memory */
};

/** A readable error, filled if a function does not return SPHPROOF_OK. May be NULL wherever a
 * function takes one. */
struct sphproof_error {
    enum sphproof_status status; /**< same as the return value */
    char message[512];           /**< one line: what is wrong and what is allowed */
};

/** A measured property of the subject. It holds if value <= bound. */
struct sphproof_figure {
    const char *property; /**< its name: [a-z_] */
    const char *formula;  /**< definition of the property, one line */
    const char *where;    /**< the worst position; for a skipped figure, why */
    double value;         /**< measured value; NaN fails */
    double bound;         /**< largest allowed value */
    double floor;         /**< below this the value is round-off */
    bool skipped;         /**< could not be measured; not a failure */
    bool passed;          /**< also true if skipped */
};

/** Called with each figure, whose strings are valid until it returns. */
typedef void sphproof_figure_sink(void *context, const struct sphproof_figure *figure);

/** The version of the library, such as "0.1.0". */
const char *sphproof_version(void);

#ifdef __cplusplus
}
#endif

#endif
