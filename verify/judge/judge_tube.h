/* SPDX-License-Identifier: GPL-3.0-or-later
 * A tube with ends: two gases that meet once, in a box that is open or has walls there, as
 * textbooks draw it. The exact solution is that of an endless tube, until waves come back from an
 * end. */
#ifndef SPHPROOF_JUDGE_TUBE_H
#define SPHPROOF_JUDGE_TUBE_H

#include "judge.h"

/* Are there ends? So the user says (--boundary), or the gas at both ends of [ends[0], ends[1]] is
 * as undisturbed as the two gases were, where waves of a mirrored tube would have come by. Notes
 * what was found. settings: gases, gamma and time. */
bool judge_tube_ends(const struct judge_request *request, struct judged *judged,
                     const struct settings *settings, const double ends[2]);

/* Where errors are measured: as the user says, else from end to end but for what waves that came
 * back may have reached. box: so long that a mirrored tube beyond the ends cannot be felt. Both are
 * pairs along x. STATUS_BAD_INPUT: waves may have reached everything. */
enum status judge_tube_place(const struct judge_request *request, struct judged *judged,
                             const struct settings *settings, double x0, const double ends[2],
                             double window[2], double box[2], struct error *error);

#endif
