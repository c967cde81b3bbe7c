/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks as independent computations: side by side, in shares, kept. */
#ifndef SPHPROOF_VERIFY_SHARES_H
#define SPHPROOF_VERIFY_SHARES_H

#include "command.h"
#include "suite.h"

/* Was any option given that asks for it? */
bool verify_shares_wanted(const struct options *options);

/* As suite_run of the chosen ones of all checks. *whole becomes false, and there is no suite, where
 * only a share was asked for or a list. STATUS_BAD_INPUT: options exclude each other;
 * STATUS_ENVIRONMENT, STATUS_BROKE_DOWN: a check gave no result. */
enum status verify_shares_run(struct suite *suite, const struct suite_choice *choice,
                              const struct options *options, bool *whole, struct error *error);

#endif
