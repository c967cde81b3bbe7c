/* SPDX-License-Identifier: GPL-3.0-or-later
 * Intermediate snapshots. For --snapshot F.csv, which holds the particles at the end, these are
 * F_0000.csv at the start and F_0001.csv, F_0002.csv ... at the multiples of an interval. They do
 * not change the run: a few steps before each, the state is saved in memory, the run goes on to
 * exactly the snapshot's time as if it ended there, and then continues from the saved state, equal
 * to the last bit. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "simulation.h"

enum { SNAPSHOTS_MOST = 10000 }; /* files; their numbers have four digits */

struct run_result;

struct snapshots {
    const char *path; /* of the one at the end */
    double every;     /* interval, of the run's time */
    /* Called with each that was made on the way; may be NULL. */
    void (*show)(void *context, const struct run_result *moment, size_t number,
                 struct error *error);
    void *context;
    struct error trouble; /* why the first that could not be written was not */
    /* kept by the functions below: */
    size_t next, count; /* number of the next one; how many there are beside the one at the end */
    double reach;       /* those up to this time begin with what is kept */
    unsigned char *state;
    size_t size;
};

/* STATUS_BAD_INPUT: no interval of a run to t_end, or one that makes too many files. */
enum status snapshots_check(const struct snapshots *snapshots, double t_end, struct error *error);

/* How many there are beside the one at the end. */
size_t snapshots_count(const struct snapshots *snapshots, double t_end);

/* Of a number: its time; its file, malloced (NULL: no memory). */
double snapshots_time(const struct snapshots *snapshots, size_t number);
char *snapshots_path(const struct snapshots *snapshots, size_t number);

/* Bytes that going aside takes in a run of n particles, beside the run's own and what writing a
 * file takes. */
double snapshots_memory(int dim, double n);

/* Before the first step of this process: those up to `time` are over, and those up to `last`, which
 * is that of the last one that was made (< 0: none). */
void snapshots_begin(struct snapshots *snapshots, double time, double last, double t_end);

/* The time of the last one that was made; < 0: none. */
double snapshots_last(const struct snapshots *snapshots);

/* Between steps, at this time: is one due within the next few, and before the run's next stop? The
 * state is then kept. */
bool snapshots_keep(struct snapshots *snapshots, struct simulation *simulation, double time,
                    double stop);

/* Puts the simulation back where it was kept. */
void snapshots_return(struct snapshots *snapshots, struct simulation *simulation);

/* Nothing is kept any more. */
void snapshots_go_on(struct snapshots *snapshots);

/* Remembers the first trouble. */
void snapshots_fail(struct snapshots *snapshots, const struct error *error);
