/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file
 * What all headers of libsphproof share. Functions neither print nor abort; one that can fail
 * returns a status, and fills an error where the caller has room for one. Arrays belong to the
 * caller unless a function says otherwise. Any consistent units. Functions may be called from
 * several threads at once, each with objects of its own. */
#ifndef SPHPROOF_PUBLIC_COMMON_H
#define SPHPROOF_PUBLIC_COMMON_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Outcomes; the program's exit status has the same numbers. */
enum sphproof_status {
    SPHPROOF_OK = 0,
    SPHPROOF_CHECK_FAILED = 1, /**< what was checked is wrong; the check itself was sound */
    SPHPROOF_BAD_INPUT = 2,    /**< an argument, a name, a value */
    SPHPROOF_BROKE_DOWN = 3,   /**< a simulation */
    SPHPROOF_ENVIRONMENT = 4,  /**< no memory */
};

/** What went wrong, for a person: filled where a function does not return SPHPROOF_OK. Wherever one
 * is asked for, NULL will do. */
struct sphproof_error {
    enum sphproof_status status; /**< what the function returns */
    char message[512];           /**< one line, names what is wrong and what is allowed */
};

/** One property that was measured on something of yours. It holds if value <= bound. */
struct sphproof_figure {
    const char *property; /**< its name: [a-z_] */
    const char *formula;  /**< what it says, one line */
    const char *where;    /**< the worst place; of a skipped figure: why */
    double value;         /**< what was measured; NaN fails */
    double bound;         /**< what is allowed */
    double floor;         /**< below this the value is round-off */
    bool skipped;         /**< could not be measured: no failure */
    bool passed;          /**< or skipped */
};

/** Is called with each figure; its texts live until it returns. */
typedef void sphproof_figure_sink(void *context, const struct sphproof_figure *figure);

/** The version of the library, such as "0.1.0". */
const char *sphproof_version(void);

#ifdef __cplusplus
}
#endif

#endif
