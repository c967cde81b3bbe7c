/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a snapshot of ours says about its run, so that its reader needs no other source. */
#ifndef SPHPROOF_SNAPSHOT_REMARKS_H
#define SPHPROOF_SNAPSHOT_REMARKS_H

#include "run.h"

enum { SNAPSHOT_REMARKS = 6, SNAPSHOT_REMARK_TEXT = 1024 };

struct snapshot_remark {
    const char *key;
    char value[SNAPSHOT_REMARK_TEXT];
};

/* Returns how many there are, at most SNAPSHOT_REMARKS: `case` (left out where its name is not
 * known), `time`, `gamma`, `box` (LO:HI for each direction), `boundary` (one word for all
 * directions, or one each), and `keys`: the measure window and the keys that the user gave and that
 * change the exact solution, KEY=VALUE separated by "; ". */
size_t snapshot_remarks(const struct run_result *result,
                        struct snapshot_remark remarks[SNAPSHOT_REMARKS]);

#endif
