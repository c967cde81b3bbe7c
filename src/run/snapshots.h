/* SPDX-License-Identifier: GPL-3.0-or-later
 * Intermediate snapshots. If --snapshot F.csv names the final snapshot, the intermediate ones are
 * F_0000.csv at the start and F_0001.csv, F_0002.csv ... at multiples of an interval. They do not
 * change the run: a few steps before each, the state is saved in memory; the run continues to
 * exactly the snapshot's time, as if it ended there, and then restarts from the saved state, equal
 * to the last bit. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "simulation.h"

enum { SNAPSHOTS_MOST = 10000 }; /* files, since numbers have four digits */

struct run_result;

struct snapshots {
    const char *path; /* of the final snapshot */
    double every;     /* interval in the run's time */
    /* Called with each intermediate snapshot; may be NULL. */
    void (*show)(void *context, const struct run_result *moment, size_t number,
                 struct error *error);
    void *context;
    struct error trouble; /* error of the first snapshot that could not be written */
    /* set by the functions below: */
    size_t next, count; /* number of the next snapshot; number of intermediate snapshots */
    double reach;       /* snapshots up to this time start from the saved state */
    unsigned char *state;
};

/* STATUS_BAD_INPUT: the interval is invalid for a run to t_end or gives too many files. */
enum status snapshots_check(const struct snapshots *snapshots, double t_end, struct error *error);

/* Number of intermediate snapshots. */
size_t snapshots_count(const struct snapshots *snapshots, double t_end);

/* Time and path of a snapshot by its number. A path that no file can have is cut, to a length that
 * the system refuses as well. */
struct snapshots_path {
    char text[5000];
};
double snapshots_time(const struct snapshots *snapshots, size_t number);
struct snapshots_path snapshots_path(const struct snapshots *snapshots, size_t number);

/* Bytes that the saved state takes in a run of n particles, beside the run's own memory and that
 * for writing a file. */
double snapshots_memory(int dim, double n);

/* Call before the first step of this process: skips the snapshots up to `time`, and those up to
 * `last`, the time of the last snapshot made (< 0: none). */
void snapshots_begin(struct snapshots *snapshots, double time, double last, double t_end);

/* The time of the last snapshot made; < 0: none. */
double snapshots_last(const struct snapshots *snapshots);

/* Call between steps. Saves the state and returns true if a snapshot is due within the next few
 * steps and before the run's next stop. */
bool snapshots_keep(struct snapshots *snapshots, struct simulation *simulation, double time,
                    double stop);

/* Restores the saved state. */
void snapshots_return(struct snapshots *snapshots, struct simulation *simulation);

/* Discards the saved state. */
void snapshots_go_on(struct snapshots *snapshots);

/* Stores the first error. */
void snapshots_fail(struct snapshots *snapshots, const struct error *error);
