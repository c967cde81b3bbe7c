/* SPDX-License-Identifier: GPL-3.0-or-later
 * The results in a few lines of Markdown, for a pull request or a terminal. */
#ifndef SPHPROOF_SUMMARY_H
#define SPHPROOF_SUMMARY_H

#include <jansson.h>

/* results: with its verdict. Malloced; NULL: no memory. */
char *summary_text(const json_t *results);

#endif
