/* SPDX-License-Identifier: GPL-3.0-or-later
 * The autopsy of another code's snapshots: what exact fields become at its particles' positions. */
#pragma once

#include "autopsy.h"
#include "judge.h"

/* A level, by the operator of the case and its keys; kernel and number of neighbours are those
 * that the snapshot proves, unless the keys name one. *used: the run that stands for all this.
 * STATUS_BAD_INPUT: as autopsy_check. */
enum status judge_autopsy(const struct judged *judged, struct autopsy_level *level,
                          struct run *used, struct error *error);
