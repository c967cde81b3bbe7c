/* SPDX-License-Identifier: GPL-3.0-or-later
 * A share of a study as a task of a Slurm array: this command once more, with --shard. */
#ifndef SPHPROOF_SLURM_SHARE_H
#define SPHPROOF_SLURM_SHARE_H

#include "cache.h"
#include "command.h"

struct slurm_share {
    const struct options *options; /* of this command */
    const struct cache *cache;
    int jobs, of;              /* processes of each; number of shares */
    const char *name, *folder; /* of the array; of the logs */
    const char *which;         /* numbers of the shares: 1,3-5 */
};

/* Submits; *job: the number of the array. */
enum status slurm_share_submit(const struct slurm_share *share, long *job, struct error *error);

/* Where the task of a share writes what it says. */
void slurm_share_log(const char *folder, const char *name, long job, int share, char *path,
                     size_t size);

#endif
