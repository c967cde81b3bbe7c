/* SPDX-License-Identifier: GPL-3.0-or-later
 * The autopsy of another code's snapshots: the errors that its particles' positions cause for exact
 * fields. */
#pragma once

#include "autopsy.h"
#include "judge.h"

/* Fills a level with the gradient operator and the keys of the case. Kernel and number of
 * neighbours are those found from the snapshot, unless the keys set them. *used: the run that
 * stands for the snapshot. STATUS_BAD_INPUT: as autopsy_check. */
enum status judge_autopsy(const struct judged *judged, struct autopsy_level *level,
                          struct run *used, struct error *error);
